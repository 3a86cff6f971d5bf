"""Hands found by their colour."""

import cv2
import numpy as np
import pytest
from silhouette_mocap.core.initialisation.contour_rules.wrists import (
    Ellipse,
    hand_ellipse,
    skin_of,
)

SKIN, CLOTH = (120, 150, 205), (140, 90, 60)
"""BGR."""


def painted(centre: tuple[int, int], axes: tuple[int, int], degrees: float) -> np.ndarray:
    """(H, W, 3) cloth with an elliptic patch of skin."""
    picture = np.full((200, 300, 3), CLOTH, np.uint8)
    return cv2.ellipse(picture, centre, axes, degrees, 0, 360, SKIN, -1)


def test_the_second_moments_give_the_ellipse_back():
    skin = skin_of(painted((150, 90), (40, 18), 30.0), np.ones((200, 300), bool))
    rows, columns = np.nonzero(skin)
    ellipse = Ellipse.of(np.stack([columns, rows], axis=1).astype(float))
    assert ellipse.centre == pytest.approx([150, 90], abs=0.5)
    assert np.linalg.norm(ellipse.axes, axis=1) == pytest.approx([18, 40], abs=1.0)
    along = ellipse.axes[1] / np.linalg.norm(ellipse.axes[1])
    assert abs(along @ [np.cos(np.pi / 6), np.sin(np.pi / 6)]) == pytest.approx(1.0, abs=1e-3)


def test_a_line_enters_an_ellipse_on_the_side_that_it_comes_from():
    ellipse = Ellipse(np.array([100.0, 50.0]), np.array([[0.0, 10.0], [30.0, 0.0]]))
    assert ellipse.entry(np.array([20.0, 50.0])) == pytest.approx([70.0, 50.0])
    assert ellipse.entry(np.array([100.0, 99.0])) == pytest.approx([100.0, 60.0])
    entry = ellipse.entry(np.array([160.0, 90.0]))
    assert ((entry - [100, 50]) / [30, 10]) @ ((entry - [100, 50]) / [30, 10]) == pytest.approx(1)


def test_a_bare_forearm_is_no_hand_and_cloth_no_skin():
    everywhere = np.ones((200, 300), bool)
    hand = skin_of(painted((150, 90), (14, 8), 0.0), everywhere)
    assert hand_ellipse(hand, np.array([164.0, 90.0]), 250.0) is not None
    # 100 px of a performer of 250
    forearm = skin_of(painted((150, 90), (50, 10), 0.0), everywhere)
    assert hand_ellipse(forearm, np.array([200.0, 90.0]), 250.0) is None
    assert hand_ellipse(hand, np.array([250.0, 90.0]), 250.0) is None
    assert not skin_of(painted((150, 90), (14, 8), 0.0), ~everywhere).any()
