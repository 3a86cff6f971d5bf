"""What the cameras see of the performer in the initial pose, looked at before anything is fitted.

Wrong masks and wrong calibrations show at once: the rays through the silhouettes' centroids have to
meet in one place, above the floor, and every camera has to look there.
"""

from collections.abc import Mapping

import numpy as np

from ..cameras.camera import Camera
from ..errors import MocapError
from ..initialisation.plausibility import check_height
from ..initialisation.standing import body_centre, standing_height
from ..silhouettes.masks import ReadyMasks
from ..silhouettes.place import centroid_ray
from ..silhouettes.silhouette import Silhouette
from .take import Take
from .views import View, Views

Cameras = tuple[Camera, ...]
Silhouettes = tuple[Silhouette, ...]
_FURTHER_LOOKS = 32
_FILLED = 0.5
_INVERTED_BORDER = 0.9
_FARTHEST_MISS_M = 0.5
_HIGHEST_CENTRE_M = 4.0
_OUTSIDE = 0.5


def check_first_look(take: Take, views: Views, seen: Mapping[int, Silhouettes]) -> tuple[str, ...]:
    """Notes about cameras that do not see the performer yet.

    Args:
        take: the take.
        views: its cameras.
        seen: what they see, by frame, in all frames looked at for the initial pose.

    Raises:
        MocapError: masks that are inverted, fewer than two views of a frame that show anything, a
            camera that never shows anything, or a calibration that does not go with the masks.
    """
    seen = shown(take, seen)
    frame = next(iter(seen))
    for view, silhouette in zip(views.views, seen[frame], strict=True):
        _check_not_inverted(view, silhouette, frame)
    for number, silhouettes in seen.items():
        _check_seen(take, views, silhouettes, number)
    notes = [
        _late_entrance(view, views.frames)
        for index, view in enumerate(views.views)
        if not any(silhouettes[index].foreground.any() for silhouettes in seen.values())
    ]
    centre = body_centre(views.cameras, seen[frame])
    _check_rays(take, views.cameras, seen[frame], centre)
    _check_upright(take, views.cameras, seen[frame], centre)
    return tuple(notes)


def shown(take: Take, seen: Mapping[int, Silhouettes]) -> Mapping[int, Silhouettes]:
    """What is ``seen`` in frames that should show the initial pose.

    Where the take names none, they are those in which two views show anything, or else all.
    """
    if take.initial_pose.kind is not None:
        return seen
    found = {
        frame: silhouettes
        for frame, silhouettes in seen.items()
        if sum(silhouette.foreground.any() for silhouette in silhouettes) >= 2
    }
    return found or seen


def _check_not_inverted(view: View, silhouette: Silhouette, frame: int) -> None:
    if silhouette.foreground.sum() <= _FILLED * silhouette.observed.sum():
        return
    mask = view.source.mask(frame).mask
    border = np.concatenate([mask[0], mask[-1], mask[:, 0], mask[:, -1]])
    corners = mask[[0, 0, -1, -1], [0, -1, 0, -1]]
    if not corners.all() or border.mean() < _INVERTED_BORDER:
        return
    footage = view.source.footage
    place = {"file": footage.file(frame), "camera": footage.camera, "frame": frame}
    if isinstance(view.source.extractor, ReadyMasks):
        raise MocapError(
            f"is white over {mask.mean():.0%} of the picture and along its border, as if inverted",
            "make the performer white and everything else black", **place,
        )  # fmt: skip
    raise MocapError(
        f"differs from the plate over {mask.mean():.0%} of the picture",
        "make the plate from the same camera, exposure and scene", **place,
    )  # fmt: skip


def _check_seen(take: Take, views: Views, silhouettes: Silhouettes, frame: int) -> None:
    names = [
        camera.name
        for camera, silhouette in zip(views.cameras, silhouettes, strict=True)
        if silhouette.foreground.any()
    ]
    if len(names) < 2:
        who = f"only camera {names[0]} sees" if names else "no camera sees"
        raise MocapError(
            f"{who} the performer in frame {frame}, which should show the initial pose",
            "give initial_pose frames in which at least two cameras do, or better silhouettes",
            file=take.path,
        )


def _late_entrance(view: View, frames: tuple[int, int]) -> str:
    """A note about a camera without the performer in the initial pose, but later.

    Raises:
        MocapError: it does not see the performer later, either.
    """
    footage, (first, last) = view.source.footage, frames
    for frame in sorted({int(f) for f in np.linspace(first, last, _FURTHER_LOOKS)}):
        if view.source.read(frame).foreground.any():
            return f"camera {footage.camera} does not see the performer in the initial pose"
    looks = min(last - first + 1, _FURTHER_LOOKS)
    raise MocapError(
        f"shows nobody in {looks} frames from {first} to {last}",
        f"check its silhouettes, or leave it out with --without {footage.camera}",
        file=view.place, camera=footage.camera,
    )  # fmt: skip


def _check_rays(take: Take, cameras: Cameras, seen: Silhouettes, centre: np.ndarray) -> None:
    """Refuses cameras that do not look where the performer is, and rays that do not meet."""
    calibration = take.cameras.calibration
    rays = {
        camera: ray
        for camera, silhouette in zip(cameras, seen, strict=True)
        if (ray := centroid_ray(camera, silhouette)) is not None
    }
    blind = [camera.name for camera in rays if not _looks_at(camera, centre)]
    if 0 < len(blind) <= len(rays) / 2:
        raise MocapError(
            f"is calibrated to look elsewhere than at {_point(centre)}, where the others see the "
            "performer in the initial pose",
            f"calibrate it again, or leave it out with --without {blind[0]}",
            file=calibration, camera=blind[0],
        )  # fmt: skip
    miss = np.median([np.linalg.norm(np.cross(centre - c.centre, ray)) for c, ray in rays.items()])
    if miss > _FARTHEST_MISS_M:
        raise MocapError(
            f"the rays to the performer in the initial pose miss each other by {miss:.2f} m",
            "check that calibration and footage belong together and that cameras are not mixed up",
            file=calibration,
        )


def _check_upright(take: Take, cameras: Cameras, seen: Silhouettes, centre: np.ndarray) -> None:
    """Refuses a performer below the floor, or of a height that nobody has."""
    height = centre[2] - take.floor
    if not 0 < height < _HIGHEST_CENTRE_M:
        off = f"{abs(height):.2f} m {'above' if height > 0 else 'below'}"
        raise MocapError(
            f"the performer's middle would be {off} the floor in the initial pose",
            "check floor under [world], and units and up under [cameras]", file=take.path,
        )  # fmt: skip
    if take.performer.height_m is None and isinstance(take.performer.body, str):
        check_height(standing_height(cameras, seen, centre, take.floor), take.path)


def _looks_at(camera: Camera, point: np.ndarray) -> bool:
    """Whether ``point`` is in the picture or less than half its size beside it."""
    if camera.depths(point) <= 0:
        return False
    size = np.array(camera.size)
    pixel = camera.project(point)
    return bool(np.all(pixel > -_OUTSIDE * size) and np.all(pixel < (1 + _OUTSIDE) * size))


def _point(point: np.ndarray) -> str:
    return "({:.2f}, {:.2f}, {:.2f}) m".format(*point)
