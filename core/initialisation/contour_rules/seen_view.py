"""What one view of one frame shows: its outline, its joints, or why there are none."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...cameras.camera import Camera
from ...silhouettes.place import main_patch
from ...silhouettes.silhouette import Silhouette
from .halves import Unlabelled
from .labelling import Labelled, labelled
from .outline import Outline, traced_contour
from .upright import Upright, image_up

_SMALLEST_PX, _WHOLE = 50.0, 0.95


@dataclass(frozen=True, eq=False)
class SeenView:
    """One view of a frame.

    Attributes:
        camera: a pinhole camera.
        silhouette: the main patch alone.
        upright: its turned picture; None where the view shows nobody.
        outline: None where there is none.
        whole: whether the outline is that of the whole performer.
        joints: None where the view does not show what the rules need.
        reason: why not, in words; empty where it does.
    """

    camera: Camera
    silhouette: Silhouette
    upright: Upright | None
    outline: Outline | None
    whole: bool
    joints: Labelled | None
    reason: str

    @property
    def right(self) -> np.ndarray:
        """(3,) horizontal unit direction in the world that is right in the upright picture."""
        up = np.array([0.0, -1.0]) if self.upright is None else self.upright.up
        way = self.camera.rotation.T @ [-up[1], up[0], 0.0]
        way[2] = 0.0
        return way / np.linalg.norm(way)


def seen_view(
    camera: Camera, silhouette: Silhouette, centre: np.ndarray, rules: tuple[str, str]
) -> SeenView:
    """What ``camera`` shows of the performer about ``centre`` (3,), by ``rules``: kind and mode."""
    patch = main_patch(silhouette)
    alone = Silhouette(patch, silhouette.observed)
    if not patch.any():
        return SeenView(camera, alone, None, None, False, None, "shows nobody")
    upright = Upright.of(alone, image_up(camera, centre))
    contour = traced_contour(Silhouette(patch, np.ones_like(patch)), upright)
    outline = Outline.of(contour)
    if upright.height_px < _SMALLEST_PX:
        reason = f"shows the performer only {upright.height_px:.0f} px tall"
    elif np.ptp(contour[:, 1]) < _WHOLE:
        reason = "shows the performer in pieces"
    elif _cut_off(alone):
        reason = "shows only a part of the performer, who reaches out of what is observed"
    else:
        return _labelled_view(SeenView(camera, alone, upright, outline, True, None, ""), rules)
    return SeenView(camera, alone, upright, outline, False, None, reason)


def _labelled_view(view: SeenView, rules: tuple[str, str]) -> SeenView:
    assert view.outline is not None
    try:
        return replace(view, joints=labelled(view.outline, *rules))
    except Unlabelled as reason:
        return replace(view, reason=str(reason))


def _cut_off(silhouette: Silhouette) -> bool:
    """Whether the foreground touches the picture's border or what was not observed."""
    inside = silhouette.foreground
    rim = np.zeros_like(inside)
    rim[[0, -1]] = rim[:, [0, -1]] = True
    hidden = ~silhouette.observed
    for axis, step in ((0, 1), (0, -1), (1, 1), (1, -1)):
        rim |= np.roll(hidden, step, axis)
    return bool((inside & rim).any())


def reasons(views: Sequence[SeenView]) -> str:
    """Why views are not labelled, in one sentence's words."""
    told = [f"{view.camera.name}: {view.reason}" for view in views if view.joints is None]
    return "; ".join(told)
