"""What comes after tracking, and what a resumed fit begins with, holds no frame of a long take.

Python's memory is compared over two journals of different length: what one frame more takes, at
the moment when most is held.
"""

import tracemalloc
from dataclasses import fields
from fractions import Fraction
from types import SimpleNamespace

import numpy as np
import pytest
from silhouette_mocap.core.body import kinematics
from silhouette_mocap.core.fitting.camera_health import camera_findings
from silhouette_mocap.core.fitting.passes import Passes, directions_from
from silhouette_mocap.core.fitting.scores import frame_scores
from silhouette_mocap.core.fitting.tracker import Tally
from silhouette_mocap.core.fitting.tracking import FrameFit
from silhouette_mocap.core.motion import recording
from silhouette_mocap.core.motion.motion import Motion
from silhouette_mocap.core.results.journal import Journal, Start
from silhouette_mocap.core.results.report import fit_quality, write_report
from synthetic import evaluator, filmed, small_body, small_studio

BODY, CAMERAS = small_body("sixteen_segment"), small_studio(2)
# so many that all moments are compared that are compared at most
SHORT, LONG = 100, 200
ORIGIN = 40
# the objects of one frame take some 4,000
MOST_BYTES = 500


@pytest.fixture(scope="module")
def journals(tmp_path_factory):
    """Two whole journals of somebody who stands still."""
    silhouettes = filmed(BODY, CAMERAS, BODY.rest_pose)
    scores = frame_scores(evaluator(BODY, CAMERAS), BODY.rest_pose, silhouettes)
    stamps, picture = np.zeros((len(CAMERAS), 2), np.int64), np.zeros((8, 8, 3), np.uint8)
    factors = (1,) * len(CAMERAS)
    start = Start({}, factors, np.array([ORIGIN]), stamps[None], BODY, BODY.rest_pose, ())

    def whole(frames) -> Journal:
        journal = Journal.begun(tmp_path_factory.mktemp("journal"), start)
        for frame in range(frames):
            fit = FrameFit(frame, BODY.rest_pose, scores, Tally(), 0.0)
            journal.add(fit, stamps, picture, "native")
        return journal

    return whole(SHORT), whole(LONG)


def bytes_per_frame(journals, stage) -> float:
    """What ``stage`` of a journal holds at most, for every frame more."""
    # caches are filled first
    stage(journals[0])
    peaks = []
    for journal in journals:
        tracemalloc.start()
        result = stage(journal)
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
        del result
    return (peaks[1] - peaks[0]) / (LONG - SHORT)


def passes_over(journal) -> Passes:
    tracker = SimpleNamespace(evaluator=evaluator(BODY, CAMERAS))
    directions = directions_from(ORIGIN, range(len(journal)))
    return Passes(tracker, BODY.rest_pose, directions, journal, 15.0)


def nothing_left(frames):
    assert not frames
    return iter(())


def resumed(journal):
    assert not [fit for fits in passes_over(journal).first(nothing_left) for fit in fits]


def second_look(journal):
    assert not list(passes_over(journal).second(nothing_left))


def cameras(journal):
    silhouettes = filmed(BODY, CAMERAS, BODY.rest_pose)
    assert not camera_findings(evaluator(BODY, CAMERAS), journal, lambda frame: silhouettes)


@pytest.mark.parametrize("stage", [resumed, second_look, cameras])
def test_another_frame_takes_next_to_no_memory(journals, stage):
    assert bytes_per_frame(journals, stage) < MOST_BYTES


def test_results_take_hardly_more_memory_than_their_arrays(journals, monkeypatch, tmp_path):
    monkeypatch.setattr(kinematics, "_BLOCK", 50)

    def results(journal):
        names = [camera.name for camera in CAMERAS]
        motion = recording.recorded(journal, BODY, names, Fraction(15))
        report = write_report(tmp_path / "report.json", fit_quality(motion, journal))
        return motion, report, journal.evaluators(), journal.stamps()

    motion, *_ = results(journals[0])
    arrays = sum(np.asarray(getattr(motion, f.name)).nbytes for f in fields(Motion)) / SHORT
    assert bytes_per_frame(journals, results) < arrays + MOST_BYTES
