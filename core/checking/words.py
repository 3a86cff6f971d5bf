"""What is known of a take, in words: the same on a terminal and on a page."""

from collections.abc import Sequence

import numpy as np

from ..pages.wording import UNKNOWN, counted, data_size, decimal, duration
from .camera_facts import CameraFacts
from .check import TakeCheck
from .estimate import Estimate
from .footage_check import FootageFacts

Facts = list[tuple[str, str]]
CAMERA_HEADINGS = (
    "camera", "lens", "footage px", "working px", "view °", "above floor m", "distance m",
    "mm per px",
)  # fmt: skip


def take_words(check: TakeCheck) -> Facts:
    """What the take asks for, and what was found out about performer and units."""
    take, performer = check.take, check.performer
    frames = "unknown" if check.frames is None else f"{check.frames[0]} to {check.frames[1]}"
    pose = take.initial_pose
    where_shown = (
        "the first frame" if pose.frames is None else "frames {} to {}".format(*pose.frames)
    )
    asked = "not given, a frame is found" if pose.kind is None else f"{pose.kind} in {where_shown}"
    truth = take.path.parent / "truth.npz"
    where = ""
    if performer is not None:
        x, y, _ = performer.centre
        where = f", {performer.height_m:.2f} m tall, first at x {x:.2f}, y {y:.2f} m"
    return [
        ("take", f"{take.name}, {float(take.fps):.5g} frames per second, frames {frames}"),
        ("initial", f"pose {asked}"),
        ("performer", f"{take.performer.body}{where}; floor at {take.floor:g} m"),
        ("tracker", f"{take.search.tracker}, {take.search.setting}"),
        ("exports", ", ".join(take.exports) or "none"),
        ("truth", str(truth) if truth.exists() else "none beside the take"),
        ("units", check.units or "unknown"),
    ]


def camera_words(facts: CameraFacts) -> tuple[str, ...]:
    """One camera under `CAMERA_HEADINGS`."""
    return (
        facts.camera.name,
        facts.lens,
        size_words(facts.camera.size),
        size_words(facts.working_size),
        f"{facts.across_deg:.0f}",
        decimal(facts.height_m),
        decimal(facts.distance_m),
        decimal(facts.mm_per_px, 1),
    )


def opposite_words(pairs: Sequence[tuple[str, str]]) -> str:
    """Which cameras face each other."""
    return ", ".join(f"{first} and {second}" for first, second in pairs) or "none"


def footage_words(facts: FootageFacts) -> str:
    """One camera's footage in a line."""
    kind = ("mask" if facts.is_masks else "colour") + (" video" if facts.is_video else " pictures")
    rate = "" if facts.fps is None else f", {facts.fps:.5g} frames per second"
    gaps = facts.there[1] - facts.there[0] + 1 - facts.count
    parts = [
        f"frames {facts.there[0]} to {facts.there[1]}" + (f" without {gaps}" if gaps else ""),
        f"{kind} of {size_words(facts.size)} px{rate}, {'lossy' if facts.lossy else 'lossless'}",
        looked_words(facts),
        facts.place,
    ]
    return "; ".join(parts)


def looked_words(facts: FootageFacts) -> str:
    """How much of the footage was seen, and what it showed."""
    if not facts.looked_at:
        return "none could be looked at"
    some = f"{facts.looked_at} of {facts.wanted}"
    seen = f"all {facts.wanted}" if facts.looked_at == facts.wanted else some
    made = "" if facts.extracted == facts.looked_at else f", {facts.extracted} as silhouettes"
    nobody = f", {facts.empty} of them without a performer" if facts.empty else ""
    covered = f", {100 * facts.coverage:.1f} % of the picture covered" if facts.extracted else ""
    return f"{seen} looked at{made}{nobody}{covered}"


def estimate_words(estimate: Estimate) -> Facts:
    """What a fit will need."""
    frame = (
        f"{duration(estimate.first_pose_s)} for the first pose, then {estimate.frame_s:.2f} s per "
        f"frame ({estimate.reading_s:.2f} reading, {estimate.fitting_s:.2f} fitting, "
        f"{estimate.picture_s:.2f} overlay)"
    )
    files = ", ".join(f"{name} {data_size(size)}" for name, size in estimate.results_bytes.items())
    total = data_size(sum(estimate.results_bytes.values()))
    return [
        ("time", f"about {duration(estimate.total_s)} on this machine: {frame}"),
        ("memory", f"about {data_size(estimate.memory_bytes)}"),
        ("disk", f"about {data_size(estimate.meanwhile_bytes)} during the fit, {total} after"),
        ("files", files),
    ]


def readiness(check: TakeCheck) -> str:
    """One sentence: whether a fit can start."""
    if check.faults:
        return f"{counted(len(check.faults), 'fault')} to mend before a fit can start."
    if check.estimate is None or check.frames is None:
        return "All that fit needs is there."
    frames = counted(check.estimate.frames, "frame")
    cameras = counted(len(check.cameras), "camera")
    return (
        f"All that fit needs is there: {frames} of {cameras}, about "
        f"{duration(check.estimate.total_s)} on this machine."
    )


def scale_words(cameras: Sequence[CameraFacts]) -> str:
    """The range of mm per px over all cameras."""
    known = [facts.mm_per_px for facts in cameras if np.isfinite(facts.mm_per_px)]
    if not known:
        return UNKNOWN
    return f"{decimal(min(known), 1)} to {decimal(max(known), 1)}"


def size_words(size: tuple[int, int]) -> str:
    """``640 x 480``."""
    return f"{size[0]} x {size[1]}"
