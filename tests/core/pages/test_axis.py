"""Where axes end and what they are labelled with."""

import numpy as np
import pytest
from silhouette_mocap.core.pages.axis import Axis, frame_axis, value_axis


@pytest.mark.parametrize("low", [0.0, -3.2, 17.0])
@pytest.mark.parametrize("span", [1e-3, 0.7, 1.0, 12.0, 99.0, 1e5])
def test_marks_are_round_few_and_on_the_axis(low, span):
    axis = Axis(low, low + span)
    marks = np.array(axis.marks)
    assert 1 <= len(marks) <= axis.pieces + 1
    assert ((marks >= low - 1e-9) & (marks <= low + span + 1e-9 * span)).all()
    digits = axis.step / 10 ** np.floor(np.log10(axis.step) + 1e-9)
    assert round(digits, 6) in (1, 2, 5)
    for mark in marks:
        label = float(axis.label(mark).replace("−", "-"))
        assert label == pytest.approx(mark, abs=1e-6 * axis.step)


def test_zero_has_no_sign():
    assert Axis(0.0, 1.0).label(Axis(0.0, 1.0).marks[0]) == "0.0"


def test_a_value_axis_ends_at_round_values_and_holds_all():
    axis = value_axis(np.array([0.813, np.nan, 0.901]), high=1.0)
    assert (axis.low, axis.high) == (0.8, 1.0)
    axis = value_axis(np.array([0.813, 0.951]))
    np.testing.assert_allclose([axis.low, axis.high], [0.8, 1.0])


@pytest.mark.parametrize("values", [[], [np.nan], [5.0], [0.0, 0.0]])
@pytest.mark.parametrize("ends", [(None, None), (0.0, None), (None, 1.0), (0.0, 1.0)])
def test_an_axis_never_is_a_point(values, ends):
    axis = value_axis(np.array(values), *ends)
    assert axis.high > axis.low


def test_one_frame_lies_in_the_middle():
    assert frame_axis(np.array([7])).shares(np.array([7.0])) == [0.5]
