"""The short-cut rule, condition by condition, on shapes whose cuts are known."""

import numpy as np
import pytest
from polygons import polygon
from silhouette_mocap.core.initialisation.contour_rules.cuts import (
    allowed,
    crosses_symmetry_axis,
    cut_between,
    runs_inside,
    shortest_cut,
)
from silhouette_mocap.core.initialisation.contour_rules.outline import Outline

# two squares, joined by a bar that is 0.1 wide, narrowed to 0.06 by a notch on its left
DUMBBELL = (
    (0, 0), (0.4, 0), (0.4, 0.35), (0.25, 0.35), (0.25, 0.65), (0.4, 0.65), (0.4, 1.0), (0, 1.0),
    (0, 0.65), (0.15, 0.65), (0.19, 0.5), (0.15, 0.35), (0, 0.35),
)  # fmt: skip
U = (
    (0, 0), (0.6, 0), (0.6, 1.0), (0.4, 1.0), (0.4, 0.2), (0.2, 0.2), (0.2, 1.0), (0, 1.0),
)  # fmt: skip


def nearest(outline: Outline, *places: tuple[float, float]) -> np.ndarray:
    return np.array([np.linalg.norm(outline.points - p, axis=1).argmin() for p in places])


def test_the_shortest_of_the_competing_cuts_wins():
    outline = Outline.of(polygon(*DUMBBELL))
    left = nearest(outline, (0.15, 0.65), (0.19, 0.5), (0.15, 0.35))
    right = nearest(outline, (0.25, 0.65), (0.25, 0.5), (0.25, 0.35))
    cut = shortest_cut(outline, left, right)
    assert cut.middle == pytest.approx([0.22, 0.5], abs=0.01)
    assert cut.length == pytest.approx(0.06, abs=0.015)


def test_a_cut_needs_a_crease_at_one_end():
    outline = Outline.of(polygon(*DUMBBELL))
    flat_left, flat_right = nearest(outline, (0.0, 0.15), (0.4, 0.15))
    bulge = int(outline.bulges[0])
    assert not allowed(outline, cut_between(outline, bulge, outline.bulges[2]))
    across = cut_between(outline, flat_left, flat_right)
    assert runs_inside(outline, across) and crosses_symmetry_axis(outline, across)
    creased = cut_between(outline, *nearest(outline, (0.15, 0.35), (0.25, 0.35)))
    assert allowed(outline, creased)


def test_a_cut_does_not_leave_the_body():
    outline = Outline.of(polygon(*U))
    crease, far = nearest(outline, (0.2, 0.2), (0.4, 0.9))
    outside = cut_between(outline, crease, far)
    assert not runs_inside(outline, outside) and not allowed(outline, outside)
    assert shortest_cut(outline, np.array([crease]), np.array([far])) is None
    inside = cut_between(outline, *nearest(outline, (0.2, 0.2), (0.0, 0.2)))
    assert allowed(outline, inside)


def test_a_cut_below_a_low_bump_crosses_no_axis_of_symmetry_and_one_below_a_finger_does():
    for top, crossed in ((0.26, False), (0.6, True)):
        bump = ((0.32, 0.2), (0.32, top), (0.28, top), (0.28, 0.2))
        low = ((0.4, 0.2), (0.3, top), (0.2, 0.2))
        corners = (*U[:4], *(low if not crossed else ((0.4, 0.2), *bump, (0.2, 0.2))), *U[6:])
        outline = Outline.of(polygon(*corners))
        ends = ((0.32, 0.2), (0.28, 0.2)) if crossed else ((0.4, 0.2), (0.2, 0.2))
        cut = cut_between(outline, *nearest(outline, *ends))
        assert runs_inside(outline, cut)
        assert crosses_symmetry_axis(outline, cut) == crossed
