"""Finished frames of a fit that is not finished yet, kept on disk.

Frames are added one by one to a file of records of one length, each with a checksum, so that
whatever ends the program leaves all frames before the last whole. Their overlay pictures lie beside
it. They are read again one by one, too: memory does not grow with the take. A later run goes on
where this one ended.
"""

import json
import os
import shutil
from collections import Counter
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..body.body import Body
from ..body.file import read_body, write_body
from ..errors import MocapError
from ..files import made_folder, unwritable
from ..fitting.tracking import FrameFit
from ..footage.pictures import write_picture
from ..geometry.archive import read_archive, write_archive
from ..motion.overlay import JPEG_QUALITY
from .fingerprint import Inputs
from .records import ANEW, Records, packed, record_kind, unpacked

UNFINISHED, SET_ASIDE = "unfinished", "unfinished.old"
_START, _BODY, _FRAMES, _PICTURES = "start.npz", "body.npz", "frames.bin", "pictures"


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


class Journal(Mapping[int, FrameFit]):
    """The finished frames in ``folder``, by number.

    Args:
        folder: where they are kept.
        start: how they began.
    """

    def __init__(self, folder: Path, start: Start):
        self.folder, self.start = folder, start
        kind = record_kind(start.body, len(start.factors))
        self._records = Records(folder / _FRAMES, kind)
        self._count, self._places = 0, dict[int, int]()
        while (record := self._records.find(self._count)) is not None:
            frame = int(record["frame"])
            if not _is_whole_jpeg(self.picture(frame)):
                break
            self._note(frame)

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
        stored = read_archive(folder / _START, "start of a fit", ANEW)
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
            raise MocapError("is no start of a fit", ANEW, file=folder / _START) from error
        return cls(folder, start)

    def __len__(self) -> int:
        """How many frames are finished."""
        return len(self._places)

    def __iter__(self) -> Iterator[int]:
        """Their numbers in the order they were first added."""
        return iter(self._places)

    def __contains__(self, frame: object) -> bool:
        """Whether this frame is finished."""
        return frame in self._places

    def __getitem__(self, frame: int) -> FrameFit:
        """The fit of ``frame`` that was added last.

        Raises:
            KeyError: it is not finished.
            MocapError: it is not there any more, or not as it was written.
        """
        return unpacked(self._records.read(self._places[frame]))

    def keep_first(self, count: int) -> None:
        """Forgets what was added after the first ``count`` times.

        Raises:
            MocapError: that is not there any more, or not as it was written.
        """
        if count < self._count:
            self._places = {int(self._records.read(n)["frame"]): n for n in range(count)}
            self._count = count

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
        self._records.check_own()
        write_picture(self.picture(fit.frame), picture, JPEG_QUALITY)
        record = packed(fit, stamps, evaluator, self._records.kind)
        # over what a record cut short has left
        self._records.put(self._count, record)
        self._note(fit.frame)

    def evaluators(self) -> Counter[str]:
        """How many of the frames each kind of evaluator drew."""
        return Counter(record["evaluator"].decode("ascii") for record in self._last())

    def stamps(self) -> tuple[np.ndarray, np.ndarray]:
        """(n,) numbers of the frames and (n, V, 2) the stamps of their files, in their order."""
        kind, stamps = self._records.kind["stamps"], (record["stamps"] for record in self._last())
        return np.array(list(self), np.int64), np.fromiter(stamps, kind, len(self))

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
        self._records.close()
        _remove(self.folder)

    def _last(self) -> Iterator[np.void]:
        """The last record of every frame."""
        return map(self._records.read, self._places.values())

    def _note(self, frame: int) -> None:
        """The next record is of this frame."""
        self._places[frame] = self._count
        self._count += 1


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
