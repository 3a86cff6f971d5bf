"""Where cameras stand tells the unit of their file, and whether it can be right."""

from pathlib import Path

import numpy as np
import pytest
from silhouette_mocap.core.cameras.units import Placing
from silhouette_mocap.core.errors import MocapError

# metres
ROOM = np.array([[0, -4, 1], [4, 0, 2], [0, 4, 1], [-4, 0, 2.0]])
# a depth camera's two lenses, 25 mm apart, in each corner of a room
TWINS = np.concatenate([ROOM, ROOM + np.array([0.025, 0, 0])])
RIG = np.array([[0, 0, 1], [0.06, 0, 1.0]])
STADIUM = 20 * ROOM


def placing(centres) -> Placing:
    return Placing(tuple(f"c{k}" for k in range(len(centres))), np.asarray(centres, float))


@pytest.mark.parametrize("centres", [ROOM, TWINS, RIG])
@pytest.mark.parametrize(("unit", "scale"), [("m", 1), ("mm", 1000)])
def test_rooms_and_small_rigs_are_possible_in_their_unit(centres, unit, scale):
    placing(scale * centres).check(unit, Path("cameras.toml"))


def test_a_stadium_is_possible_where_the_user_says_so():
    placing(STADIUM).check("m", Path("cameras.toml"))


@pytest.mark.parametrize("centres", [ROOM, TWINS])
def test_the_unit_is_guessed_whatever_one_stray_camera_says(centres):
    for scale, unit in ((1, "m"), (1000, "mm")):
        stray = np.concatenate([scale * centres, [[scale * 5000, 0, 0]]])
        assert placing(scale * centres).guessed_unit() == unit
        assert placing(stray).guessed_unit() == unit
        with pytest.raises(MocapError, match=r"stands 5 km from .* --without c") as caught:
            placing(stray).check(unit, Path("cameras.toml"))
        assert caught.value.camera == f"c{len(centres)}"


@pytest.mark.parametrize(
    ("centres", "unit", "told"),
    [
        (1000 * ROOM, "m", r'stand 5\.74 km apart; write units = "mm" .* that 5\.74 m'),
        (ROOM, "mm", r'stand 5\.74 mm apart; write units = "m" .* that 5\.74 m'),
        (100 * ROOM, "m", r'units = "cm"'),
        (1e-6 * ROOM, "m", "calibrate again"),
        (np.zeros((3, 3)), "m", "stand 0 mm apart; calibrate again"),
    ],
)
def test_what_cannot_be_is_told_with_the_unit_that_could(centres, unit, told):
    with pytest.raises(MocapError, match=told):
        placing(centres).check(unit, Path("cameras.toml"))


def test_one_camera_alone_says_nothing():
    placing(ROOM[:1]).check("mm", Path("cameras.toml"))
