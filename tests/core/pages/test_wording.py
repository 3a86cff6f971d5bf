"""Numbers as people read them."""

import math

import pytest
from silhouette_mocap.core.pages.wording import (
    counted,
    data_size,
    decimal,
    duration,
    listed,
    spans,
    whole,
)


@pytest.mark.parametrize(
    ("seconds", "words"),
    [
        (0.04, "0.0 s"),
        (9.94, "9.9 s"),
        (9.96, "10 s"),
        (59.4, "59 s"),
        (59.6, "1 min 0 s"),
        (119.7, "2 min 0 s"),
        (599.4, "9 min 59 s"),
        (599.6, "10 min"),
        (3569.0, "59 min"),
        (3599.0, "1 h 0 min"),
        (7500.0, "2 h 5 min"),
        (math.nan, "–"),
        (None, "–"),
    ],
)
def test_durations(seconds, words):
    assert duration(seconds) == words


@pytest.mark.parametrize(
    ("count", "words"),
    [
        (0, "0 bytes"),
        (999, "999 bytes"),
        (1000, "1 KB"),
        (640_499, "640 KB"),
        (1_249_000, "1.2 MB"),
        (250e6, "250 MB"),
        (5e12, "5000 GB"),
        (None, "–"),
    ],
)
def test_data_sizes(count, words):
    assert data_size(count) == words


def test_numbers():
    assert decimal(-1.234) == "−1.23" and decimal(None) == decimal(math.inf) == "–"
    assert whole(12345.6) == "12\u202f346"
    assert counted(1, "frame") == "1 frame" and counted(0, "frame") == "0 frames"


def test_lists():
    assert [listed(["a", "b", "c"][:n]) for n in range(4)] == ["", "a", "a and b", "a, b and c"]


def test_spans_put_neighbours_together():
    assert spans([3, 4, 5, 9, 11, 12]) == ["3 to 5", "9", "11 to 12"] and spans([]) == []
