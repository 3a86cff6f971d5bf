"""Planted errors come out of the score as planted."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from silhouette_mocap.core.body.body import POINT_NAMES
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.motion.point_track import PointTrack, read_point_track
from silhouette_mocap.core.motion.scoring import aligned_in_time, aligned_rigidly, score

FRAMES = 120
# head neck shoulders elbows wrists hips knees ankles of someone standing, metres
STANDING = np.array(
    [
        [0, 0, 1.65], [0, 0, 1.5], [0.18, 0, 1.45], [-0.18, 0, 1.45], [0.4, 0, 1.3],
        [-0.4, 0, 1.3], [0.6, 0, 1.2], [-0.6, 0, 1.2], [0.1, 0, 0.95], [-0.1, 0, 0.95],
        [0.12, 0, 0.5], [-0.12, 0, 0.5], [0.15, 0, 0.08], [-0.15, 0, 0.08],
    ]
)  # fmt: skip


def turning() -> Rotation:
    return Rotation.from_rotvec(np.linspace(0, 4 * np.pi, FRAMES)[:, None] * [0, 0, 1])


def walking() -> np.ndarray:
    """(T, 14, 3) a person who turns twice while moving two metres."""
    turned = np.einsum("tij,pj->tpi", turning().as_matrix(), STANDING)
    path = np.stack([np.linspace(-1, 1, FRAMES), np.zeros(FRAMES), np.zeros(FRAMES)], axis=-1)
    return turned + path[:, None]


def track(points: np.ndarray, **fields) -> PointTrack:
    values = {"names": POINT_NAMES, "frames": np.arange(len(points)), "fps": 15.0}
    return PointTrack(points=points, **{**values, **fields})


def test_a_perfect_motion_has_no_error():
    result = score(track(walking()), track(walking()))
    assert result.absolute.max == result.root.max == result.offset_removed.max == 0
    assert result.jitter == 0 and result.lost_frames == result.limb_losses == 0


def test_an_offset_fixed_to_the_pelvis_is_removed():
    moved = walking()
    elbow = POINT_NAMES.index("left_elbow")
    moved[:, elbow] += turning().apply([0, 0.04, 0])
    result = score(track(walking()), track(moved))
    assert result.points["left_elbow"].error.mean == pytest.approx(40)
    assert result.absolute.mean == pytest.approx(40 / 14)
    assert result.offset_removed.mean == pytest.approx(0, abs=1e-6)
    assert result.offset_space == "pelvis"
    assert np.linalg.norm(result.points["left_elbow"].offset) == pytest.approx(40)


def test_an_offset_fixed_to_another_bone_needs_that_bones_rotations():
    wrist = POINT_NAMES.index("left_wrist")
    bone = Rotation.from_rotvec(np.linspace(0, 3 * np.pi, FRAMES)[:, None] * [1, 0, 0])
    moved = walking()
    moved[:, wrist] += bone.apply([0, 0.03, 0])
    rotations = np.repeat(turning().as_matrix()[:, None], 14, axis=1)
    rotations[:, wrist] = bone.as_matrix()
    with_bones = score(track(walking(), rotations=rotations), track(moved))
    assert with_bones.points["left_wrist"].offset_removed == pytest.approx(0, abs=1e-6)
    assert with_bones.offset_space == "bone"
    without = score(track(walking()), track(moved))
    assert without.points["left_wrist"].offset_removed > 10


def test_offsets_are_learnt_on_even_seconds_and_judged_on_odd_ones():
    second = np.arange(FRAMES) // 15
    moved = walking()
    moved[second % 2 == 1, 0] += np.array([0, 0, 0.05])
    unlearnt = score(track(walking()), track(moved)).points["head"]
    assert unlearnt.offset == (0, 0, 0) and unlearnt.offset_removed == pytest.approx(50)
    moved[second % 2 == 0, 0] += np.array([0, 0, 0.05])
    assert score(track(walking()), track(moved)).points["head"].offset_removed < 1e-6


def test_a_shift_of_the_whole_body_is_no_error_about_the_root():
    result = score(track(walking()), track(walking() + np.array([0.1, 0, 0])))
    assert result.absolute.mean == pytest.approx(100)
    assert result.root.mean == pytest.approx(0, abs=1e-6)


def test_lost_and_missing_frames_are_counted_whatever_the_order_of_the_points():
    moved = walking()
    moved[30:40] += [0, 0, 0.3]
    kept = np.setdiff1d(np.arange(FRAMES), np.arange(100, 105))
    order = np.random.default_rng(0).permutation(14)
    names = tuple(POINT_NAMES[k] for k in order)
    result = score(
        track(walking()), PointTrack(names=names, frames=kept, points=moved[kept][:, order])
    )
    assert (result.lost_frames, result.missing_frames, result.worst_frame) == (15, 5, 100)
    assert result.absolute.mean == pytest.approx(300 * 10 / 115)
    assert result.absolute.p95 == pytest.approx(300)


def test_a_limb_is_lost_from_two_frames_on():
    moved = walking()
    wrist, ankle = POINT_NAMES.index("left_wrist"), POINT_NAMES.index("right_ankle")
    moved[10, wrist] += 1
    moved[20:22, wrist] += 1
    moved[40:45, ankle] += 1
    moved[118:, ankle] += 1
    result = score(track(walking()), track(moved))
    assert result.limb_losses == 3
    assert result.frames_with_a_lost_limb == 1 + 4 + 1


def test_white_noise_has_the_error_and_jitter_that_theory_says():
    noise = np.random.default_rng(0).normal(0, 0.005, (FRAMES, 14, 3))
    result = score(track(walking()), track(walking() + noise))
    assert result.absolute.mean == pytest.approx(5 * np.sqrt(8 / np.pi), abs=0.3)
    assert result.jitter == pytest.approx(5 * np.sqrt(18), abs=1)


def test_swapped_sides_are_seen():
    order = [
        POINT_NAMES.index(n.replace("left", "#").replace("right", "left").replace("#", "right"))
        for n in POINT_NAMES
    ]
    assert score(track(walking()), track(walking()[:, order])).absolute.mean > 100


def test_a_reference_may_hold_a_subset_of_the_points():
    kept = [POINT_NAMES.index("head"), POINT_NAMES.index("left_wrist")]
    subset = track(walking()[:, kept], names=("head", "left_wrist"))
    result = score(subset, track(walking() + np.array([0.02, 0, 0])))
    assert list(result.points) == ["head", "left_wrist"]
    assert result.absolute.mean == pytest.approx(20)
    assert np.isnan(result.root.mean) and result.offset_space == "none"


def test_a_missing_point_and_frames_apart_are_said():
    with pytest.raises(MocapError, match="lacks the points neck"):
        score(track(walking()), track(walking()[:, :1], names=("head",)))
    with pytest.raises(MocapError, match="no frame in common"):
        score(track(walking()), track(walking(), frames=np.arange(FRAMES) + 1000))


def test_alignment_finds_the_planted_turn_shift_and_delay():
    turn = Rotation.from_euler("xyz", [10, -20, 100], degrees=True)
    moved = turn.apply(walking().reshape(-1, 3)).reshape(-1, 14, 3) + np.array([1, 2, 3])
    prediction = track(moved, frames=np.arange(FRAMES) + 7)
    delayed = aligned_in_time(track(walking()), prediction, rigid=True)
    np.testing.assert_array_equal(delayed.frames, np.arange(FRAMES))
    result = score(track(walking()), aligned_rigidly(track(walking()), delayed))
    assert result.absolute.max == pytest.approx(0, abs=1e-6)


def test_joints_stand_in_for_points(tmp_path):
    path = tmp_path / "truth.npz"
    np.savez(path, joints=walking(), joint_names=POINT_NAMES, fps=[30000, 1001])
    stored = read_point_track(path)
    assert stored.names == POINT_NAMES and stored.fps == pytest.approx(29.97003)
    np.testing.assert_array_equal(stored.frames, np.arange(FRAMES))


@pytest.mark.parametrize("name", ["missing.npz", "broken.npz", "other.txt"])
def test_a_file_without_points_is_one_line(tmp_path, name):
    (tmp_path / "broken.npz").write_bytes(b"no zip")
    with pytest.raises(MocapError, match=name):
        read_point_track(tmp_path / name)


def test_the_score_agrees_with_the_reference_implementation():
    shared = Path(__file__).resolve().parents[4] / "shared"
    truths = sorted(shared.glob("captures/*/truth.npz"))
    if not truths:
        pytest.skip("no captures beside the checkout")
    spec = importlib.util.spec_from_file_location("their_score", shared / "tools" / "score.py")
    theirs = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(theirs)
    rng = np.random.default_rng(1)
    for path in truths:
        with np.load(path, allow_pickle=False) as data:
            truth = dict(data)
        points = truth["points"] + rng.normal(0, 0.06, truth["points"].shape).cumsum(axis=0) / 4
        kept = np.setdiff1d(np.arange(len(points)), [11, 12])
        pred = {"points": points[kept], "point_names": truth["point_names"], "frames": kept}
        names, T, P, rotations = theirs.align(truth, pred)
        expected = theirs.score(
            names, T, P, np.arange(len(T)), 150.0, rotations, float(truth["fps"])
        )
        got = score(
            read_point_track(path),
            PointTrack(tuple(map(str, truth["point_names"])), kept, points[kept]),
        )
        for key, ours in (
            ("abs", got.absolute), ("root", got.root), ("offset", got.offset_removed),
        ):  # fmt: skip
            for stat, value in expected[key].items():
                assert getattr(ours, stat) == pytest.approx(value, abs=0.1), (path, key, stat)
        assert got.jitter == pytest.approx(expected["jitter_mm_per_frame2"], abs=0.1)
        for key in ("lost_frames", "missing_frames", "limb_losses", "frames_with_a_lost_limb",
                    "worst_frame"):  # fmt: skip
            assert getattr(got, key) == expected[key], (path, key)
        for name, values in expected["joints"].items():
            assert got.points[name].offset_removed == pytest.approx(
                values["after_offset_mean"], abs=0.1
            )
