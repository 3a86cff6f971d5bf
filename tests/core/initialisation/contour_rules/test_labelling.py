"""The rules on a person cut out of paper, whose creases are known."""

import numpy as np
import pytest
from polygons import polygon
from silhouette_mocap.core.initialisation.contour_rules.halves import (
    Unlabelled,
    crotch_of,
    halves_of,
)
from silhouette_mocap.core.initialisation.contour_rules.labelling import (
    ELBOW_SHARE,
    LITERAL,
    WRIST_SHARE,
    labelled,
)
from silhouette_mocap.core.initialisation.contour_rules.outline import Outline

LEG = ((0.08, 0.0), (0.15, 0.0), (0.13, 0.46), (0.11, 0.76))
ARM = ((0.45, 0.76), (0.45, 0.82))
BENT_ARM = ((0.26, 0.76), (0.26, 0.55), (0.32, 0.55), (0.32, 0.82))
HEAD = ((0.045, 0.82), (0.038, 0.87), (0.065, 0.87), (0.065, 1.0))
ROUNDING = 0.015
"""What the spline takes off corners, in heights."""


def person(*, left=None, right=None, crotch=((0.0, 0.46),), head=HEAD) -> Outline:
    """Right and left half, both as if on the right, joined at the crotch."""
    right = right or (*LEG, *ARM)
    mirrored = [(-x, y) for x, y in reversed((*(left or right), *HEAD))]
    return Outline.of(polygon(*crotch, *right, *head, *mirrored))


@pytest.mark.parametrize("mode", ["order", LITERAL])
def test_each_joint_is_in_the_middle_of_its_cut(mode):
    found = labelled(person(), "T", mode)
    assert found.back == pytest.approx([0.0, 0.46], abs=ROUNDING)
    assert found.neck == pytest.approx([0.0, 0.87], abs=ROUNDING)
    shoulder = np.array([[0.038, 0.87], [0.11, 0.76]]).mean(axis=0)
    assert found.shoulders[1] == pytest.approx(shoulder, abs=ROUNDING)
    assert found.shoulders[0] == pytest.approx(shoulder * [-1, 1], abs=ROUNDING)
    # across the leg, at nine tenths of its length
    assert found.ankles[1] == pytest.approx([0.107, 0.05], abs=2 * ROUNDING)


def test_elbow_and_wrist_of_a_straight_arm_are_shares_of_its_length():
    found = labelled(person(), "T")
    shoulder, tip = found.shoulders[1], found.tips[1]
    for place, share in ((found.elbows[1], ELBOW_SHARE), (found.wrists[1], WRIST_SHARE)):
        along = np.linalg.norm(place - shoulder) / np.linalg.norm(tip - shoulder)
        assert along == pytest.approx(share, abs=0.03)
        assert 0.76 < place[1] < 0.82


def test_the_elbow_of_a_bent_arm_is_between_its_crease_and_its_bulge():
    found = labelled(person(right=(*LEG, *BENT_ARM)), "elbows")
    middle = np.array([[0.32, 0.82], [0.26, 0.76]]).mean(axis=0)
    assert found.elbows[1] == pytest.approx(middle, abs=ROUNDING)
    assert found.tips[1][1] == pytest.approx(0.55, abs=ROUNDING)
    assert found.wrists[1] == pytest.approx([0.29, 0.65], abs=0.03)


def test_literal_extremes_take_the_highest_creases_for_the_neck():
    # below an ear on the right
    ear = ((0.045, 0.82), (0.038, 0.87), (0.06, 0.87), (0.06, 0.9), (0.03, 0.91), (0.07, 0.93))
    outline = person(head=(*ear, (0.07, 1.0)))
    assert labelled(outline, "T").neck == pytest.approx([0.0, 0.87], abs=ROUNDING)
    literal = labelled(outline, "T", LITERAL).cuts["neck"].ends
    assert literal[:, 1] == pytest.approx([0.87, 0.91], abs=ROUNDING)


def test_a_neck_is_cut_level_where_hair_hides_one_of_its_sides():
    hair = ((0.07, 0.82), (0.07, 0.88), (0.05, 0.9), (0.07, 0.92), (0.07, 1.0))
    neck = labelled(person(head=hair), "T").cuts["neck"]
    assert neck.ends[:, 1] == pytest.approx([0.82, 0.82], abs=ROUNDING)


def test_the_ankle_is_where_the_lower_leg_is_narrowest():
    calf = (*LEG[:2], (0.105, 0.09), (0.15, 0.2), *LEG[2:], *ARM)
    found = labelled(person(right=calf, left=(*LEG, *ARM)), "T")
    assert found.ankles[1] == pytest.approx([0.085, 0.09], abs=2 * ROUNDING)


def test_a_waist_and_a_dent_below_the_arm_are_no_armpits():
    dent = ((0.24, 0.76), (0.28, 0.785), (0.32, 0.76))
    dented = (*LEG[:3], (0.08, 0.62), LEG[3], *dent, *ARM)
    cut = labelled(person(right=dented, left=(*LEG, *ARM)), "T").cuts["right shoulder"]
    assert cut.ends[1] == pytest.approx([0.11, 0.76], abs=ROUNDING)


def test_creases_of_the_ankles_are_not_the_back():
    # a notch inside the right ankle, lower than the crotch
    notched = ((0.078, 0.1), (0.1, 0.07), (0.08, 0.0), *LEG[1:], *ARM)
    outline = person(right=notched, left=(*LEG, *ARM))
    assert outline.points[outline.creases, 1].min() < 0.1
    assert outline.points[crotch_of(outline)] == pytest.approx([0.0, 0.46], abs=ROUNDING)


def test_legs_that_part_only_below_the_knees_are_legs_together():
    for height, parted in ((0.32, True), (0.27, True), (0.2, False), (0.12, False)):
        outline = person(crotch=((0.0, height),))
        if parted:
            assert outline.points[crotch_of(outline), 1] == pytest.approx(height, abs=ROUNDING)
        else:
            with pytest.raises(Unlabelled, match="legs together"):
                crotch_of(outline)
    # one foot on a chair
    raised = ((0.08, 0.36), (0.15, 0.36), *LEG[2:], *ARM)
    with pytest.raises(Unlabelled, match="legs together"):
        crotch_of(person(right=raised, left=(*LEG, *ARM)))


@pytest.mark.parametrize(
    ("arm", "kind", "words"),
    [
        ((*LEG[:3], (0.13, 0.82)), "A", "does not reach out"),
        ((*LEG, *ARM), "elbows", "no hand hangs"),
        ((*LEG[:2], (0.13, 0.55), (0.2, 0.54), (0.2, 0.82)), "A", "no armpit"),
    ],
)
def test_arms_that_do_not_show_the_pose_are_told(arm, kind, words):
    with pytest.raises(Unlabelled, match=words):
        labelled(person(right=arm), kind)


def test_halves_begin_at_the_head_and_end_at_the_crotch():
    left, right = halves_of(person())
    for half, side in ((left, -1), (right, 1)):
        assert half.points[0] == pytest.approx([0.0, 1.0], abs=ROUNDING)
        assert half.points[-1] == pytest.approx([0.0, 0.46], abs=ROUNDING)
        assert half.outward.max() == pytest.approx(0.45, abs=ROUNDING)
        assert (side * half.points[1:-1, 0] > -ROUNDING).all()
