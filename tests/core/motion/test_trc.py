import numpy as np
import pytest
from silhouette_mocap.core.body.body import POINT_NAMES
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.motion.formats.trc import read_trc, write_trc
from silhouette_mocap.core.motion.motion import Motion

HEAD = """PathFileType\t4\t(X/Y/Z)\tdemo.trc
DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames
60\t60\t2\t2\tm\t60\t1\t2
Frame#\tTime\tHip\t\t\tKnee\t\t
\t\tX1\tY1\tZ1\tX2\tY2\tZ2
"""


@pytest.fixture
def motion():
    count = 5
    points = np.random.default_rng(3).normal(size=(count, 14, 3))
    points[2, 6] = np.nan
    empty = np.zeros((count, 0))
    return Motion(
        fps=(30000, 1001),
        frames=np.arange(10, 10 + count),
        pose=empty,
        pose_raw=empty,
        dof_names=(),
        joints=np.zeros((count, 0, 3)),
        joint_names=(),
        points=points,
        point_names=POINT_NAMES,
        xor_px=empty,
        iou=empty,
        view_weights=empty,
        limb_residual=np.zeros((count, 5)),
        camera_names=(),
        confidence=np.ones((count, 14)),
        lost=np.zeros(count, bool),
        locked=np.zeros(count, bool),
        confidence_raw=np.ones((count, 14)),
        keyed=np.zeros((count, 0), bool),
    )


def test_points_survive_the_file_to_a_hundredth_of_a_micrometre(motion, tmp_path):
    path = tmp_path / "walk.trc"
    write_trc(path, motion)
    read = read_trc(path)
    assert np.allclose(read.points, motion.points, atol=1e-8, equal_nan=True)
    assert read.names == POINT_NAMES
    assert read.fps == pytest.approx(30000 / 1001)
    assert np.array_equal(read.frames, motion.frames)


def test_files_are_in_millimetres_with_y_up_and_tabs_as_opensim_reads_them(motion, tmp_path):
    path = tmp_path / "walk.trc"
    write_trc(path, motion)
    lines = path.read_text().splitlines()
    assert lines[2].split("\t")[2:5] == ["5", "14", "mm"]
    assert lines[3].split("\t")[:6] == ["Frame#", "Time", "head", "", "", "neck"]
    assert lines[4].split("\t")[:6] == ["", "", "X1", "Y1", "Z1", "X2"]
    cells = lines[6].split("\t")
    x, y, z = motion.points[0, 0] * 1000
    assert [float(cell) for cell in cells[2:5]] == pytest.approx([y, z, x], abs=1e-5)
    assert float(cells[1]) == pytest.approx(10 * 1001 / 30000, abs=1e-6)
    assert {len(line.split("\t")) for line in lines[6:]} == {2 + 3 * 14}
    assert lines[8].split("\t")[2 + 3 * 6 :][:3] == ["", "", ""]  # the gap


def test_a_hand_written_file_in_metres_with_a_gap_is_read(tmp_path):
    path = tmp_path / "demo.trc"
    path.write_text(HEAD + "1\t0.0\t1\t2\t3\t\t\t\n2\t0.017\t4\t5\t6\t7\t8\t9\n")
    read = read_trc(path)
    assert read.names == ("Hip", "Knee")
    assert read.fps == 60
    assert np.allclose(read.points[:, 0], [[3, 1, 2], [6, 4, 5]])
    assert np.isnan(read.points[0, 1]).all()
    assert np.allclose(read.points[1, 1], [9, 7, 8])


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("hello", "is no TRC file"),
        (HEAD.replace("\tm\t", "\tfurlong\t"), "has the unit 'furlong'"),
        (HEAD.replace("60\t60", "fast\t60"), "has no DataRate"),
        (HEAD + "1\t0.0\t1\t2\n", "line 6 has 4 fields instead of 8"),
        (HEAD + "1\t0.0\t1\t2\tx\t1\t2\t3\n", "line 6 holds something that is no number"),
        (HEAD, "holds no frames"),
    ],
)
def test_a_bad_file_is_one_clear_line_with_its_name(text, problem, tmp_path):
    path = tmp_path / "bad.trc"
    path.write_text(text)
    with pytest.raises(MocapError, match=rf"bad\.trc: .*{problem}"):
        read_trc(path)


def test_a_binary_file_is_one_clear_line(tmp_path):
    binary = tmp_path / "binary.trc"
    binary.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(MocapError, match="cannot be read as TRC"):
        read_trc(binary)
