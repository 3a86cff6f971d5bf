"""Poses that the user has locked: locks.npz, or a motion.npz with frames marked as locked."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from ..body.body import Body
from ..body.kinematics import clamped
from ..errors import MocapError
from ..geometry.archive import read_archive, write_archive

_SLACK = 1e-6
"""rad or m beyond a limit that rounding explains."""


def write_locks(path: Path, body: Body, locks: Mapping[int, np.ndarray]) -> None:
    """Writes the poses (D,) of ``locks``, by frame."""
    frames = sorted(locks)
    poses = np.array([locks[frame] for frame in frames]).reshape(-1, len(body.dofs))
    write_archive(path, frames=np.array(frames, np.int64), pose=poses, dof_names=body.dofs.names)


def read_locks(path: Path | None, body: Body, frames: tuple[int, int]) -> dict[int, np.ndarray]:
    """The poses (D,) locked in ``path``, by frame; none without a path.

    The file holds ``frames`` (L,), ``pose`` (L, D) and ``dof_names`` (D,) in any order. Where it
    also holds ``locked`` (L,), as a motion.npz does, only the frames marked there count. Those
    beyond the take's ``frames`` (first, last) are left out.

    Raises:
        MocapError: no such file, another kind of file, DOFs of another body, a pose that is no
            number or beyond the body's limits.
    """
    if path is None:
        return {}
    remedy = "write frames (L,), pose (L, D) and dof_names (D,) into it"
    stored = read_archive(path, "locked poses", remedy)
    names, poses, numbers, marked = _checked(path, stored, remedy)
    if set(names) != set(body.dofs.names):
        odd = sorted(set(names) ^ set(body.dofs.names))[0]
        raise MocapError(
            f'holds poses of another body: "{odd}" is not in both',
            f'lock poses of the body "{body.name}"', file=path,
        )  # fmt: skip
    chosen = marked & (numbers >= frames[0]) & (numbers <= frames[1])
    poses = poses[:, [names.index(name) for name in body.dofs.names]]
    for frame, pose in zip(numbers[chosen].tolist(), poses[chosen], strict=True):
        _check_within(path, body, frame, pose)
    return dict(zip(numbers[chosen].tolist(), clamped(body, poses[chosen]), strict=True))


def _checked(
    path: Path, stored: dict[str, np.ndarray], remedy: str
) -> tuple[list[str], np.ndarray, np.ndarray, np.ndarray]:
    """DOF names, poses (L, D), frames (L,) and which count (L,) bool, of the right shapes."""
    try:
        names = [str(name) for name in stored["dof_names"]]
        poses, numbers = stored["pose"].astype(float), stored["frames"].astype(np.int64)
        marked = stored.get("locked", np.ones(numbers.shape, bool))
    except (KeyError, ValueError, TypeError) as error:
        raise MocapError(f"holds no locked poses ({error})", remedy, file=path) from error
    sound = numbers.ndim == 1 and poses.shape == (len(numbers), len(names))
    if not sound or marked.shape != numbers.shape:
        raise MocapError("holds arrays that do not belong together", remedy, file=path)
    if marked.dtype.kind not in "bui":
        raise MocapError("marks frames as locked by no truth values", remedy, file=path)
    if (numbers != stored["frames"]).any():
        raise MocapError("holds frames that are no whole numbers", remedy, file=path)
    if len(set(numbers.tolist())) < len(numbers):
        raise MocapError("locks a frame twice", "leave one pose per frame", file=path)
    return names, poses, numbers, marked.astype(bool)


def _check_within(path: Path, body: Body, frame: int, pose: np.ndarray) -> None:
    if not np.isfinite(pose).all():
        dof = body.dofs.names[int(np.flatnonzero(~np.isfinite(pose))[0])]
        raise MocapError(f"{dof} is no number", "lock the pose anew", file=path, frame=frame)
    beyond = np.abs(clamped(body, pose[None])[0] - pose)
    if beyond.max() > _SLACK:
        dof = body.dofs.names[int(beyond.argmax())]
        raise MocapError(
            f"{dof} is {beyond.max():.2g} beyond what the body's limits allow",
            "bring the pose within the limits", file=path, frame=frame,
        )  # fmt: skip
