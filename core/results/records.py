"""A file of records of one length, each with a checksum: what a journal keeps of every frame.

Records are read one at a time when they are asked for, so that as many as a take has frames take
no memory, and each is checked whenever it is read.
"""

import errno
import os
import zlib
from dataclasses import fields
from pathlib import Path
from typing import BinaryIO

import numpy as np

from ..body.body import Body
from ..errors import MocapError
from ..files import unwritable
from ..fitting.limbs import limb_names
from ..fitting.scores import FrameScores
from ..fitting.tracker import Tally
from ..fitting.tracking import FrameFit

ANEW = "leave out --resume to fit all frames anew"
_SCORES = tuple(field.name for field in fields(FrameScores))


class Records:
    """The records in ``file``, which is made where it is missing; for one thread at a time.

    Args:
        file: where they are.
        kind: as `record_kind` makes it.

    Raises:
        MocapError: the file cannot be opened.
    """

    def __init__(self, file: Path, kind: np.dtype):
        self.kind, self._file, self._stream = kind, file, _opened(file)

    def find(self, number: int) -> np.void | None:
        """The record with this number; None where there is none, or one cut short or damaged."""
        self._stream.seek(number * self.kind.itemsize)
        data = self._stream.read(self.kind.itemsize)
        if len(data) < self.kind.itemsize:
            return None
        record = np.frombuffer(data, self.kind)[0]
        return record if zlib.crc32(data[:-4]) == record["check"] else None

    def read(self, number: int) -> np.void:
        """The record with this number, which was put there.

        Raises:
            MocapError: it is not there any more, or not as it was written.
        """
        self.check_own()
        record = self.find(number)
        if record is None:
            raise MocapError("was changed while the fit ran", ANEW, file=self._file)
        return record

    def put(self, number: int, record: np.ndarray) -> None:
        """Writes ``record`` with this number as the last one, over what may have been there.

        Raises:
            MocapError: the disk refuses it.
        """
        data, stream = record.tobytes()[:-4], self._stream
        data += zlib.crc32(data).to_bytes(4, "little")
        try:
            stream.seek(number * self.kind.itemsize)
            if stream.write(data) < len(data):
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
            stream.truncate()
            os.fsync(stream.fileno())
        except OSError as error:
            raise unwritable(self._file, error) from error

    def check_own(self) -> None:
        """Refuses to go on where the file on disk is not the one that was opened.

        Raises:
            MocapError: it is not.
        """
        try:
            own = os.path.samestat(os.fstat(self._stream.fileno()), self._file.stat())
        except OSError:
            own = False
        if not own:
            raise MocapError(
                "was moved or removed while the fit ran", "give each run a folder of its own",
                file=self._file.parent,
            )  # fmt: skip

    def close(self) -> None:
        """Lets go of the file."""
        self._stream.close()


def _opened(file: Path) -> BinaryIO:
    try:
        return file.open("r+b" if file.exists() else "w+b", buffering=0)
    except OSError as error:
        raise unwritable(file, error) from error


def record_kind(body: Body, views: int) -> np.dtype:
    """What a record holds of a frame of a body seen by so many views."""
    dofs, limbs, points = len(body.dofs), len(limb_names(body)), len(body.point_names)
    return np.dtype(
        [
            ("frame", "<i8"),
            ("pose", "<f8", (dofs,)),
            ("xor_px", "<i8", (views,)),
            ("iou", "<f8", (views,)),
            ("contour_px", "<f8"),
            ("limb_residual", "<f8", (limbs,)),
            ("unexplained", "<f8", (limbs,)),
            ("view_weights", "<f8", (views,)),
            ("lumps", "<f8", (limbs,)),
            ("point_spreads", "<f8", (points,)),
            ("dof_spreads", "<f8", (dofs,)),
            ("confidence", "<f8", (points,)),
            ("lost", "?"),
            ("locked", "?"),
            ("evaluated", "<i8"),
            ("outside_windows", "<i8"),
            ("seconds", "<f8"),
            ("stamps", "<i8", (views, 2)),
            ("evaluator", "S16"),
            ("check", "<u4"),
        ]
    )


def packed(fit: FrameFit, stamps: np.ndarray, evaluator: str, kind: np.dtype) -> np.ndarray:
    """A record () of ``kind``, but for its checksum.

    Args:
        fit: the frame.
        stamps: (V, 2) of the files it was read from.
        evaluator: the kind that drew it, in at most 16 letters.
        kind: of the record.
    """
    record = np.zeros((), kind)
    for name in _SCORES:
        record[name] = getattr(fit.scores, name)
    for name in ("frame", "pose", "seconds", "locked"):
        record[name] = getattr(fit, name)
    record["evaluated"] = fit.tally.evaluated
    record["outside_windows"] = fit.tally.outside_windows
    record["stamps"], record["evaluator"] = stamps, evaluator.encode("ascii")
    return record


def unpacked(record: np.void) -> FrameFit:
    """The frame that is in ``record``."""
    scores = {name: record[name] for name in _SCORES if name not in ("contour_px", "lost")}
    return FrameFit(
        frame=int(record["frame"]),
        pose=record["pose"],
        scores=FrameScores(
            **scores, contour_px=float(record["contour_px"]), lost=bool(record["lost"])
        ),
        tally=Tally(int(record["evaluated"]), int(record["outside_windows"])),
        seconds=float(record["seconds"]),
        locked=bool(record["locked"]),
    )
