"""Faults of the place where results shall go."""

from pathlib import Path

from circumstances import ON_LINUX, ON_UNIX, bound_by_permissions, hardly_any_space
from faults import Chapter, fit_words, replace_text
from silhouette_mocap.core.body.file import write_body
from silhouette_mocap.core.body.templates import template
from silhouette_mocap.core.results.folder import occupied

OUTPUT = Chapter("The result")


@OUTPUT.add(
    "a folder without write permission",
    "closed/out: cannot be written (Permission denied)",
    "may write to",
    within=bound_by_permissions,
    early=False,
    unless=ON_LINUX,
)
def _(folder: Path):
    closed = folder.parent / "closed"
    closed.mkdir(mode=0o500)
    return ("fit", folder / "take.toml", "--out", closed / "out")


@OUTPUT.add(
    "an existing folder without write permission",
    "closed",
    "Permission denied",
    "may write to",
    within=bound_by_permissions,
    early=False,
    unless=ON_LINUX,
)
def _(folder: Path):
    closed = folder.parent / "closed"
    closed.mkdir(mode=0o500)
    return ("fit", folder / "take.toml", "--out", closed)


@OUTPUT.add("a file in the place of the folder", "out", "cannot be written", early=False)
def _(folder: Path):
    (folder.parent / "out").write_text("", "utf-8")


@OUTPUT.add("a path that is too long", "File name too long", "shorter", early=False, unless=ON_UNIX)
def _(folder: Path):
    return ("fit", folder / "take.toml", "--out", folder.parent / ("long" * 100))


@OUTPUT.add(
    "a full disk",
    "out",
    "cannot be written",
    "free space",
    within=hardly_any_space,
    early=False,
    unless=ON_UNIX,
)
def _(folder: Path):
    return fit_words(folder, "--frames", "0:0")


@OUTPUT.add(
    "a format that only Blender writes", "fbx", "pip install silhouette-mocap[blender]", early=False
)
def _(folder: Path):
    return fit_words(folder, "--export", "fbx")


@OUTPUT.add("an unknown export format", "--export", "'doc'", early=False)
def _(folder: Path):
    return fit_words(folder, "--export", "doc")


@OUTPUT.add("export before the fit", "motion.npz", "no such", early=False)
def _(folder: Path):
    return ("export", folder / "take.toml", "--out", folder.parent, "--export", "trc")


@OUTPUT.add(
    "two runs into one folder",
    "out: another run writes into this folder (process",
    "wait for it, or give another folder",
    within=lambda folder: occupied(folder.parent / "out"),
    early=False,
)
def _(folder: Path):
    pass


@OUTPUT.add(
    "a result that would replace the take's body",
    "small/body.npz: is the body that the take names",
    "give another folder",
    early=False,
)
def _(folder: Path):
    write_body(folder / "body.npz", template("sixteen_segment"))
    replace_text(folder / "take.toml", '"sixteen_segment"', '"body.npz"')
    return ("fit", folder / "take.toml", "--out", folder)


@OUTPUT.add(
    "a body that would replace that of a fit",
    "small: holds a fit, whose body would be replaced",
    "give another folder",
    early=False,
)
def _(folder: Path):
    (folder / "motion.npz").touch()
    return ("initialise", folder / "take.toml", "--out", folder)


@OUTPUT.add(
    "masks that would replace the masks they are made from",
    "masks/cam_01, camera cam_01: holds the pictures of the take",
    "give another folder",
    early=False,
)
def _(folder: Path):
    return ("masks", folder / "take.toml", "--out", folder / "masks")
