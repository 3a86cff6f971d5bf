"""The result of a fit in further formats."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from ..body.file import read_body
from ..body.rig_file import RigFile
from ..errors import MocapError
from ..motion.export_request import Exporter, ExportRequest
from ..motion.formats.trc import write_trc
from ..motion.motion import Motion, read_motion
from ..take.take import Take
from ..take.views import View, camera_names, open_views
from .shown_footage import shown_footage
from .writing import BODY, MOTION


def check_formats(formats: Sequence[str], exporter: Exporter | None) -> None:
    """Refuses formats that nobody here can write.

    Raises:
        MocapError: Blender is needed and missing.
    """
    needing = [name for name in formats if name != "trc"]
    if needing and exporter is None:
        raise MocapError(
            f"{', '.join(needing)} can be written only with Blender",
            "pip install silhouette-mocap[blender], or ask for other formats with --export",
        )


def export(
    take: Take, folder: Path, formats: Sequence[str], exporter: Exporter | None
) -> tuple[Path, ...]:
    """Writes the fit in ``folder`` in further formats, named after the take.

    Raises:
        MocapError: no fit in the folder, Blender is needed and missing, or a file cannot be
            written.
    """
    check_formats(formats, exporter)
    if not formats:
        return ()
    motion = read_motion(folder / MOTION)
    if exporter is None:
        path = folder / f"{take.name}.trc"
        write_trc(path, motion)
        return (path,)
    body = read_body(folder / BODY)
    if body.dofs.names != motion.dof_names:
        raise MocapError(
            f"{MOTION} and {BODY} are of different fits", "run fit again, with --resume",
            file=folder,
        )  # fmt: skip
    # only a .blend shows cameras and footage, which may be gone by now
    views = _tracked_views(take, motion) if "blend" in formats else ()
    request = ExportRequest(
        body=body,
        motion=motion,
        cameras=tuple(view.undistortion.camera for view in views),
        name=take.name,
        formats=tuple(formats),
        folder=folder,
        footage=shown_footage(views, int(motion.frames[-1]), float(take.fps), folder),
        rig=take.performer.body if isinstance(take.performer.body, RigFile) else None,
    )
    return exporter(request)


def _tracked_views(take: Take, motion: Motion) -> tuple[View, ...]:
    """The cameras and frames that were tracked with."""
    tracked = replace(take, frames=(int(motion.frames[0]), int(motion.frames[-1])))
    without = [name for name in camera_names(take) if name not in motion.camera_names]
    return open_views(tracked, without).views
