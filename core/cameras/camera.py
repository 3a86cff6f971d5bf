"""A calibrated camera.

World space: metres, Z up. Camera space: OpenCV axes (x right, y down, z forward). Image space:
pixels, x right, y down, the centre of the first pixel at (0, 0), as OpenCV counts. A world point
is carried by ``x_camera = camera_from_world @ [x_world, 1]`` and
``pixel = dehomogenise(matrix @ distort(x_camera))``.
"""

from dataclasses import dataclass, field, replace

import cv2
import numpy as np

from ..geometry.arrays import frozen_array

LENS_COEFFICIENTS = (0, 4, 5, 8, 12, 14)


@dataclass(frozen=True, eq=False)
class Camera:
    """One calibrated view of the world.

    Attributes:
        name: unique among the cameras of a take.
        size: (width, height) of the pictures in px.
        matrix: (3, 3) intrinsic matrix K in px, [[fx, 0, cx], [0, fy, cy], [0, 0, 1]]: OpenCV's
            lens model has no skew.
        camera_from_world: (3, 4) rigid transform [R | t], world metres to camera metres.
        distortion: OpenCV coefficients k1 k2 p1 p2 [k3 …], or the four of its fisheye model;
            empty for a pinhole.
        fisheye: whether ``distortion`` belongs to OpenCV's fisheye model.

    Raises:
        ValueError: an array of a wrong shape, a non-finite number, a matrix of another form, a
            count of coefficients unknown to OpenCV, or a transform that is not rigid.
    """

    name: str
    size: tuple[int, int]
    matrix: np.ndarray
    camera_from_world: np.ndarray
    distortion: np.ndarray = field(default_factory=lambda: np.zeros(0))
    fisheye: bool = False

    def __post_init__(self):
        set_ = object.__setattr__
        set_(self, "size", (int(self.size[0]), int(self.size[1])))
        set_(self, "matrix", frozen_array(self.matrix, (3, 3), "matrix"))
        pose = frozen_array(self.camera_from_world, (3, 4), "camera_from_world")
        set_(self, "camera_from_world", pose)
        set_(self, "distortion", frozen_array(np.ravel(self.distortion), (None,), "distortion"))
        self._check()

    def _check(self) -> None:
        if min(self.size) < 1:
            raise ValueError(f"expected a size of at least 1 x 1 px, got {self.size}")
        fx, fy, (cx, cy) = self.matrix[0, 0], self.matrix[1, 1], self.matrix[:2, 2]
        form = [[fx, 0, cx], [0, fy, cy], [0, 0, 1]]
        if min(fx, fy) <= 0 or not np.allclose(self.matrix, form, atol=1e-6 * fx):
            raise ValueError(f"expected a matrix [fx 0 cx; 0 fy cy; 0 0 1], got {self.matrix}")
        counts = (4,) if self.fisheye else LENS_COEFFICIENTS
        if len(self.distortion) not in counts:
            raise ValueError(f"expected {counts} coefficients, got {len(self.distortion)}")
        rotation = self.rotation
        orthonormal = np.allclose(rotation @ rotation.T, np.eye(3), atol=1e-4)
        if not orthonormal or np.linalg.det(rotation) < 0:
            raise ValueError("expected a rotation (orthonormal, determinant +1)")

    @property
    def rotation(self) -> np.ndarray:
        """(3, 3) rotation, world to camera axes."""
        return self.camera_from_world[:, :3]

    @property
    def centre(self) -> np.ndarray:
        """(3,) position of the camera in world metres."""
        return -self.rotation.T @ self.camera_from_world[:, 3]

    @property
    def is_pinhole(self) -> bool:
        """Whether there is no lens distortion."""
        return not self.fisheye and not np.any(self.distortion)

    @property
    def projection(self) -> np.ndarray:
        """(3, 4) matrix K [R | t], world metres to homogeneous px; the lens is not in it."""
        return self.matrix @ self.camera_from_world

    def depths(self, points: np.ndarray) -> np.ndarray:
        """(…,) distances in metres along the optical axis of world points (…, 3)."""
        return points @ self.camera_from_world[2, :3] + self.camera_from_world[2, 3]

    def project(self, points: np.ndarray) -> np.ndarray:
        """(…, 2) px of world points (…, 3), through the lens; NaN for points not in front."""
        points = np.asarray(points, float)
        x = points.reshape(-1, 3) @ self.rotation.T + self.camera_from_world[:, 3]
        in_front = x[:, 2] > 1e-6
        x = np.where(in_front[:, None], x, [0.0, 0.0, 1.0])
        px = np.where(in_front[:, None], self.through_lens(x), np.nan)
        return px.reshape(*points.shape[:-1], 2)

    def through_lens(self, x: np.ndarray) -> np.ndarray:
        """(N, 2) px of points (N, 3) in camera space, all of them in front."""
        if self.is_pinhole:
            homogeneous = x @ self.matrix.T
            return homogeneous[:, :2] / homogeneous[:, 2:]
        zero = np.zeros(3)
        if self.fisheye:
            px, _ = cv2.fisheye.projectPoints(x[:, None], zero, zero, self.matrix, self.distortion)
        else:
            px, _ = cv2.projectPoints(x[:, None], zero, zero, self.matrix, self.distortion)
        return px.reshape(-1, 2)

    def scaled(self, factor: float | tuple[float, float], size: tuple[int, int]) -> "Camera":
        """The camera of pictures resized by ``factor`` (or one for x, one for y) to ``size`` px.

        Pixel centres follow c' = (c + 0.5) * factor - 0.5 (FORMATS: the half-pixel rule).
        """
        matrix = self.matrix.copy()
        factors = np.broadcast_to(factor, 2)
        matrix[[0, 1], [0, 1]] *= factors
        matrix[:2, 2] = (self.matrix[:2, 2] + 0.5) * factors - 0.5
        return replace(self, matrix=matrix, size=size)
