"""A fit that was cut off comes to the same as one that was not."""

import json
import shutil
from dataclasses import replace

import cv2
import numpy as np
import pytest
from silhouette_mocap.core import pipeline
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.fitting import passes
from silhouette_mocap.core.fitting.search import Search
from silhouette_mocap.core.motion.motion import read_motion, write_motion
from silhouette_mocap.core.pipeline import FitRequest, fit
from silhouette_mocap.core.progress import Silence
from silhouette_mocap.core.results.journal import SET_ASIDE, UNFINISHED
from silhouette_mocap.core.take import InitialPose, read_take
from small_take import Notes

SAME = ("motion.npz", "body.npz", "overlay.mp4")
FRAMES = 4


def asked(out, **changes) -> FitRequest:
    """A quick fit, with three of the five cameras."""
    quick = {"search": Search(setting="faithful"), "without": ("cam_04", "cam_05")}
    return FitRequest(out, **{**quick, **changes})


class Killed(BaseException):
    """Stands for what leaves no time to write results."""


@pytest.fixture
def take_file(quick_start, small_take, tmp_path):
    """A small take of one's own, whose fits start at once."""
    return shutil.copytree(small_take.parent, tmp_path / "session" / "small") / "take.toml"


@pytest.fixture
def cut_off(take_file, tmp_path, monkeypatch):
    """Fits that end after some frames, leaving nothing but what was kept at once."""

    def until(count, take=None, out=tmp_path / "out", **request):
        track = passes.track
        left = [count]

        def failing(*search):
            for found in track(*search):
                if not left[0]:
                    raise Killed
                left[0] -= 1
                yield found

        def killed(*everything):
            raise Killed

        with monkeypatch.context() as patch, pytest.raises(Killed):
            patch.setattr(passes, "track", failing)
            patch.setattr(pipeline, "write_results", killed)
            fit(take or read_take(take_file), asked(out, **request), Silence())
        return out

    return until


def contents(out) -> dict[str, bytes]:
    return {name: (out / name).read_bytes() for name in SAME}


def timeless(out) -> dict:
    report = json.loads((out / "report.json").read_text("utf-8"))
    report.pop("seconds_per_frame")
    return report


@pytest.mark.parametrize(("first", "cuts"), [(0, range(FRAMES + 1)), (2, (1, 3))])
def test_every_cut_is_mended_bit_by_bit(take_file, cut_off, tmp_path, first, cuts):
    take = replace(read_take(take_file), initial_pose=InitialPose((first, first), "A"))
    fit(take, asked(tmp_path / "whole"), Silence())
    for count in cuts:
        out = cut_off(count, take)
        notes = Notes()
        fit(take, asked(out, resume=True), notes)
        assert len(notes.frames) == FRAMES - count
        assert f"{count} frames were finished before" in notes.told
        assert contents(out) == contents(tmp_path / "whole")
        assert timeless(out) == timeless(tmp_path / "whole")
        assert not (out / UNFINISHED).exists()


def test_a_fit_may_be_cut_off_again_and_again(take_file, cut_off, tmp_path):
    fit(read_take(take_file), asked(tmp_path / "whole"), Silence())
    for count in (1, 0, 2, 0):
        cut_off(count, resume=True)
    fit(read_take(take_file), asked(tmp_path / "out", resume=True), Silence())
    assert contents(tmp_path / "out") == contents(tmp_path / "whole")


@pytest.mark.parametrize("step", ["with_overlay", "write_results"])
def test_a_cut_while_results_are_written_is_mended(take_file, tmp_path, monkeypatch, step):
    def killed(*everything):
        raise Killed

    take = read_take(take_file)
    fit(take, asked(tmp_path / "whole"), Silence())
    with monkeypatch.context() as patch, pytest.raises(Killed):
        patch.setattr(pipeline, step, killed)
        fit(take, asked(tmp_path / "out"), Silence())
    notes = Notes()
    fit(take, asked(tmp_path / "out", resume=True), notes)
    assert not notes.frames and contents(tmp_path / "out") == contents(tmp_path / "whole")


def test_resuming_a_finished_fit_does_nothing(take_file, tmp_path):
    take, request = read_take(take_file), asked(tmp_path / "out", resume=True)
    first = fit(take, request, Silence())
    before = {path: path.stat().st_mtime_ns for path in request.out.iterdir()}
    notes = Notes()
    second = fit(take, request, notes)
    assert "were finished before" in notes.told[-1] and not notes.frames
    assert second.files == () and second.report == first.report
    assert {path: path.stat().st_mtime_ns for path in request.out.iterdir()} == before


@pytest.mark.parametrize("finished", [True, False])
@pytest.mark.parametrize(
    ("change", "named"),
    [
        (
            {"search": Search(setting="robust")},
            r"fit\.setting was faithful, now robust",
        ),
        ({"frames": (0, 2)}, r"fit\.frames was \[0, 3\], now \[0, 2\]"),
        ({"evaluator": "reference"}, r"fit\.evaluator was native, now reference"),
        (
            {"without": ("cam_05",)},
            r'fit\.without was \["cam_04", "cam_05"\], now \["cam_05"\], camera cam_04 is new',
        ),
    ],
)
def test_other_settings_are_refused_by_name(take_file, cut_off, tmp_path, change, named, finished):
    if finished:
        fit(read_take(take_file), asked(tmp_path / "out"), Silence())
    else:
        cut_off(2)
    request = asked(tmp_path / "out", resume=True, **change)
    with pytest.raises(MocapError, match=f"out: this fit was begun otherwise: {named}.*--resume"):
        fit(read_take(take_file), request, Silence())


def test_a_changed_take_is_refused_by_the_names_of_its_keys(take_file, cut_off, tmp_path):
    cut_off(2)
    text = take_file.read_text("utf-8").replace("fps = 15.0", "fps = 25.0")
    take_file.write_text(text + "height_m = 1.7\n", "utf-8")
    calibration = take_file.with_name("calibration.toml")
    changed = (
        calibration.read_text("utf-8").replace("137.0", "138.0", 3).replace("138.0", "137.0", 2)
    )
    calibration.write_text(changed, "utf-8")
    wanted = (
        "fps was 15, now 25, camera cam_02 has changed, "
        "performer.height_m was not given, now 1.7; change it back"
    )
    with pytest.raises(MocapError, match=wanted):
        fit(read_take(take_file), asked(tmp_path / "out", resume=True), Silence())


def test_changed_footage_of_a_finished_frame_is_refused(take_file, cut_off, tmp_path):
    cut_off(2)
    repaint(take_file, "cam_03", 1)
    with pytest.raises(
        MocapError,
        match=r"camera cam_03, frame 1: the footage has changed since",
    ):
        fit(read_take(take_file), asked(tmp_path / "out", resume=True), Silence())


def test_changed_footage_of_the_initial_pose_is_refused(take_file, cut_off, tmp_path):
    cut_off(0)
    repaint(take_file, "cam_02", 1)
    with pytest.raises(MocapError, match=r"camera cam_02, frame 1: the footage has changed since"):
        fit(read_take(take_file), asked(tmp_path / "out", resume=True), Silence())


def test_what_went_of_a_finished_fit_is_told(take_file, tmp_path):
    request = asked(tmp_path / "out", resume=True)
    fit(read_take(take_file), request, Silence())
    (request.out / "overlay.mp4").unlink()
    notes = Notes()
    fit(read_take(take_file), request, notes)
    assert notes.told[-1] == "overlay.mp4 went since; leave out --resume for new ones"


def test_a_finished_report_beside_another_motion_is_not_trusted(take_file, tmp_path):
    request = asked(tmp_path / "out", resume=True)
    fit(read_take(take_file), request, Silence())
    before = contents(request.out)
    motion = read_motion(request.out / "motion.npz")
    write_motion(request.out / "motion.npz", replace(motion, pose=motion.pose + 0.1))
    notes = Notes()
    fit(read_take(take_file), request, notes)
    assert len(notes.frames) == FRAMES and contents(request.out) == before


def test_changed_footage_of_a_finished_fit_is_refused(take_file, tmp_path):
    fit(read_take(take_file), asked(tmp_path / "out"), Silence())
    repaint(take_file, "cam_03", 3)
    with pytest.raises(MocapError, match="begun otherwise: footage of cam_03 has changed"):
        fit(read_take(take_file), asked(tmp_path / "out", resume=True), Silence())


def test_footage_that_broke_off_the_fit_may_be_mended(take_file, tmp_path):
    fit(read_take(take_file), asked(tmp_path / "whole"), Silence())
    broken = take_file.parent / "masks" / "cam_03" / "000002.png"
    whole = broken.read_bytes()
    broken.write_bytes(whole[:40])
    with pytest.raises(MocapError, match="cam_03, frame 2"):
        fit(read_take(take_file), asked(tmp_path / "out"), Silence())
    broken.write_bytes(whole)
    notes = Notes()
    fit(read_take(take_file), asked(tmp_path / "out", resume=True), notes)
    assert notes.frames == [2, 3]
    assert contents(tmp_path / "out") == contents(tmp_path / "whole")


def test_a_moved_take_goes_on(take_file, cut_off, tmp_path):
    cut_off(2)
    moved = shutil.copytree(take_file.parent, tmp_path / "other" / "moved") / "take.toml"
    notes = Notes()
    fit(read_take(moved), asked(tmp_path / "out", resume=True), notes)
    assert notes.frames == [2, 3]


def test_without_resume_the_finished_frames_are_set_aside(take_file, cut_off, tmp_path):
    out = cut_off(2)
    notes = Notes()
    fit(read_take(take_file), asked(out), notes)
    assert notes.frames == [0, 1, 2, 3]
    assert notes.told[0] == (
        f"an unfinished fit is set aside in {out / SET_ASIDE}; --resume would have gone on with it"
    )
    shutil.rmtree(out / UNFINISHED, ignore_errors=True)
    (out / SET_ASIDE).replace(out / UNFINISHED)
    notes = Notes()
    fit(read_take(take_file), asked(out, resume=True), notes)
    assert notes.frames == [2, 3]


def repaint(take_file, camera: str, frame: int) -> None:
    path = take_file.parent / "masks" / camera / f"{frame:06d}.png"
    picture = cv2.imread(str(path), cv2.IMREAD_UNCHANGED)
    picture[0, 0] = 255
    cv2.imwrite(str(path), picture)
    assert np.count_nonzero(picture)
