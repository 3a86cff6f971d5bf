"""TRC, the text format of marker positions that OpenSim and Pose2Sim read.

Files are written in mm with Y up: our (x, y, z) stands there as (y, z, x), the turn Pose2Sim uses.
Units are read from the file; a gap is an empty field.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...errors import MocapError
from ...files import unreadable, whole_file
from ..motion import Motion

_METRES = {"m": 1.0, "cm": 0.01, "mm": 0.001}
_DATA_LINE = 5


@dataclass(frozen=True, eq=False)
class Trajectories:
    """Points over time.

    Attributes:
        points: (T, P, 3) world metres, Z up; NaN where the file has none.
        names: P names.
        fps: frames per second.
        frames: (T,) int frame numbers.
    """

    points: np.ndarray
    names: tuple[str, ...]
    fps: float
    frames: np.ndarray


def write_trc(path: Path, motion: Motion) -> None:
    """Writes the 14 points of ``motion``, whole or not at all."""
    rate, points = float(motion.rate), len(motion.point_names)
    total, first = len(motion.frames), int(motion.frames[0])
    names = "\t\t\t".join(motion.point_names)
    axes = "\t".join(f"{axis}{number}" for number in range(1, points + 1) for axis in "XYZ")
    lines = [
        f"PathFileType\t4\t(X/Y/Z)\t{path.name}",
        "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames",
        f"{rate:.10g}\t{rate:.10g}\t{total}\t{points}\tmm\t{rate:.10g}\t{first}\t{total}",
        f"Frame#\tTime\t{names}\t\t",
        f"\t\t{axes}",
        "",
    ]
    turned = motion.points[..., [1, 2, 0]].reshape(total, -1) * 1000
    for frame, values in zip(motion.frames, turned, strict=True):
        cells = ("" if np.isnan(value) else f"{value:.5f}" for value in values)
        lines.append("\t".join([str(int(frame)), f"{frame / rate:.6f}", *cells]))
    with whole_file(path) as partial:
        partial.write_text("\n".join(lines) + "\n", encoding="utf-8")


def read_trc(path: Path) -> Trajectories:
    """The points in ``path``, in metres with Z up.

    Raises:
        MocapError: the file cannot be read, is no TRC file, holds no frames, or a row does not fit
            the header.
    """
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except FileNotFoundError as error:
        raise unreadable(path, error) from error
    except (OSError, UnicodeDecodeError) as error:
        raise MocapError("cannot be read as TRC", "give a .trc text file", file=path) from error
    if len(lines) < _DATA_LINE or not lines[0].startswith("PathFileType"):
        raise MocapError("is no TRC file", "its first word must be PathFileType", file=path)
    header = dict(zip(lines[1].split("\t"), lines[2].split("\t"), strict=False))
    names = tuple(name for name in lines[3].split("\t")[2:] if name.strip())
    scale, fps = _scale_and_rate(header, path)
    rows = [
        _row(line, len(names), number, path)
        for number, line in enumerate(lines[_DATA_LINE:], _DATA_LINE + 1)
        if line.strip()
    ]
    if not rows:
        raise MocapError("holds no frames", "write the file again", file=path)
    values = np.array(rows)
    points = values[:, 2:].reshape(len(rows), len(names), 3)[..., [2, 0, 1]] * scale
    return Trajectories(points, names, fps, values[:, 0].astype(int))


def _scale_and_rate(header: dict[str, str], path: Path) -> tuple[float, float]:
    unit = header.get("Units", "").strip()
    if unit not in _METRES:
        raise MocapError(f"has the unit {unit!r}", "use mm, cm or m", file=path)
    try:
        return _METRES[unit], float(header["DataRate"])
    except (KeyError, ValueError) as error:
        raise MocapError("has no DataRate", "write one under DataRate", file=path) from error


def _row(line: str, points: int, number: int, path: Path) -> list[float]:
    """Frame, time and coordinates of one line; trailing tabs may lack or abound."""
    cells = line.split("\t")
    wanted = 2 + 3 * points
    if len(cells) < wanted and cells[-1].strip():
        raise _bad_row(number, f"has {len(cells)} fields instead of {wanted}", path)
    cells = (cells + [""] * wanted)[:wanted]
    try:
        return [float(cell) if cell.strip() else np.nan for cell in cells]
    except ValueError as error:
        raise _bad_row(number, "holds something that is no number", path) from error


def _bad_row(number: int, problem: str, path: Path) -> MocapError:
    return MocapError(f"line {number} {problem}", "repair or drop the line", file=path)
