"""The charts of a fit's report: how every frame fits, camera by camera and limb by limb."""

from collections.abc import Sequence
from itertools import chain, count

import numpy as np

from ..motion.motion import Motion
from ..pages.axis import value_axis
from ..pages.chart import Chart, Scale, Series, chart_figure
from ..pages.heat import Heat, heat_figure
from ..pages.markup import Html, joined
from .worst_frames import mean_iou

# other than the first cameras' colours, lest a limb be taken for a camera
_LIMB_STYLES = (6, 4, 5, 3, 2)
_DARKEST_PERCENT = 1.0


def motion_charts(motion: Motion, seconds: Sequence[float], flagged: Sequence[int]) -> Html:
    """All charts over the motion's frames.

    Args:
        motion: the motion.
        seconds: (T,) time each frame took.
        flagged: frames that are shown elsewhere on the page.
    """
    frames, lost = motion.frames, motion.lost
    likely = "probability of an error below 50 mm, lowest point of each limb"
    time = [Series("fit", np.array(seconds, float))]
    agreement = Chart(
        "Agreement", "IoU, 1 is perfect", frames, _iou(motion), lost, Scale(None, 1.0, 3), flagged
    )
    others = (
        Chart("Differing pixels", "XOR px", frames, _xor(motion), lost, Scale(0.0, None, 0)),
        Chart("Confidence", likely, frames, _confidence(motion), lost, Scale(0.0, 1.0)),
        Chart(
            "Limb residual", "mean contour distance, px", frames, _residual(motion), lost,
            Scale(0.0),
        ),
        Chart("Time", "s per frame", frames, time, lost, Scale(0.0)),
    )  # fmt: skip
    return joined((chart_figure(agreement), _cameras(motion), *map(chart_figure, others)))


def _cameras(motion: Motion) -> Html:
    known = motion.iou[np.isfinite(motion.iou)]
    # a few lost frames shall not take the contrast from all others
    ends = np.percentile(known, (_DARKEST_PERCENT, 100)) if len(known) else known
    return heat_figure(
        Heat(
            "Agreement by camera", "lowest IoU of each column's frames", motion.frames,
            motion.camera_names, motion.iou, value_axis(ends),
        )
    )  # fmt: skip


def _iou(motion: Motion) -> list[Series]:
    mean = Series("mean", mean_iou(motion))
    return [*_by_camera(motion, motion.iou), mean]


def _xor(motion: Motion) -> list[Series]:
    return _by_camera(motion, motion.xor_px.astype(float))


def _by_camera(motion: Motion, values: np.ndarray) -> list[Series]:
    columns = zip(motion.camera_names, values.T, strict=True)
    return [Series(name, column, style) for style, (name, column) in enumerate(columns)]


def _residual(motion: Motion) -> list[Series]:
    return _by_limb(motion, motion.limb_residual)


def _confidence(motion: Motion) -> list[Series]:
    limbs = np.array(motion.point_limbs)
    lowest = [
        motion.confidence[:, limbs == k].min(axis=1, initial=1.0)
        for k in range(len(motion.limb_names))
    ]
    return _by_limb(motion, np.column_stack(lowest))


def _by_limb(motion: Motion, values: np.ndarray) -> list[Series]:
    columns = zip(
        motion.limb_names, values.T, chain(_LIMB_STYLES, count(len(_LIMB_STYLES) + 2)), strict=False
    )
    return [Series(spoken(name), column, style) for name, column, style in columns]


def spoken(name: str) -> str:
    """``left_arm`` as people write it."""
    return name.replace("_", " ")
