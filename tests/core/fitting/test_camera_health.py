"""Takes in which one camera lies, or none; the poses are known, not tracked."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from silhouette_mocap.core.fitting.camera_health import camera_findings
from silhouette_mocap.core.fitting.scores import frame_scores
from silhouette_mocap.core.fitting.tracker import Tally
from silhouette_mocap.core.fitting.tracking import FrameFit
from silhouette_mocap.core.silhouettes.silhouette import Silhouette
from synthetic import dof_values, evaluator, filmed, small_body, small_studio

FRAMES = 20
LIAR = 2
SOME = range(8, 16)


def motion(body):
    """Poses of somebody who walks about and swings arms and legs, never at an even speed."""
    for k in range(FRAMES):
        swing = np.sin(0.5 * k)
        yield dof_values(
            body,
            root_x=0.5 * np.sin(0.3 * k),
            root_y=0.3 * np.cos(0.23 * k),
            left_shoulder_abduction=0.5 + 0.4 * swing,
            right_shoulder_abduction=0.5 - 0.4 * np.cos(0.4 * k),
            left_hip_flexion=0.4 * swing,
            right_hip_flexion=-0.4 * swing,
        )


@pytest.fixture(scope="module")
def scene():
    """Body, cameras, poses and what the cameras see of them."""
    body, cameras = small_body("performer"), small_studio()
    poses = list(motion(body))
    return body, cameras, poses, [filmed(body, cameras, pose) for pose in poses]


def found_in(scene, seen, cameras=None, pulled_m=0.0):
    """Findings where ``seen`` is what cameras show that are thought to be ``cameras``."""
    body, true_cameras, poses, _ = scene
    draws = evaluator(body, cameras or true_cameras)
    fits = {}
    for frame, pose in enumerate(poses):
        pose = pose + dof_values(body, root_x=pulled_m) - body.rest_pose
        scores = frame_scores(draws, pose, seen[frame])
        fits[frame] = FrameFit(frame, pose, scores, Tally(), 0.0)
    return camera_findings(draws, fits, lambda frame: seen[frame])


def lied(scene, lie, frames=range(FRAMES)):
    """What is seen where the liar shows ``lie`` of frame and silhouette in ``frames``."""
    seen = [list(silhouettes) for silhouettes in scene[3]]
    for frame in frames:
        seen[frame][LIAR] = lie(frame, scene[3][frame][LIAR])
    return [tuple(silhouettes) for silhouettes in seen]


def shifted_by(right, down):
    def lie(frame, silhouette):
        moved = np.roll(silhouette.foreground, (down, right), (0, 1))
        return Silhouette(moved, silhouette.observed)

    return lie


def other_moment(scene, later):
    return lambda frame, _: scene[3][min(max(frame + later, 0), FRAMES - 1)][LIAR]


def only(findings, kind):
    """The one finding, which is of the liar and of this kind."""
    (finding,) = findings
    assert (finding.camera, finding.kind) == (small_studio()[LIAR].name, kind)
    return finding


def test_cameras_that_tell_the_truth_are_not_accused(scene):
    assert found_in(scene, scene[3]) == ()
    # nor is one that takes the pose along a little
    assert found_in(scene, scene[3], pulled_m=0.01) == ()


def test_a_camera_that_shows_nobody_is_dead(scene):
    def lie(frame, silhouette):
        return Silhouette(np.zeros_like(silhouette.foreground), silhouette.observed)

    finding = only(found_in(scene, lied(scene, lie, SOME)), "dead")
    assert finding.frames == (8, 15)
    assert "is dead in frames 8 to 15: it shows nobody where the others do" in finding.text


def test_a_camera_that_shows_one_picture_again_and_again_is_frozen(scene):
    still = scene[3][8][LIAR]
    finding = only(found_in(scene, lied(scene, lambda *_: still, SOME)), "frozen")
    assert finding.frames == (8, 15)
    assert "is frozen in frames 8 to 15" in finding.text


def test_a_performer_who_stands_still_freezes_no_camera(scene):
    body, cameras, poses, seen = scene
    standing = (body, cameras, [poses[0]] * FRAMES, [seen[0]] * FRAMES)
    assert found_in(standing, standing[3]) == ()


@pytest.mark.parametrize(
    ("later", "told"),
    [
        (-1, "runs about 1 frame late: cut 1 frame from the start of its footage"),
        (2, "runs about 2 frames early: cut 2 frames from the start of all other footage"),
    ],
)
def test_a_camera_out_of_step_is_told_by_how_much(scene, later, told):
    finding = only(found_in(scene, lied(scene, other_moment(scene, later))), "delay")
    # the first or last frames stand still, so that a little is missing
    assert finding.figures["late_frames"] == pytest.approx(-later, abs=0.2)
    assert finding.text.endswith(told)


@pytest.mark.parametrize("pulled_m", [0.0, 0.02])
def test_a_camera_turned_since_its_calibration_sees_everything_beside(scene, pulled_m):
    cameras = list(scene[1])
    camera = cameras[LIAR]
    turn = Rotation.from_euler("y", 1.5, degrees=True).as_matrix()
    rotation = turn @ camera.rotation
    pose = np.column_stack([rotation, -rotation @ camera.centre])
    cameras[LIAR] = replace(camera, camera_from_world=pose)
    finding = only(found_in(scene, scene[3], tuple(cameras), pulled_m), "place")
    # thought to look further to the left, it shows things further to the left than expected
    px = camera.matrix[0, 0] * np.tan(np.radians(1.5))
    assert finding.figures["right_px"] == pytest.approx(-px, abs=0.35)
    assert finding.figures["down_px"] == pytest.approx(0, abs=0.35)
    assert "px too far left, as if turned by 1." in finding.text
    assert finding.text.endswith(": calibrate it anew")


def test_a_camera_that_is_knocked_over_is_told_with_the_frame(scene):
    seen = lied(scene, shifted_by(3, -2), range(10, FRAMES))
    finding = only(found_in(scene, seen), "place")
    assert abs(finding.frames[0] - 10) <= 2 and finding.frames[1] == FRAMES - 1
    assert finding.figures["right_px"] == pytest.approx(3, abs=0.35)
    assert finding.figures["down_px"] == pytest.approx(-2, abs=0.35)
    assert "it was moved then" in finding.text


@pytest.mark.parametrize(("px", "size"), [(2, "larger"), (-1, "smaller")])
def test_silhouettes_that_are_larger_or_smaller_all_round_are_told(scene, px, size):
    def lie(frame, silhouette):
        return Silhouette(silhouette.distances < px, silhouette.observed)

    finding = only(found_in(scene, lied(scene, lie)), "swelling")
    # thin limbs vanish when they shrink
    assert finding.figures["larger_px"] == pytest.approx(px, abs=0.5)
    assert f"px {size} all round than the others'" in finding.text


@pytest.mark.parametrize(("rows", "told"), [(0.55, "it lacks "), (None, "more than the performer")])
def test_a_camera_that_is_badly_segmented_for_some_time_is_told_with_why(scene, rows, told):
    def lie(frame, silhouette):
        mask = silhouette.foreground.copy()
        if rows is None:
            mask[80:, :60] = True
        else:
            mask[round(rows * len(mask)) :] = False
        return Silhouette(mask, silhouette.observed)

    finding = only(found_in(scene, lied(scene, lie, SOME)), "bad silhouettes")
    assert finding.frames == (8, 15)
    assert told in finding.text and finding.figures["trust"] < 0.4


def test_of_two_cameras_that_disagree_neither_is_accused_alone(scene):
    body, cameras, poses, seen = scene
    pair = [0, LIAR]
    two = (body, tuple(cameras[k] for k in pair), poses, None)
    lie = shifted_by(0, 4)
    shown = [(s[0], lie(0, s[LIAR])) for s in seen]
    for finding in found_in(two, shown):
        assert finding.perhaps and " or " in finding.text


def test_a_take_too_short_to_tell_why_tells_only_that_a_camera_is_not_trusted(scene):
    body, cameras, poses, _ = scene
    seen = lied(scene, shifted_by(3, 0))
    only(found_in(scene, seen), "place")
    only(found_in((body, cameras, poses[:5], None), seen[:5]), "bad silhouettes")
