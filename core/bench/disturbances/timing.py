"""Cameras out of step."""

from dataclasses import dataclass, replace

from ...silhouettes.silhouette import Silhouette
from .recording import Recording


@dataclass(frozen=True)
class OutOfStep:
    """Pictures of another moment: ``frames`` later than they are thought to be.

    At the take's ends the first and the last picture stay.

    Attributes:
        frames: of the footage; negative for earlier.
    """

    frames: int

    def __call__(self, recording: Recording, seed: int) -> Recording:
        """The recording with the other moments' silhouettes."""
        first, last = recording.frames[0], recording.frames[-1]

        def look(frame: int, view: int) -> Silhouette:
            return recording.look(min(max(frame + self.frames, first), last), view)

        return replace(recording, look=look)
