"""The cameras' plan and elevation, measured back from the drawing."""

from xml.etree import ElementTree

import numpy as np
import pytest
from silhouette_mocap.core.cameras.presets import Ring, ring
from silhouette_mocap.core.checking.camera_facts import CameraFacts, Performer
from silhouette_mocap.core.checking.studio_plan import (
    Studio,
    plan_from_above,
    pyramid,
    view_from_the_side,
)

CAMERAS = ring(Ring(4, radius=3.0, heights=(1.0, 2.5)))
PERFORMER = Performer(np.array([0.5, -0.25, 0.9]), 1.75)


def studio(names=None, performer=PERFORMER, opposite=(), cameras=CAMERAS):
    facts = [CameraFacts(c, c.size, 1, float(c.centre[2]), 3.0, 5.0) for c in cameras]
    return Studio(facts, opposite, performer, floor=0.0)


def measured(drawing):
    """Px per metre, and the markers of cameras as (V, 2) px."""
    root = ElementTree.fromstring(drawing)
    (line,) = (line for line in root.iter("line") if line.get("class") == "measure")
    scale = float(line.get("x2")) - float(line.get("x1"))
    dots = [c for c in root.iter("circle") if c.get("class").startswith("camera")]
    return root, scale, np.array([(float(d.get("cx")), float(d.get("cy"))) for d in dots])


def test_the_plan_is_to_scale():
    root, scale, dots = measured(plan_from_above(studio()))
    centres = np.array([c.centre for c in CAMERAS])
    wanted = (centres - centres[0])[:, :2] * [scale, -scale]
    np.testing.assert_allclose(dots - dots[0], wanted, atol=0.2)
    (man,) = (c for c in root.iter("circle") if c.get("class") == "performer")
    at = np.array([float(man.get("cx")), float(man.get("cy"))])
    offset = (PERFORMER.centre - centres[0])[:2] * [scale, -scale]
    np.testing.assert_allclose(at - dots[0], offset, atol=0.2)


def test_the_side_view_shows_heights_above_the_floor():
    root, scale, dots = measured(view_from_the_side(studio()))
    (floor,) = (line for line in root.iter("line") if line.get("class") == "floor")
    heights = (float(floor.get("y1")) - dots[:, 1]) / scale
    np.testing.assert_allclose(heights, [c.centre[2] for c in CAMERAS], atol=0.01)
    (man,) = (r for r in root.iter("rect") if r.get("class") == "performer")
    assert float(man.get("height")) / scale == pytest.approx(1.75, abs=0.01)


def test_the_pyramid_is_what_the_camera_sees():
    camera = CAMERAS[1]
    corners = pyramid(camera, 2.0)
    width, height = camera.size
    np.testing.assert_allclose(corners[0], camera.centre)
    np.testing.assert_allclose(camera.depths(corners[1:]), 2.0)
    wanted = [[x, y] for x in (-0.5, width - 0.5) for y in (-0.5, height - 0.5)]
    np.testing.assert_allclose(camera.project(corners[1:]), wanted, atol=1e-6)


def test_pairs_that_face_each_other_are_joined():
    pair = (CAMERAS[0].name, CAMERAS[2].name)
    root, _, dots = measured(plan_from_above(studio(opposite=(pair,))))
    (line,) = (line for line in root.iter("line") if line.get("class") == "facing")
    ends = [[float(line.get(f"{axis}{k}")) for axis in "xy"] for k in (1, 2)]
    np.testing.assert_allclose(ends, dots[[0, 2]], atol=0.1)


@pytest.mark.parametrize("draw", [plan_from_above, view_from_the_side])
def test_names_are_on_the_sheet_and_not_on_each_other(draw):
    root, _, _ = measured(draw(studio(cameras=ring(Ring(16, radius=3.0)))))
    wide = float(root.get("viewBox").split()[2])
    rows = {}
    for text in root.iter("text"):
        if text.get("class") is None:
            rows.setdefault(text.text, (float(text.get("x")), float(text.get("y"))))
    assert len(rows) == 16
    places = sorted(rows.values())
    assert all(0 <= x <= wide - 40 and y > 0 for x, y in places)
    clashes = [
        (a, b)
        for k, a in enumerate(places)
        for b in places[k + 1 :]
        if abs(a[1] - b[1]) < 13 and abs(a[0] - b[0]) < 40
    ]
    assert not clashes


def test_without_a_performer_cameras_and_floor_are_drawn():
    for draw in (plan_from_above, view_from_the_side):
        text = draw(studio(performer=None))
        assert 'class="performer"' not in text and text.count('class="cone') == 4


def test_cameras_in_one_place_can_be_drawn():
    for draw in (plan_from_above, view_from_the_side):
        assert "nan" not in draw(studio(performer=None, cameras=(CAMERAS[0], CAMERAS[0])))
