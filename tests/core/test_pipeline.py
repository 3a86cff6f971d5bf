"""The whole way from a take to its files, on a small one."""

import json
import threading
import time
from collections import defaultdict
from dataclasses import replace

import cv2
import numpy as np
import pytest
from silhouette_mocap.core import beginning
from silhouette_mocap.core.beginning import initial_frames
from silhouette_mocap.core.body.file import read_body, write_body
from silhouette_mocap.core.body.kinematics import points, rest_height
from silhouette_mocap.core.body.scaling import scaled
from silhouette_mocap.core.body.templates import template
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.fitting import passes, search
from silhouette_mocap.core.fitting.search import Search
from silhouette_mocap.core.motion.locks import write_locks
from silhouette_mocap.core.motion.motion import read_motion
from silhouette_mocap.core.pipeline import FitRequest, fit
from silhouette_mocap.core.progress import Silence
from silhouette_mocap.core.rendering import detail
from silhouette_mocap.core.results.exporting import check_formats, export
from silhouette_mocap.core.take import InitialPose, read_take
from silhouette_mocap.core.take.views import View
from small_take import Notes, known_start


@pytest.fixture(scope="module")
def fitted(small_take, tmp_path_factory):
    out = tmp_path_factory.mktemp("out")
    return fit(read_take(small_take), FitRequest(out), Silence()), out


def test_the_truth_is_found_within_a_pixel(fitted):
    result, _ = fitted
    # 4 m away with a focal length of 137 px, one pixel is 29 mm
    assert result.report["error_mm"]["absolute"]["mean"] < 20
    # a third of a pixel all along 170 px of contour, round a silhouette of 800 px
    assert result.report["iou"] > 0.93
    assert result.report["lost_frames"] == []


def test_all_files_are_written_and_agree(fitted):
    result, out = fitted
    assert sorted(path.name for path in out.iterdir()) == sorted(p.name for p in result.files)
    motion = read_motion(out / "motion.npz")
    np.testing.assert_array_equal(motion.frames, [0, 1, 2, 3])
    body = read_body(out / "body.npz")
    np.testing.assert_allclose(points(body, motion.pose), motion.points, atol=1e-6)
    report = json.loads((out / "report.json").read_text("utf-8"))
    assert len(report["seconds_per_frame"]) == len(report["evaluations_per_frame"]) == 4
    assert report["cameras"]["cam_01"]["working_size"] == [160, 120]
    assert report["surface"]["level"] == 0
    assert report["surface"]["outline_distance_px"] <= report["settings"]["outline_px"]
    video = cv2.VideoCapture(str(out / "overlay.mp4"))
    assert sum(video.read()[0] for _ in range(10)) == 4


def test_a_fitted_body_keeps_its_size(quick_start, small_take, tmp_path, monkeypatch):
    take, requests = read_take(small_take), []
    write_body(tmp_path / "actor.npz", scaled(template("sixteen_segment"), 0.9))
    take = replace(take, performer=replace(take.performer, body=tmp_path / "actor.npz"))
    initialised = beginning.initialised

    def watched(body, cameras, frames, request, make_evaluator):
        requests.append(request)
        return initialised(body, cameras, frames, request, make_evaluator)

    monkeypatch.setattr(beginning, "initialised", watched)
    fit(take, FitRequest(tmp_path / "out", frames=(0, 0)), Silence())
    assert requests[0].height_m == pytest.approx(rest_height(read_body(tmp_path / "actor.npz")))


def test_the_surface_that_is_told_is_the_one_that_is_fitted(
    quick_start, small_take, tmp_path, monkeypatch
):
    levels = []

    class Watched(search.HierarchicalTracker):
        def __init__(self, *arguments):
            super().__init__(*arguments)
            levels.append((self.evaluator.level, self.half_evaluator.level))

    monkeypatch.setattr(search, "HierarchicalTracker", Watched)
    # at 34 px to the metre the coarse outline is 0.020 px off, in halved pictures 0.010
    monkeypatch.setattr(detail, "OUTLINE_PX", 0.015)
    request = FitRequest(tmp_path / "out", search=Search("hierarchical"), frames=(0, 0))
    result = fit(read_take(small_take), request, Silence())
    assert levels == [(1, 0)]
    assert result.report["surface"]["level"] == 1


def test_the_take_chooses_how_hard_to_search(quick_start, small_take, tmp_path):
    evaluations = {}
    for setting in ("robust", "faithful"):
        wanted = Search("hierarchical", setting)
        request = FitRequest(tmp_path / setting, search=wanted, frames=(0, 1))
        result = fit(read_take(small_take), request, Silence())
        evaluations[setting] = sum(result.report["evaluations_per_frame"])
        assert result.report["settings"]["setting"] == setting
    assert evaluations["faithful"] < 0.7 * evaluations["robust"]


def test_the_tracker_hierarchical_takes_more_evaluations(fitted, small_take, tmp_path):
    request = FitRequest(tmp_path / "out", search=Search("hierarchical"))
    result = fit(read_take(small_take), request, Silence())
    assert fitted[0].report["settings"]["tracker"] == "contour"
    assert result.report["settings"]["tracker"] == "hierarchical"
    assert result.report["error_mm"]["absolute"]["mean"] < 29
    counts = [np.median(r.report["evaluations_per_frame"]) for r in (fitted[0], result)]
    assert counts[0] < 0.7 * counts[1]


def test_frames_before_the_initial_pose_are_tracked_backwards(quick_start, small_take, tmp_path):
    take = replace(read_take(small_take), initial_pose=InitialPose((1, 1), "A"))
    progress = Notes()
    result = fit(take, FitRequest(tmp_path, frames=(0, 2)), progress)
    assert progress.frames[:3] == [1, 2, 0]
    np.testing.assert_array_equal(result.motion.frames, [0, 1, 2])
    assert result.report["error_mm"]["absolute"]["max"] < 100


def test_a_take_without_an_initial_pose_starts_from_the_frame_that_is_found(
    small_take, tmp_path, monkeypatch
):
    take, found = replace(read_take(small_take), initial_pose=InitialPose(kind=None)), []
    search = beginning.found_unaided

    def last(body, footage, frames, request, make_evaluator):
        found.append(list(frames))
        return search(body, footage, frames[-1:], request, make_evaluator)

    monkeypatch.setattr(beginning, "found_unaided", last)
    progress = Notes()
    result = fit(take, FitRequest(tmp_path), progress)
    assert found == [[0, 1, 2, 3]]
    assert progress.frames == [3, 2, 1, 0]
    assert any("frame 3 was chosen" in note for note in progress.told)
    # 4 m away with a focal length of 137 px, one pixel is 29 mm
    assert result.report["error_mm"]["absolute"]["mean"] < 29


def test_what_is_doubtful_in_the_first_pose_is_told_by_all_means(small_take, tmp_path, monkeypatch):
    def doubtful(*arguments):
        return known_start(*arguments).with_words("Left may be right.", doubtful=True)

    class Warned(Notes):
        def warn(self, text):
            self.told.append(f"warned: {text}")

    monkeypatch.setattr(beginning, "initialised", doubtful)
    progress = Warned()
    result = fit(read_take(small_take), FitRequest(tmp_path, frames=(0, 0)), progress)
    assert "warned: Left may be right." in progress.told
    assert "Left may be right." in result.report["notes"]


def test_frames_to_choose_from_lie_all_over_the_take_and_between_them(small_take):
    take = replace(read_take(small_take), initial_pose=InitialPose(kind=None))
    begin = initial_frames(take, (10, 80))
    assert begin == (10, 20, 30, 40, 50, 60, 70, 80)
    assert beginning.searched_frames(begin) == list(range(10, 81, 5))
    assert beginning.searched_frames([3]) == [3]


def test_no_footage_is_read_by_two_threads_at_once(quick_start, small_take, tmp_path, monkeypatch):
    busy, faults = defaultdict(threading.Lock), []

    def alone(read):
        def checked(view, frame):
            lock = busy[view.camera.name]
            if not lock.acquire(blocking=False):
                faults.append((view.camera.name, frame))
                return read(view, frame)
            time.sleep(0.002)
            found = read(view, frame)
            lock.release()
            return found

        return checked

    for name in ("silhouette", "picture"):
        monkeypatch.setattr(View, name, alone(getattr(View, name)))
    fit(read_take(small_take), FitRequest(tmp_path), Silence())
    assert busy and not faults


def test_the_motion_goes_through_locked_poses(quick_start, small_take, tmp_path):
    plain = fit(read_take(small_take), FitRequest(tmp_path / "plain"), Silence()).motion
    body = read_body(tmp_path / "plain" / "body.npz")
    lock = plain.pose_raw[2].copy()
    lock[body.dofs.names.index("left_shoulder_flexion")] += 0.1
    write_locks(tmp_path / "locks.npz", body, {2: lock})
    take = replace(read_take(small_take), locks=tmp_path / "locks.npz")
    motion = fit(take, FitRequest(tmp_path / "out"), Silence()).motion
    assert motion.locked.tolist() == [False, False, True, False]
    np.testing.assert_array_equal(motion.pose[2], lock)
    assert not np.array_equal(motion.pose[3], plain.pose[3])
    # a lock that changed since is another input
    write_locks(tmp_path / "locks.npz", body, {2: plain.pose_raw[2]})
    with pytest.raises(MocapError, match="locks"):
        fit(take, FitRequest(tmp_path / "out", resume=True), Silence())


def test_an_interrupted_fit_keeps_the_finished_frames(
    quick_start, small_take, tmp_path, monkeypatch
):
    track = passes.track

    def interrupted(*search):
        for number, found in enumerate(track(*search)):
            if number == 2:
                raise KeyboardInterrupt
            yield found

    monkeypatch.setattr(passes, "track", interrupted)
    progress = Notes()
    with pytest.raises(KeyboardInterrupt):
        fit(read_take(small_take), FitRequest(tmp_path), progress)
    np.testing.assert_array_equal(read_motion(tmp_path / "motion.npz").frames, [0, 1])
    assert progress.told[-1] == (
        f"the 2 finished frames are kept in {tmp_path / 'motion.npz'}; --resume goes on"
    )


@pytest.mark.parametrize(
    ("shown", "frames", "used"),
    [
        ((0, 7), (0, 74), (0, 1, 2, 3, 4, 5, 6, 7)),
        ((0, 20), (5, 74), (5, 7, 9, 11, 14, 16, 18, 20)),
        ((3, 3), (0, 74), (3,)),
        (None, (6, 74), (6,)),
    ],
)
def test_the_initial_frames_are_those_of_the_take_that_are_fitted(small_take, shown, frames, used):
    take = replace(read_take(small_take), initial_pose=InitialPose(shown))
    assert initial_frames(take, frames) == used


def test_frames_without_the_initial_pose_are_refused(small_take):
    take = replace(read_take(small_take), initial_pose=InitialPose((0, 1)))
    with pytest.raises(MocapError, match="in frames 0 to 1, outside 2 to 3"):
        initial_frames(take, (2, 3))


def test_what_needs_blender_is_refused_without_it():
    with pytest.raises(MocapError, match=r"fbx, bvh.*pip install silhouette-mocap\[blender\]"):
        check_formats(("fbx", "trc", "bvh"), None)
    check_formats(("trc",), None)


def test_trc_needs_no_blender(fitted, small_take):
    _, out = fitted
    (path,) = export(read_take(small_take), out, ("trc",), None)
    assert path == out / "small.trc" and path.read_text("utf-8").startswith("PathFileType")
    path.unlink()


def test_the_exporter_gets_the_fit_and_the_footage(fitted, small_take):
    _, out = fitted
    asked = []

    def exporter(request):
        asked.append(request)
        return ()

    export(read_take(small_take), out, ("blend",), exporter)
    (request,) = asked
    assert request.name == "small" and request.folder == out and len(request.cameras) == 5
    assert request.footage["cam_02"].endswith("masks/cam_02/{frame:06d}.png")
