"""Frames and cameras left out."""

from dataclasses import dataclass, replace

from .recording import Recording


@dataclass(frozen=True)
class EveryKth:
    """Only every ``k``-th frame, as if filmed at a lower rate.

    Attributes:
        k: of so many frames one is left.
        within: first and last frame, inclusive, between which it is so; None for everywhere.
    """

    k: int
    within: tuple[int, int] | None = None

    def __post_init__(self):
        if self.k < 1:
            raise ValueError(f"expected every first frame or fewer, got every {self.k}th")

    def __call__(self, recording: Recording, seed: int) -> Recording:
        """The recording with fewer frames."""
        first, last = self.within or (recording.frames[0], recording.frames[-1])
        kept = [
            frame
            for frame in recording.frames
            if not first <= frame <= last or (frame - first) % self.k == 0
        ]
        return replace(recording, frames=tuple(kept))


@dataclass(frozen=True)
class SomeCameras:
    """Only some of the cameras.

    Attributes:
        views: their indices.
    """

    views: tuple[int, ...]

    def __call__(self, recording: Recording, seed: int) -> Recording:
        """The recording by these cameras."""
        return replace(
            recording,
            cameras=tuple(recording.cameras[view] for view in self.views),
            look=lambda frame, view: recording.look(frame, self.views[view]),
        )
