"""Faults of take.toml: the file itself, and the values in it."""

import os
from pathlib import Path

import numpy as np
from circumstances import ON_LINUX, ON_UNIX, bound_by_permissions
from faults import Chapter, fit_words, replace_text
from silhouette_mocap.core.body.file import write_body
from silhouette_mocap.core.body.scaling import scaled
from silhouette_mocap.core.body.templates import template

FILE = Chapter("take.toml, the file")
VALUES = Chapter("take.toml, the values")


@FILE.add("no such take", "take.toml: no such file; check the path")
def _(folder: Path):
    (folder / "take.toml").unlink()


@FILE.add("a folder instead of the take", "is a folder", "name the .toml file in it")
def _(folder: Path):
    return ("fit", folder, "--out", folder.parent / "out")


@FILE.add("an empty take", '"version"', "write version = 1")
def _(folder: Path):
    (folder / "take.toml").write_bytes(b"")


@FILE.add(
    "a take that may not be read",
    "take.toml: cannot be read (Permission denied)",
    within=bound_by_permissions,
    unless=ON_LINUX,
)
def _(folder: Path):
    (folder / "take.toml").chmod(0)


@FILE.add("a take in UTF-16, as Notepad saves it", "is not UTF-8 text; save it as UTF-8")
def _(folder: Path):
    path = folder / "take.toml"
    path.write_text(path.read_text("utf-8"), "utf-16")


@FILE.add("a take that is a picture", "take.toml: is not UTF-8 text")
def _(folder: Path):
    (folder / "take.toml").write_bytes((folder / "masks/cam_01/000000.png").read_bytes())


@FILE.add("a take that extends itself", "extends itself", 'remove one of the "extends" keys')
def _(folder: Path):
    replace_text(folder / "take.toml", "version = 1", 'version = 1\nextends = "take.toml"')


@FILE.add("a take that extends what is not there", "session.toml: no such file")
def _(folder: Path):
    replace_text(folder / "take.toml", "version = 1", 'version = 1\nextends = "../session.toml"')


@FILE.add("takes that extend each other without end", "extends more than 20 files in a row")
def _(folder: Path):
    text = (folder / "take.toml").read_text("utf-8")
    for number in range(1500):
        extended = f'version = 1\nextends = "{number + 1}.toml"\n'
        (folder / f"{number}.toml").write_text(extended, "utf-8")
    (folder / "1500.toml").write_text(text, "utf-8")
    (folder / "take.toml").write_text('version = 1\nextends = "0.toml"\n', "utf-8")


@FILE.add("a take that is a pipe", "take.toml: is no ordinary file", unless=ON_UNIX)
def _(folder: Path):
    (folder / "take.toml").unlink()
    os.mkfifo(folder / "take.toml")


@FILE.add("a take that is a link to itself", "take.toml", "loop", unless=ON_UNIX)
def _(folder: Path):
    (folder / "take.toml").unlink()
    (folder / "take.toml").symlink_to("take.toml")


@FILE.add(
    "a take with a name that is too long", "cannot be read (File name too long)", unless=ON_UNIX
)
def _(folder: Path):
    return ("fit", folder / ("take" * 80 + ".toml"), "--out", folder.parent / "out")


def _value(title: str, old: str, new: str, *says: str) -> None:
    VALUES.text(title, "take.toml", old, new, "take.toml: ", *says)


_value("not TOML", "[cameras]", "[cameras", "is not valid TOML", "line 7")
_value(
    "a decimal comma", "fps = 15.0", "fps = 15,0", "is not valid TOML", "line 4", "decimal points"
)
_value("unknown key", "fps = 15.0", "fsp = 15.0", 'unknown key "fsp"; did you mean "fps"?')
_value("unknown key in a table", "units =", "unit =", 'unknown key "unit" in [cameras]', '"units"')
_value("unknown table", "[performer]", "[perfomer]", '"perfomer"; did you mean "performer"?')
_value("another version", "version = 1", "version = 2", 'expected "version" = 1, got 2')
_value("a version that is no number", "version = 1", "version = true", "version", "got True")
_value("no frame rate", "fps = 15.0", "", '"fps" is missing')
_value("frame rate 0", "fps = 15.0", "fps = 0", "from 0.1 to 10000", "(0)")
_value("absurd frame rate", "fps = 15.0", "fps = 1e9", "from 0.1 to 10000", "(1000000000.0)")
_value("frame rate that is no number", "fps = 15.0", "fps = nan", '"fps"', "nan")
_value("a text for a number", "fps = 15.0", 'fps = "15"', "got a text ('15')")
_value("frames in the wrong order", "[0, 3]", "[3, 0]", "first <= last", "[3, 0]")
_value("negative frames", "[0, 3]", "[-1, 3]", "0 <= first", "[-1, 3]")
_value(
    "frame numbers beyond all footage", "[0, 3]", f"[0, {10**30}]", '"frames"', "last <= 1000000000"
)
_value(
    "initial pose outside the take", "[0, 1]", "[2, 9]", '"initial_pose.frames" [2, 9]', "[0, 3]"
)
_value("unknown pose", '"A"', '"B"', "one of A, T, elbows", "'B'")
_value(
    "height in centimetres",
    "[performer]",
    "[performer]\nheight_m = 178",
    "from 0.5 to 2.6",
    "(178)",
)
_value(
    "absurd height", "[performer]", "[performer]\nheight_m = 0.01", '"performer.height_m"', "0.01"
)
_value("height that is no number", "[performer]", "[performer]\nheight_m = inf", "inf")
_value(
    "floor that is no number", "[performer]", "[world]\nfloor = nan\n[performer]", '"world.floor"'
)
_value("name that cannot name files", '"small"', '"../small"', '"name"', "cannot name files")
_value(
    "name with a colour of the terminal", '"small"', r'"\u001b[31msmall"', '"name"', "cannot name"
)
_value("name that is too long", '"small"', f'"{"small" * 60}"', '"name"', "300", "shorten")
_value("unknown body", "sixteen_segment", "centaur", "centaur", "performer, sixteen_segment")


@VALUES.add("a rig that is not there", "small/actor.blend: no such file; check", early=False)
def _(folder: Path):
    replace_text(folder / "take.toml", "sixteen_segment", "actor.blend#Rig")


_value("unknown unit", 'units = "m"', 'units = "feet"', "feet", "m, cm, mm")
_value("no calibration named", 'calibration = "calibration.toml"', "", '"cameras.calibration" is')
_value("path outside --root", '"calibration.toml"', '"../../calibration.toml"', "outside", "--root")
_value("footage outside --root", "masks/{camera}", "../../{camera}", "outside", "--root")
_value("one place for all cameras", "masks/{camera}", "masks/cam_01", "all cameras the same")
_value("no footage named", "silhouettes =", "# silhouettes =", "silhouettes", "video")
_value(
    "adjusting an unknown camera",
    "[footage]",
    "adjust = { cam_9 = { scale = 2.0 } }\n[footage]",
    'no camera "cam_9"',
    "the cameras are cam_01",
)
_value("footage without a plate", "silhouettes =", "video =", '"footage.plate" is missing')


@VALUES.add("floor far above the performer", "below the floor", "floor under [world]")
def _(folder: Path):
    replace_text(folder / "take.toml", "[performer]", "[world]\nfloor = 1000.0\n[performer]")


@VALUES.add("floor far below the performer", "above the floor", "floor under [world]")
def _(folder: Path):
    replace_text(folder / "take.toml", "[performer]", "[world]\nfloor = -1000.0\n[performer]")


@VALUES.add(
    "floor too far below the performer for a height", "take.toml: the performer would be 4."
)
def _(folder: Path):
    replace_text(folder / "take.toml", "[performer]", "[world]\nfloor = -2.5\n[performer]")


@VALUES.add("links that lead in a circle", "masks", "loop", unless=ON_UNIX)
def _(folder: Path):
    os.rename(folder / "masks", folder / "kept")
    (folder / "masks").symlink_to("masks", target_is_directory=True)


def _with_body(folder: Path) -> Path:
    replace_text(folder / "take.toml", '"sixteen_segment"', '"body.npz"')
    return folder / "body.npz"


@VALUES.add("a body that is not there", "body.npz", "no such")
def _(folder: Path):
    _with_body(folder)


@VALUES.add("a body that is a pipe", "body.npz: is no ordinary file", unless=ON_UNIX)
def _(folder: Path):
    os.mkfifo(_with_body(folder))


@VALUES.add("body.npz of something else", "body.npz", "body")
def _(folder: Path):
    np.savez(_with_body(folder), points=np.zeros(3))


@VALUES.add("body.npz cut short", "body.npz")
def _(folder: Path):
    path = _with_body(folder)
    write_body(path, template("sixteen_segment"))
    path.write_bytes(path.read_bytes()[:-2000])


@VALUES.add("a body of a giant", "body.npz: the performer would be", "m tall, not 0.5 to 2.6 m")
def _(folder: Path):
    write_body(_with_body(folder), scaled(template("sixteen_segment"), 1000.0))


def _initialise(folder: Path, *words: str) -> tuple:
    return ("initialise", folder / "take.toml", "--out", folder.parent / "out", *words)


@VALUES.add(
    "a body to be found that is fitted already",
    "take.toml: names a body that is fitted already, ",
    'body = "performer"',
    early=False,
)
def _(folder: Path):
    write_body(_with_body(folder), template("sixteen_segment"))
    return _initialise(folder)


@VALUES.add(
    "further frames for a body outside the take",
    "frames 2 to 9 lie outside the take's, 0 to 3",
    early=False,
)
def _(folder: Path):
    return _initialise(folder, "--frames", "2:9")


ALL_BUT_ONE = [word for i in range(2, 6) for word in ("--without", f"cam_0{i}")]


def _words(title: str, *words: str, says: tuple[str, ...]) -> None:
    VALUES.add(title, *says, early=False)(lambda folder: fit_words(folder, *words))


_words("--without an unknown camera", "--without", "cam_9", says=('no camera "cam_9"', "cam_01"))
_words("--without all cameras but one", *ALL_BUT_ONE, says=("1 camera left", "at least 2"))
_words("--frames outside the take", "--frames", "2:9", says=("frames 2 to 9", "0 to 3"))
_words("--frames in the wrong order", "--frames", "3:1", says=("3", "after", "swap"))
_words("--frames that are no numbers", "--frames", "a:b", says=("--frames", "A:B", "'a:b'"))
_words("--frames without the initial pose", "--frames", "2:3", says=("initial pose", "2 to 3"))
_words("--root elsewhere", "--root", "/nowhere", says=("outside /nowhere", "--root"))
