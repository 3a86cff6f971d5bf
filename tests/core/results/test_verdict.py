"""Fits judged in plain words."""

import numpy as np
import pytest
from motion_made_up import motion_of, report_of
from silhouette_mocap.core.results.verdict import verdict


def judged(iou, lost=(), count=100, **report):
    motion = motion_of(np.full((count, 2), iou), lost=np.isin(np.arange(count), lost))
    return verdict(motion, report_of(motion, **report))


@pytest.mark.parametrize(
    ("iou", "lost", "tone"),
    [
        (0.9, (), "good"),
        (0.9, (3,), "fair"),
        (0.7, (), "fair"),
        (0.9, range(20), "bad"),
        (0.4, (), "bad"),
        (np.nan, (), "bad"),
    ],
)
def test_overlap_and_lost_frames_decide(iou, lost, tone):
    assert judged(iou, lost).tone == tone


def test_a_good_fit_in_words():
    assert judged(0.853).sentence == (
        "All 100 frames are tracked. Model and footage overlap by 85.3 % on average. "
        "No frame was lost."
    )


def test_lost_frames_are_named_in_stretches():
    assert "4 frames were lost (3 to 5 and 9): do not trust" in judged(0.9, (3, 4, 5, 9)).sentence
    many = judged(0.9, range(0, 40, 2)).sentence
    assert "(0, 2, 4, 6, 8, 10 and 14 further places)" in many


def test_an_interrupted_fit_is_told_first():
    found = judged(0.9, settings={"frames": [0, 149]})
    assert (found.word, found.tone, found.expected) == ("Unfinished", "fair", 150)
    assert found.sentence.startswith("The fit was interrupted: 100 of 150 frames are done")


@pytest.mark.parametrize("removed", [None, float("nan")])
def test_the_error_is_told_where_there_is_truth(removed):
    error = {"absolute": {"mean": 29.04}, "offset_removed": {"mean": 23.6}}
    told = judged(0.9, error_mm=error).sentence
    assert told.endswith("off by 29.0 mm on average, 23.6 mm after removing constant offsets.")
    error["offset_removed"] = {"mean": removed}
    assert judged(0.9, error_mm=error).sentence.endswith("off by 29.0 mm on average.")


def test_nobody_observed_is_told():
    assert "No camera observed anybody." in judged(np.nan).sentence
