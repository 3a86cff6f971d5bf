"""What is written of a performer: the body, the measures, and pictures to check them by."""

from dataclasses import asdict, dataclass
from pathlib import Path

import cv2
import numpy as np

from ..beginning import Beginning
from ..body.body import Body
from ..body.file import write_body
from ..body.kinematics import rest_height
from ..files import whole_file
from ..fitting.contour import ContourTracker
from ..fitting.tracker import Past
from ..geometry.boxes import box_round
from ..initialisation.contour_rules.drawing import drawn_steps
from ..initialisation.contour_rules.from_frames import ContourSettings
from ..initialisation.contour_rules.skeleton import ContourSkeleton
from ..initialisation.measures import Length, lengths_of
from ..initialisation.shape_fit import ShapeFit
from ..motion.overlay import Tile, overlay_picture
from ..rendering.choice import native
from ..results.report import write_report
from ..results.writing import BODY
from ..silhouettes.silhouette import Silhouette
from ..take.take import Take

_MARGIN = 0.03
"""Of a picture's height, round the performer in close-ups."""
MEASURES, SHAPE = "measures.json", "shape.png"


@dataclass(frozen=True, eq=False)
class Performer:
    """The performer of a take.

    Attributes:
        body: in their own shape.
        shape: how it was found.
        skeleton: that the contours of the initial pose show; None where they do not.
        straight: limbs' hinges that no frame bends: their place is the average person's.
        notes: what the user was told.
    """

    body: Body
    shape: ShapeFit
    skeleton: ContourSkeleton | None
    straight: tuple[str, ...]
    notes: tuple[str, ...]

    @property
    def lengths(self) -> tuple[Length, ...]:
        """Of the body's bones."""
        return lengths_of(self.shape)


def write_performer(
    take: Take, begin: Beginning, performer: Performer, settings: ContourSettings, out: Path
) -> tuple[Path, ...]:
    """Writes body.npz, measures.json, shape.png and a picture of the contour for each camera.

    Returns:
        The files.

    Raises:
        MocapError: they cannot be written.
    """
    pictures = {SHAPE: _shape_picture(begin, performer)}
    if take.initial_pose.kind is not None:
        pictures |= _contour_pictures(begin, performer, take.initial_pose.kind, settings)
    write_body(out / BODY, performer.body)
    write_report(out / MEASURES, _figures(performer, begin))
    for name, picture in pictures.items():
        with whole_file(out / name) as partial:
            partial.write_bytes(cv2.imencode(".png", picture)[1].tobytes())
    return (out / BODY, out / MEASURES, *(out / name for name in pictures))


def _figures(performer: Performer, begin: Beginning) -> dict:
    """For JSON; metres."""
    cameras = [camera.name for camera in begin.views.cameras]
    return {
        "frame": begin.frames[0],
        "height": rest_height(performer.body),
        "iou": dict(zip(cameras, begin.first.iou.tolist(), strict=True)),
        "lengths": [asdict(length) for length in performer.lengths],
        "straight_joints": performer.straight,
        "contour": None if performer.skeleton is None else _contour(performer.skeleton),
        "notes": performer.notes,
    }


def _contour(skeleton: ContourSkeleton) -> dict:
    gaps = np.nanmean(skeleton.gaps_mm, axis=0).tolist()
    return {
        "measures": {name: asdict(measure) for name, measure in skeleton.measures.items()},
        "gaps_mm": dict(zip(skeleton.joint_names, gaps, strict=True)),
        "elbow_observed": skeleton.elbow_observed,
        "wrist_source": skeleton.wrist_source,
    }


def _shape_picture(begin: Beginning, performer: Performer) -> np.ndarray:
    """The template scaled as a whole over the silhouettes, and below it the performer's shape."""
    cameras, frame = begin.views.cameras, begin.frames[0]
    silhouettes, footage = begin.views.silhouettes(frame), begin.views.pictures(frame)
    labels = [camera.name for camera in cameras]
    boxes = [_close_up(silhouette.foreground) for silhouette in silhouettes]
    rows = []
    bodies = ("scaled as a whole", performer.shape.template), ("own shape", performer.body)
    for title, body in bodies:
        tracker = ContourTracker(body, cameras, native)
        pose = tracker.fit(silhouettes, Past.still(begin.first.pose)).pose
        rendered = tracker.evaluator.silhouettes(pose)
        tiles = [
            Tile(label, picture[box], _within(silhouette, box), model[box])
            for label, picture, silhouette, model, box in zip(
                labels, footage, silhouettes, rendered, boxes, strict=True
            )
        ]
        rows.append(overlay_picture(tiles, f"frame {frame}, {title}"))
    return np.vstack(rows)


def _close_up(foreground: np.ndarray) -> tuple[slice, slice]:
    """Rows and columns round the performer, as wide as they are high where the picture allows."""
    rows, columns = box_round(foreground, margin_px=round(_MARGIN * len(foreground)))
    missing = (rows.stop - rows.start) - (columns.stop - columns.start)
    begin = max(0, columns.start - max(0, missing) // 2)
    end = min(foreground.shape[1], columns.stop + max(0, missing) // 2)
    return rows, slice(begin, end)


def _within(silhouette: Silhouette, box: tuple[slice, slice]) -> Silhouette:
    return Silhouette(silhouette.foreground[box], silhouette.observed[box])


def _contour_pictures(
    begin: Beginning, performer: Performer, kind: str, settings: ContourSettings
) -> dict[str, np.ndarray]:
    """Name of the file -> how the rules read the first frame in that camera."""
    frame, cameras, joints = begin.frames[0], begin.views.cameras, None
    if performer.skeleton is not None:
        joints = performer.skeleton.joints[list(begin.seen).index(frame)]
    steps = drawn_steps(cameras, begin.seen[frame], kind, joints, settings)
    names = [f"contour_{camera.name}.png" for camera in cameras]
    return dict(zip(names, steps, strict=True))
