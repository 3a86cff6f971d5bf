"""Finished frames of a fit that is not finished yet, kept on disk.

Frames are added one by one to a file of records of one length, each with a checksum, so that
whatever ends the program leaves all frames before the last whole. Their overlay pictures lie beside
it. Memory does not grow with the take, and a later run goes on where this one ended.
"""

import errno
import json
import os
import shutil
import zlib
from contextlib import suppress
from dataclasses import dataclass, fields
from pathlib import Path
from typing import BinaryIO

import numpy as np

from ..body.body import POINT_NAMES, Body
from ..body.file import read_body, write_body
from ..errors import MocapError
from ..files import made_folder, unwritable
from ..fitting.limbs import LIMB_NAMES
from ..fitting.scores import FrameScores
from ..fitting.tracker import Tally
from ..fitting.tracking import FrameFit
from ..footage.pictures import write_picture
from ..geometry.archive import read_archive, write_archive
from ..motion.overlay import JPEG_QUALITY
from .fingerprint import Inputs

UNFINISHED, SET_ASIDE = "unfinished", "unfinished.old"
_START, _BODY, _FRAMES, _PICTURES = "start.npz", "body.npz", "frames.bin", "pictures"
_ANEW = "leave out --resume to fit all frames anew"


@dataclass(frozen=True, eq=False)
class Start:
    """What a fit knows before its first frame.

    Attributes:
        inputs: what it depends on.
        factors: by which each of the V views is reduced.
        frames: (n,) numbers of the frames that the initial pose was sought in.
        stamps: (n, V, 2) of the files they were read from.
        body: the performer.
        pose: (D,) the initial pose.
        notes: what the user was told.
    """

    inputs: Inputs
    factors: tuple[int, ...]
    frames: np.ndarray
    stamps: np.ndarray
    body: Body
    pose: np.ndarray
    notes: tuple[str, ...]


class Journal:
    """The finished frames in ``folder``.

    Args:
        folder: where they are kept.
        start: how they began.
    """

    def __init__(self, folder: Path, start: Start):
        self.folder, self.start = folder, start
        self._kind = _record(len(start.pose), len(start.factors))
        self._file = folder / _FRAMES
        self._stream = _opened(self._file)
        self._count = self._whole()

    @classmethod
    def begun(cls, folder: Path, start: Start) -> "Journal":
        """An empty journal in a new ``folder``.

        Raises:
            MocapError: it cannot be written.
        """
        made_folder(folder)
        write_body(folder / _BODY, start.body)
        # written last: it makes the journal whole
        write_archive(
            folder / _START,
            inputs=json.dumps(start.inputs),
            factors=np.array(start.factors, np.int64),
            frames=start.frames,
            stamps=start.stamps,
            pose=start.pose,
            notes=json.dumps(start.notes),
        )
        return cls(folder, start)

    @classmethod
    def opened(cls, folder: Path) -> "Journal | None":
        """The journal in ``folder`` with its whole frames; None where there is none.

        Raises:
            MocapError: it is damaged.
        """
        if not (folder / _START).exists():
            return None
        stored = read_archive(folder / _START, "start of a fit", _ANEW)
        try:
            start = Start(
                inputs=json.loads(str(stored["inputs"])),
                factors=tuple(stored["factors"].tolist()),
                frames=stored["frames"],
                stamps=stored["stamps"],
                body=read_body(folder / _BODY),
                pose=stored["pose"],
                notes=tuple(json.loads(str(stored["notes"]))),
            )
        except (KeyError, ValueError) as error:
            raise MocapError("is no start of a fit", _ANEW, file=folder / _START) from error
        return cls(folder, start)

    def __len__(self) -> int:
        """How many frames are finished."""
        return len(self._records())

    def keep_first(self, count: int) -> None:
        """Forgets what was added after the first ``count`` times."""
        self._count = min(self._count, count)

    def add(self, fit: FrameFit, stamps: np.ndarray, picture: np.ndarray, evaluator: str) -> None:
        """One more finished frame, or one anew, which replaces the one before.

        Args:
            fit: the frame.
            stamps: (V, 2) of the files it was read from.
            picture: (H, W, 3) uint8 BGR overlay.
            evaluator: the kind that drew it, in at most 16 letters.

        Raises:
            MocapError: the disk refuses it, or the journal is not there any more.
        """
        self._check_own()
        write_picture(self.picture(fit.frame), picture, JPEG_QUALITY)
        record, stream = _packed(fit, stamps, evaluator, self._kind), self._stream
        try:
            # over what a record cut short has left
            stream.seek(self._count * self._kind.itemsize)
            if stream.write(record.tobytes()) < self._kind.itemsize:
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
            stream.truncate()
            os.fsync(stream.fileno())
        except OSError as error:
            raise unwritable(self._file, error) from error
        self._count += 1

    def fits(self) -> list[FrameFit]:
        """The finished frames in the order they were first added."""
        return [_unpacked(record) for record in self._records()]

    def evaluators(self) -> list[str]:
        """The kinds of evaluators that drew them, in that order."""
        return [name.decode("ascii") for name in self._records()["evaluator"].tolist()]

    def stamps(self) -> tuple[np.ndarray, np.ndarray]:
        """(n,) their numbers and (n, V, 2) the stamps of their files, in that order."""
        records = self._records()
        return records["frame"], records["stamps"]

    def picture(self, frame: int) -> Path:
        """The JPEG file of one frame's overlay."""
        return self.folder / _PICTURES / f"{frame:06d}.jpg"

    def read_picture(self, frame: int) -> bytes | None:
        """The contents of that file; None where it is gone."""
        try:
            return self.picture(frame).read_bytes()
        except OSError:
            return None

    def remove(self) -> None:
        """Ends the journal, as its frames have gone into the results."""
        self._stream.close()
        _remove(self.folder)

    def _records(self) -> np.ndarray:
        """The last records of all finished frames, in the order of their first ones.

        Raises:
            MocapError: they are not there any more, or not as they were written.
        """
        self._check_own()
        records = self._read()[: self._count]
        if len(records) < self._count or not all(map(_is_sound, records)):
            raise MocapError("was changed while the fit ran", _ANEW, file=self._file)
        last = {frame: index for index, frame in enumerate(records["frame"].tolist())}
        return records[list(last.values())]

    def _read(self) -> np.ndarray:
        self._stream.seek(0)
        data = self._stream.read()
        return np.frombuffer(data, self._kind, len(data) // self._kind.itemsize)

    def _check_own(self) -> None:
        """Refuses to go on where the file on disk is not the one that was opened."""
        try:
            own = os.path.samestat(os.fstat(self._stream.fileno()), self._file.stat())
        except OSError:
            own = False
        if not own:
            raise MocapError(
                "was moved or removed while the fit ran", "give each run a folder of its own",
                file=self.folder,
            )  # fmt: skip

    def _whole(self) -> int:
        """How many records at the file's start are whole, with whole pictures."""
        whole = 0
        for record in self._read():
            if not (_is_sound(record) and _is_whole_jpeg(self.picture(int(record["frame"])))):
                break
            whole += 1
        return whole


def _opened(file: Path) -> BinaryIO:
    try:
        return file.open("r+b" if file.exists() else "w+b", buffering=0)
    except OSError as error:
        raise unwritable(file, error) from error


def _is_sound(record: np.void) -> bool:
    return zlib.crc32(record.tobytes()[:-4]) == record["check"]


def _is_whole_jpeg(file: Path) -> bool:
    try:
        with file.open("rb") as stream:
            stream.seek(-2, os.SEEK_END)
            return stream.read() == b"\xff\xd9"
    except OSError:
        return False


def set_aside(out: Path) -> bool:
    """Moves a journal in ``out`` away, over a shorter one moved before; one without frames goes.

    Returns:
        Whether there was one with frames, of this version or another.
    """
    # one without a start has ended
    size = _size(out / UNFINISHED / _FRAMES) if (out / UNFINISHED / _START).exists() else 0
    if not size:
        _remove(out / UNFINISHED)
        return False
    if _size(out / SET_ASIDE / _FRAMES) > size:
        _remove(out / UNFINISHED)
        return True
    _remove(out / SET_ASIDE)
    try:
        (out / UNFINISHED).replace(out / SET_ASIDE)
    except OSError as error:
        raise unwritable(out / SET_ASIDE, error) from error
    return True


def _size(file: Path) -> int:
    return file.stat().st_size if file.exists() else 0


def _remove(folder: Path) -> None:
    """Removes what a journal holds; anything else in ``folder`` is the user's and stays."""
    with suppress(OSError):
        for name in (_START, _BODY, _FRAMES):
            (folder / name).unlink(missing_ok=True)
        shutil.rmtree(folder / _PICTURES, ignore_errors=True)
        folder.rmdir()


def _record(dofs: int, views: int) -> np.dtype:
    return np.dtype(
        [
            ("frame", "<i8"),
            ("pose", "<f8", (dofs,)),
            ("xor_px", "<i8", (views,)),
            ("iou", "<f8", (views,)),
            ("contour_px", "<f8"),
            ("limb_residual", "<f8", (len(LIMB_NAMES),)),
            ("unexplained", "<f8", (len(LIMB_NAMES),)),
            ("view_weights", "<f8", (views,)),
            ("lumps", "<f8", (len(LIMB_NAMES),)),
            ("point_spreads", "<f8", (len(POINT_NAMES),)),
            ("dof_spreads", "<f8", (dofs,)),
            ("confidence", "<f8", (len(POINT_NAMES),)),
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


_SCORES = tuple(field.name for field in fields(FrameScores))


def _packed(fit: FrameFit, stamps: np.ndarray, evaluator: str, kind: np.dtype) -> np.ndarray:
    record = np.zeros((), kind)
    for name in _SCORES:
        record[name] = getattr(fit.scores, name)
    for name in ("frame", "pose", "seconds", "locked"):
        record[name] = getattr(fit, name)
    record["evaluated"] = fit.tally.evaluated
    record["outside_windows"] = fit.tally.outside_windows
    record["stamps"], record["evaluator"] = stamps, evaluator.encode("ascii")
    record["check"] = zlib.crc32(record.tobytes()[:-4])
    return record


def _unpacked(record: np.void) -> FrameFit:
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
