"""A take as described by its take.toml."""

from .reading import read_take
from .take import Adjustment, Calibrated, FootageFiles, InitialPose, Performer, Take

__all__ = [
    "Adjustment",
    "Calibrated",
    "FootageFiles",
    "InitialPose",
    "Performer",
    "Take",
    "read_take",
]
