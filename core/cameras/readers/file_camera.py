"""What every calibration reader returns: cameras as their file states them.

A reader turns one format into :class:`FileCamera` objects: OpenCV axes, world to camera, but still
in the file's own unit of length and with the file's own idea of "up". What is common to all
formats (units, up axis, order, checks) happens once, in ``cameras.calibration``.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import cv2
import numpy as np

from ...errors import MocapError
from ...toml import POINTS_NOT_COMMAS
from ..camera import LENS_COEFFICIENTS

_LARGEST = 1e12
_FOCAL_RATIOS = (0.2, 5.0)
_REMEDY = f"correct or re-export the file; {POINTS_NOT_COMMAS}"


@dataclass(frozen=True, eq=False)
class FileCamera:
    """One camera in the units of its file.

    Attributes:
        name: as the file calls it.
        size: (width, height) in px; None where the format does not tell.
        matrix: (3, 3) intrinsic matrix in px, the centre of the first pixel at (0, 0).
        rotation: (3, 3), world to camera axes.
        translation: (3,) in the file's unit.
        distortion: OpenCV coefficients, or the four of its fisheye model.
        fisheye: whether ``distortion`` belongs to the fisheye model.
    """

    name: str
    size: tuple[int, int] | None
    matrix: np.ndarray
    rotation: np.ndarray
    translation: np.ndarray
    distortion: np.ndarray = field(default_factory=lambda: np.zeros(0))
    fisheye: bool = False


@dataclass(frozen=True)
class FileContent:
    """What a reader found: cameras in any order, and sentences the user should see."""

    cameras: tuple[FileCamera, ...]
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Reader:
    """One calibration format.

    Attributes:
        key: the word for ``format =`` in a take.
        title: how messages call the format.
        metres_per_unit: fixed by the format, or None where it has to be guessed.
        recognises: tells from a file's first bytes whether it is of this format.
        read: reads a file; raises MocapError with file, key and remedy.
    """

    key: str
    title: str
    metres_per_unit: float | None
    recognises: Callable[[bytes], bool]
    read: Callable[[Path], FileContent]


@dataclass(frozen=True)
class Place:
    """Where in a file a value stands, for error messages."""

    file: Path
    camera: str
    key: str

    def fault(self, problem: str, remedy: str) -> MocapError:
        """The error that says what is wrong with this value."""
        return MocapError(f"{self.key} {problem}", remedy, file=self.file, camera=self.camera)


def numbers(value, place: Place) -> np.ndarray:
    """The finite numbers of ``value`` as a float array of any shape.

    Raises:
        MocapError: not numbers, a ragged list, or a number that is not finite or enormous.
    """
    try:
        array = np.array(value, dtype=float)
    except (TypeError, ValueError):
        raise place.fault(f"should hold numbers, got {_shortened(value)}", _REMEDY) from None
    if not np.isfinite(array).all():
        raise place.fault(
            "holds a number that is not finite", "calibrate this camera again or leave it out"
        )
    if (np.abs(array) > _LARGEST).any():
        raise place.fault(
            "holds a number far too large for a camera",
            "calibrate this camera again or leave it out",
        )
    return array


def numbers_of_shape(value, shape: tuple[int, ...], place: Place) -> np.ndarray:
    """The finite numbers of ``value``, reshaped to ``shape``.

    Raises:
        MocapError: as :func:`numbers`, or another count of numbers.
    """
    array = numbers(value, place)
    if array.size != np.prod(shape):
        wanted = " x ".join(str(n) for n in shape)
        raise place.fault(f"should hold {wanted} numbers, got {array.size}", _REMEDY)
    return array.reshape(shape)


def intrinsic_matrix(value, place: Place) -> np.ndarray:
    """A (3, 3) matrix [[fx, 0, cx], [0, fy, cy], [0, 0, 1]] in px.

    Raises:
        MocapError: other than 9 finite numbers, a focal length that is not positive, two
            that differ beyond reason, skew, or another last row.
    """
    matrix = numbers_of_shape(value, (3, 3), place)
    if not np.allclose(matrix[2], [0, 0, 1]):
        raise place.fault("should end with the row 0 0 1", "check the order of its rows")
    if matrix[0, 0] <= 0 or matrix[1, 1] <= 0:
        raise place.fault("has a focal length that is not positive", "calibrate this camera again")
    if not _FOCAL_RATIOS[0] <= matrix[1, 1] / matrix[0, 0] <= _FOCAL_RATIOS[1]:
        raise place.fault(
            f"has focal lengths of {matrix[0, 0]:g} and {matrix[1, 1]:g} px, which no px has "
            "the shape for",
            "calibrate this camera again",
        )
    if abs(matrix[0, 1]) > 1e-6 * matrix[0, 0] or abs(matrix[1, 0]) > 1e-6 * matrix[0, 0]:
        raise place.fault(
            f"has a skew of {matrix[0, 1]:g}, which OpenCV's lens model lacks",
            "calibrate this camera without skew",
        )
    return matrix


def distortion_coefficients(value, fisheye: bool, place: Place) -> np.ndarray:
    """OpenCV's coefficients (k1 k2 [p1 p2 [k3 …]]), or the four of its fisheye model.

    Raises:
        MocapError: a count that the lens model does not have, or numbers that are not finite.
    """
    coefficients = numbers(value, place).ravel()
    if fisheye and coefficients.size > 4 and not np.any(coefficients[4:]):
        coefficients = coefficients[:4]
    if coefficients.size == 2 and not fisheye:
        coefficients = np.pad(coefficients, (0, 2))
    counts = (4,) if fisheye else LENS_COEFFICIENTS
    if coefficients.size not in counts:
        wanted = " or ".join(str(n) for n in counts)
        model = "fisheye lens" if fisheye else "lens"
        raise place.fault(
            f"should hold {wanted} numbers for a {model}, got {coefficients.size}", _REMEDY
        )
    return coefficients


def rotation_matrix(value, place: Place) -> np.ndarray:
    """A (3, 3) rotation from a Rodrigues vector or a matrix printed with few digits.

    Raises:
        MocapError: neither 3 nor 9 finite numbers, not orthonormal within 1e-3, or mirrored.
    """
    array = numbers(value, place)
    if array.size == 3:
        return cv2.Rodrigues(array.reshape(3, 1))[0]
    if array.size != 9:
        raise place.fault(f"should hold 3 (Rodrigues) or 3 x 3 numbers, got {array.size}", _REMEDY)
    matrix = array.reshape(3, 3)
    if not np.allclose(matrix @ matrix.T, np.eye(3), atol=1e-3):
        raise place.fault("is not a rotation (its rows are not orthonormal)", "re-export the file")
    if np.linalg.det(matrix) < 0:
        raise place.fault(
            "is mirrored (determinant -1)", "export with a right-handed world and OpenCV axes"
        )
    u, _, v = np.linalg.svd(matrix)
    return u @ v


def picture_size(value, place: Place) -> tuple[int, int]:
    """(width, height) in px.

    Raises:
        MocapError: not two whole positive numbers.
    """
    array = numbers_of_shape(value, (2,), place)
    if (array < 1).any() or (array != np.round(array)).any():
        raise place.fault(
            f"should be two whole numbers of pixels, got {_shortened(value)}",
            "write it as width, height",
        )
    return int(array[0]), int(array[1])


def _shortened(value) -> str:
    text = repr(value)
    return text if len(text) <= 40 else text[:37] + "..."
