"""Contacts on a walk that was planned footprint by footprint."""

import importlib
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from silhouette_mocap.core.motion.cleaning.contacts import Contact, contacts, slides, touching

WALK = Path(__file__).parents[4] / "sample_scenes" / "walk"
HEEL = np.array([0.0, 0.05, -0.08])


FIGURE = SimpleNamespace(ankle_height=0.08, offsets={"left_toes": np.array([0.0, -0.13, -0.06])})


@pytest.fixture(scope="module")
def walk():
    """The module that plans the sample walk; it imports its neighbours by their bare names."""
    sys.path.insert(0, str(WALK))
    try:
        yield importlib.import_module("walk_motion")
    finally:
        sys.path.remove(str(WALK))
        for name in ("walk_motion", "walk_figure"):
            sys.modules.pop(name, None)


def planned(walk, rate):
    """(T, 4, 3) heels and balls, left then right, of 4 s, and the planned stances of each foot."""
    times = np.arange(round(walk.FRAMES / walk.FPS * rate)) / rate
    places = []
    for time in times:
        row = []
        for side in ("left", "right"):
            ankle, foot, toes = walk.foot(side, time, FIGURE)
            ball = ankle + foot @ FIGURE.offsets["left_toes"] + toes @ [0, 0, -0.02]
            row += [ankle + foot @ HEEL, ball]
        places.append(row)
    plans = [walk.stances(side, FIGURE.ankle_height) for side in ("left", "right")]
    return times, np.array(places), plans


FEET = np.array([0, 0, 1, 1])


@pytest.mark.parametrize("rate", [15.0, 30.0, 120.0])
def test_a_walk_has_the_contacts_that_were_planned(walk, rate):
    times, places, plans = planned(walk, rate)
    found = contacts(touching(places, 0.0, rate), FEET, np.arange(len(times)))
    for side, plan in zip(("left", "right"), plans, strict=True):
        own = [contact for contact in found if contact.foot == side]
        stances = [s for s in plan if s.begin < times[-1] - 0.2]
        assert len(own) == len(stances)
        for contact, stance in zip(own, stances, strict=True):
            begin = 0.0 if stance is plan[0] else stance.begin
            end = min(stance.end, times[-1])
            # a frame, and the moment in which a landing foot comes to rest and a leaving one goes
            slack = 1 / rate + 0.1
            assert abs(contact.first / rate - begin) <= slack
            assert abs(contact.last / rate - end) <= slack


def test_noise_of_a_centimetre_leaves_the_contacts_what_they_are(walk):
    _, places, _ = planned(walk, 30.0)
    frames = np.arange(len(places))
    calm = contacts(touching(places, 0.0, 30.0), FEET, frames)
    time = frames[:, None, None] / 30
    swaying = places + 0.01 * np.sin(2 * np.pi * 0.7 * time + [0.0, 1.0, 2.0])
    shaken = contacts(touching(swaying, 0.0, 30.0), FEET, frames)
    assert [contact.foot for contact in shaken] == [contact.foot for contact in calm]


def test_noise_of_a_millimetre_at_240_frames_per_second_breaks_no_contact():
    """Speeds are taken over a time and not over a frame: 1 mm is 0.17 m/s from frame to frame."""
    places = np.random.default_rng(1).normal(0, 0.0007, (480, 2, 3))
    assert touching(places, 0.0, 240.0).all()


def test_the_floor_may_lie_anywhere(walk):
    _, places, _ = planned(walk, 30.0)
    found, raised = touching(places, 0.0, 30.0), places + np.array([0, 0, 1.5])
    assert np.array_equal(touching(raised, 1.5, 30.0), found)
    assert not touching(raised, 0.0, 30.0).any()


def test_two_thresholds_keep_one_contact_whole():
    height = np.full((40, 1, 3), 0.0)
    height[:, 0, 2] = 0.03
    height[18:22, 0, 2] = 0.06
    height[30:, 0, 2] = 0.2
    assert np.array_equal(np.flatnonzero(touching(height, 0.0, 1.0)[:, 0]), np.arange(30))
    height[:, 0, 2] += 0.03
    assert not touching(height, 0.0, 1.0).any()


def test_a_touch_shorter_than_a_tenth_of_a_second_is_none():
    places = np.ones((300, 1, 3))
    places[100:108, 0, 2] = 0.0
    assert not touching(places, 0.0, 100.0).any()


def test_contacts_name_feet_and_frames():
    touched = np.zeros((6, 3), bool)
    touched[1:3, 0] = touched[2:5, 1] = touched[0, 2] = True
    found = contacts(touched, np.array([0, 0, 1]), np.arange(10, 16))
    assert found == [Contact("right", 10, 10), Contact("left", 11, 14)]


def test_slides_are_distances_from_the_mean_place():
    places = np.zeros((5, 1, 3))
    places[:, 0, 0] = [9, 0.01, 0.03, 9, 0.5]
    places[:, 0, 2] = 7.0
    touched = np.array([[0], [1], [1], [0], [1]], bool)
    assert slides(places, touched) == pytest.approx([0.01, 0.0])


def test_a_single_frame_touches_nothing():
    assert not touching(np.zeros((1, 2, 3)), 0.0, 30.0).any()
