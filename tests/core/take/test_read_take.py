"""take.toml -> Take, and the one clear line for each way to get it wrong."""

from fractions import Fraction
from pathlib import Path

import pytest
from silhouette_mocap.core.body.rig_file import RigFile
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.fitting.search import Search
from silhouette_mocap.core.take import Adjustment, read_take
from silhouette_mocap.core.take.reading import exact_fps

MINIMAL = """
version = 1
fps = 15.0
[cameras]
calibration = "calibration.toml"
[footage]
silhouettes = "masks/{camera}/{frame:06d}.png"
"""
FULL = """
version = 1
name = "walk"
fps = 29.97
frames = [3, 74]
initial_pose = { frames = [4, 7], kind = "elbows" }
[cameras]
calibration = "../calibration.toml"
format = "toml"
units = "mm"
up = "-y"
adjust = { cam01 = { scale = 0.99265, shift = [0.0, 7.06] } }
[footage]
video = "videos/{camera}.mp4"
plate = "plates/{camera}.png"
extraction = "difference"
ignore = "ignore/{camera}.png"
[footage.difference]
threshold = 30
[performer]
body = "sixteen_segment"
height_m = 1.78
[world]
floor = -0.25
[fit]
tracker = "hierarchical"
setting = "faithful"
fast_motion = true
[export]
formats = ["fbx", "blend", "fbx"]
"""


@pytest.fixture
def folder(tmp_path) -> Path:
    (tmp_path / "session" / "take").mkdir(parents=True)
    return tmp_path.resolve() / "session" / "take"


def taken(folder: Path, text: str, **options):
    (folder / "take.toml").write_text(text, "utf-8")
    return read_take(folder / "take.toml", **options)


def complaint(folder: Path, text: str, **options) -> str:
    with pytest.raises(MocapError) as caught:
        taken(folder, text, **options)
    line = str(caught.value)
    assert "\n" not in line and str(folder.parent) in line
    return line


def test_the_least_that_a_take_needs_is_enough(folder):
    take = taken(folder, MINIMAL)
    assert (take.name, take.fps, take.frames) == ("take", 15, None)
    assert (take.initial_pose.frames, take.initial_pose.kind) == (None, None)
    assert take.cameras.calibration == folder / "calibration.toml"
    assert take.footage.silhouettes == str(folder / "masks/{camera}/{frame:06d}.png")
    assert (take.performer.body, take.performer.height_m, take.floor) == ("performer", None, 0)
    assert (take.search, take.exports) == (Search("contour", "robust", False), ())


def test_every_key_that_works_arrives(folder):
    take = taken(folder, FULL)
    assert (take.name, take.fps, take.frames) == ("walk", Fraction(30000, 1001), (3, 74))
    assert (take.initial_pose.frames, take.initial_pose.kind) == ((4, 7), "elbows")
    assert take.cameras.calibration == folder.parent / "calibration.toml"
    assert (take.cameras.format, take.cameras.units, take.cameras.up) == ("toml", "mm", "-y")
    assert take.cameras.adjust == {"cam01": Adjustment(0.99265, (0.0, 7.06))}
    assert take.footage.video == str(folder / "videos/{camera}.mp4")
    assert take.footage.plate == str(folder / "plates/{camera}.png")
    assert take.footage.ignore == str(folder / "ignore/{camera}.png")
    assert take.footage.silhouettes is None
    assert (take.footage.extraction, take.footage.extraction_settings) == (
        "difference",
        {"threshold": 30},
    )
    assert (take.performer.body, take.performer.height_m) == ("sixteen_segment", 1.78)
    assert (take.floor, take.exports) == (-0.25, ("fbx", "blend"))
    assert take.search == Search("hierarchical", "faithful", True)


@pytest.mark.parametrize(
    ("number", "exact"),
    [
        (29.97, Fraction(30000, 1001)),
        (23.976, Fraction(24000, 1001)),
        (23.98, Fraction(24000, 1001)),
        (59.94, Fraction(60000, 1001)),
        (119.88, Fraction(120000, 1001)),
        (15.0, Fraction(15)),
        (12.5, Fraction(25, 2)),
        (0.1, Fraction(1, 10)),
        (29.9, Fraction(299, 10)),
    ],
)
def test_frame_rates_are_exact_and_know_ntsc(number, exact):
    assert exact_fps(number) == exact


def test_a_shared_file_gives_what_the_take_leaves_open(folder):
    (folder.parent / "session.toml").write_text(
        'fps = 60.0\n[cameras]\ncalibration = "shared/cal.toml"\nunits = "mm"\n'
        "[performer]\nheight_m = 1.8\n",
        "utf-8",
    )
    take = taken(
        folder,
        'version = 1\nextends = "../session.toml"\n[cameras]\nunits = "cm"\n'
        '[footage]\nsilhouettes = "m/{camera}.mp4"\n',
    )
    assert take.fps == 60
    assert take.cameras.calibration == folder.parent / "shared/cal.toml"
    assert (take.cameras.units, take.performer.height_m) == ("cm", 1.8)


def test_files_that_extend_each_other_are_refused(folder):
    (folder / "other.toml").write_text('extends = "take.toml"\n', "utf-8")
    assert "extends itself" in complaint(folder, 'extends = "other.toml"\n' + MINIMAL)


def test_a_fault_in_a_shared_file_names_the_shared_file(folder):
    (folder.parent / "session.toml").write_text("fsp = 60.0\n", "utf-8")
    assert "session.toml: unknown key" in complaint(
        folder, 'extends = "../session.toml"\n' + MINIMAL
    )


@pytest.mark.parametrize(
    ("change", "into", "line"),
    [
        ("fps = 15.0", "fsp = 15.0", 'unknown key "fsp"; did you mean "fps"?'),
        ("fps = 15.0", "", '"fps" is missing'),
        ("fps = 15.0", "fps = 0", 'a number from 0.1 to 10000 for "fps", got a whole number (0)'),
        ("fps = 15.0", 'fps = "15"', "got a text ('15')"),
        ("fps = 15.0", "fps = true", "got true or false"),
        ("fps = 15.0", "fps = nan", 'expected a number from 0.1 to 10000 for "fps"'),
        ("version = 1", "version = 2", 'expected "version" = 1, got 2'),
        ("version = 1", "", 'expected "version" = 1, got none'),
        ("[cameras]", "frames = [5, 2]\n[cameras]", "0 <= first <= last"),
        ("[cameras]", "frames = [0, 1.5]\n[cameras]", "a list of 2 whole numbers"),
        ("[cameras]", 'name = "../out"\n[cameras]', "cannot name files"),
        ("[cameras]", "world = 3\n[cameras]", 'a table for "world", got a whole number (3)'),
        ("[footage]", "offsets = { a = 0.5 }\n[footage]", '"cameras.offsets" is not supported yet'),
        ("[footage]", "adjust = { a = { scal = 2 } }\n[footage]", 'did you mean "scale"'),
        ("[footage]", "adjust = { a = { scale = 0 } }\n[footage]", '"cameras.adjust.a.scale"'),
        ("[footage]", "adjust = { a = { shift = [1] } }\n[footage]", "a list of 2 numbers"),
        ("[footage]", '[footage]\nvideo = "v/{camera}.mp4"', "got both"),
        ("[footage]", '[footage]\nextraction = "knn"', '"knn" in "footage.extraction" is not supp'),
        ("[footage]", '[footage]\nextraction = "magic"', "one of statistics, difference"),
        ("[footage]", "[world]\nflor = 1\n[footage]", 'did you mean "floor"'),
        ("[footage]", '[performer]\nbody = "../../a.blend#Rig"\n[footage]', "outside"),
        ("[footage]", '[performer]\nbody = "actor#Rig"\n[footage]', "got a text ('actor#Rig')"),
        ("[footage]", '[performer]\nheight_m = "tall"\n[footage]', '"performer.height_m"'),
        ("[footage]", "[performer]\nheight_m = -1\n[footage]", '"performer.height_m"'),
        ("[footage]", '[fit]\nsetting = "quick"\n[footage]', "one of robust, faithful"),
        ("[footage]", "[fit]\nfast_motion = 1\n[footage]", "true or false"),
        ("[footage]", '[fit]\ntracker = "monte_carlo"\n[footage]', "use contour, hierarchical"),
        ("[footage]", '[fit]\ntracker = "contour"\nfast_motion = true\n[footage]', "belongs to"),
        ("[footage]", '[export]\nformats = ["glb"]\n[footage]', '"glb" in "export.formats"'),
        ("[footage]", '[export]\nformats = "fbx"\n[footage]', "a list of texts"),
        ("[footage]", "[footage.difference]\na = 1\n[footage]", "of no use"),
        ("[cameras]", 'initial_pose = { kind = "B" }\n[cameras]', "one of A, T, elbows"),
        (
            "[cameras]",
            "frames = [5, 9]\ninitial_pose = { frames = [0, 3] }\n[cameras]",
            "outside",
        ),
        ("[cameras]", "[cameras", "is not valid TOML"),
        ("calibration.toml", "../../calibration.toml", "outside"),
        ("masks/{camera}", "../../masks/{camera}", "outside"),
        ("masks/{camera}", "masks/{camera}/../../../..", "outside"),
    ],
)
def test_each_fault_gets_one_line_with_its_remedy(folder, change, into, line):
    assert change in MINIMAL
    assert line in complaint(folder, MINIMAL.replace(change, into, 1))


def test_a_link_does_not_lead_out_of_the_root(folder, tmp_path):
    (tmp_path / "elsewhere").mkdir()
    (folder / "masks").symlink_to(tmp_path / "elsewhere", target_is_directory=True)
    assert "outside" in complaint(folder, MINIMAL)
    take = taken(folder, MINIMAL, root=tmp_path)
    assert take.footage.silhouettes == str(
        tmp_path.resolve() / "elsewhere/{camera}/{frame:06d}.png"
    )


def test_a_missing_take_is_one_line(folder):
    with pytest.raises(MocapError, match="no such file; check the path"):
        read_take(folder / "nothing.toml")


def test_the_documented_captures_are_read():
    captures = Path(__file__).resolve().parents[4] / "shared" / "captures"
    paths = sorted(captures.glob("*/take.toml"))
    if not paths:
        pytest.skip("no captures beside the checkout")
    assert {read_take(path).performer.body for path in paths} == {"performer"}


def test_an_unknown_body_names_the_take_and_the_known_ones(folder):
    line = complaint(folder, MINIMAL + '[performer]\nbody = "centaur"\n')
    assert "centaur" in line and "performer, sixteen_segment" in line


@pytest.mark.parametrize("place", ["masks/\\u0000/{camera}.png", "{camera}/\\u0000.png"])
def test_a_path_that_no_file_can_have_is_told_with_its_key(folder, place):
    text = MINIMAL.replace("masks/{camera}/{frame:06d}.png", place)
    assert '"footage.silhouettes"' in complaint(folder, text)


def test_a_rig_is_a_file_and_an_armature_in_it(folder):
    rig = '[performer]\nbody = "../actor.blend#My Rig#2"\n[footage]'
    take = taken(folder, MINIMAL.replace("[footage]", rig))
    assert take.performer.body == RigFile(folder.parent / "actor.blend", "My Rig#2")
    assert take.initial_pose.kind is None
    for given, kind in (("frames = [0, 2]", "rest"), ('kind = "T"', "T")):
        asked = MINIMAL.replace("[cameras]", f"initial_pose = {{ {given} }}\n[cameras]")
        assert taken(folder, asked.replace("[footage]", rig)).initial_pose.kind == kind
