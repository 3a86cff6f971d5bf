"""Cameras of the sample, and its silhouettes by sphere tracing the performer's flesh.

Every pixel of the performer's bounding box sends one ray; only where the outline may pass do nine
samples per pixel decide: a pixel is white where at least five of them are covered. The distance
field is plain float32 arithmetic without library sums, so that a mask is the same on every
platform.
"""

from copy import copy
from dataclasses import dataclass

import cv2
import numpy as np
from walk_figure import BLENDS, Performer, sided
from walk_motion import posed

WIDTH, HEIGHT = 320, 240
CAMERAS = 8
# a step of 3 mm along the ray overlooks less than 0.03 mm of a limb 3 cm thick
SURFACE, LEAST_STEP = np.float32(5e-4), np.float32(3e-3)
CLEARANCE_PX = 0.75
STEPS = 96
TILE = 64
MARGIN = 0.1
SAMPLES = [(i / 3.0, j / 3.0) for j in (-1, 0, 1) for i in (-1, 0, 1)]


@dataclass(frozen=True, eq=False)
class Camera:
    """A pinhole camera; integer pixel coordinates are pixel centres.

    Attributes:
        name: such as ``cam_01``.
        matrix: (3, 3) intrinsics, px.
        rotation: (3, 3) world to camera axes (x right, y down, z forward).
        translation: (3,) m.
    """

    name: str
    matrix: np.ndarray
    rotation: np.ndarray
    translation: np.ndarray

    @property
    def centre(self) -> np.ndarray:
        """(3,) position in the world, m."""
        return -self.rotation.T @ self.translation

    def projected(self, points: np.ndarray) -> np.ndarray:
        """(..., 2) pixels of world points (..., 3)."""
        seen = (points @ self.rotation.T + self.translation) @ self.matrix.T
        return seen[..., :2] / seen[..., 2:]

    def rays(self, pixels: np.ndarray) -> np.ndarray:
        """(..., 3) unit directions in the world through pixels (..., 2)."""
        ahead = np.concatenate([pixels, np.ones_like(pixels[..., :1])], -1)
        rays = ahead @ np.linalg.inv(self.matrix).T @ self.rotation
        return rays / np.linalg.norm(rays, axis=-1, keepdims=True)


def make_cameras() -> list[Camera]:
    """Eight cameras on a ring of about 4 m, 45 degrees apart, opposite ones 12 degrees off."""
    rng = np.random.default_rng(5)
    cameras = []
    for index in range(CAMERAS):
        aside = (6.0 if index < 4 else -6.0) + rng.uniform(-1.0, 1.0)
        azimuth = np.deg2rad(-82.0 + 45.0 * index + aside)
        radius, height = rng.uniform(3.9, 4.1), (1.05, 1.55)[index % 2] + rng.uniform(-0.1, 0.1)
        centre = np.array([radius * np.cos(azimuth), radius * np.sin(azimuth), height])
        forward = np.array([0.0, 0.0, 0.88]) - centre
        forward /= np.linalg.norm(forward)
        right = np.cross(forward, [0.0, 0.0, 1.0])
        right /= np.linalg.norm(right)
        rotation = np.stack([right, np.cross(forward, right), forward])
        rotation = cv2.Rodrigues(np.round(cv2.Rodrigues(rotation)[0], 9))[0]
        focal, shift = rng.uniform(284.0, 296.0), rng.uniform(-3.0, 3.0, 2)
        matrix = np.array([[focal, 0, 159.5 + shift[0]], [0, focal, 119.5 + shift[1]], [0, 0, 1]])
        translation = np.round(-rotation @ centre, 9)
        cameras.append(Camera(f"cam_{index + 1:02d}", np.round(matrix, 6), rotation, translation))
    return cameras


def calibration_text(cameras: list[Camera]) -> str:
    """The cameras as a calibration file in the layout of anipose and Pose2Sim, metres."""
    blocks = []
    for camera in cameras:
        rows = ", ".join(str(row) for row in camera.matrix.tolist())
        vector = np.round(cv2.Rodrigues(camera.rotation)[0].ravel(), 9).tolist()
        blocks.append(
            f'[{camera.name}]\nname = "{camera.name}"\nsize = [{WIDTH}, {HEIGHT}]\n'
            f"matrix = [{rows}]\n"
            f"distortions = [0.0, 0.0, 0.0, 0.0]\nrotation = {vector}\n"
            f"translation = {camera.translation.tolist()}\nfisheye = false\n"
        )
    return "\n".join([*blocks, "[metadata]\nadjusted = false\nerror = 0.0\n"])


class Flesh:
    """The performer's signed distance field in one pose: a union of K melted round cones."""

    def __init__(self, performer: Performer, frame: int):
        rotations, joints = posed(performer, frame)
        table = performer.flesh
        turned = np.stack([rotations[bone] for bone in table["bone"]])
        base = np.stack([joints[bone] for bone in table["bone"]])
        self.ends = np.round(base[:, None] + np.einsum("kij,kej->kei", turned, table["ends"]), 6)
        axis = self.ends[:, 1] - self.ends[:, 0]
        length = np.linalg.norm(axis, axis=1)
        slope = (table["radii"][:, 0] - table["radii"][:, 1]) / length
        numbers = {
            "start": self.ends[:, 0],
            "axis": axis / length[:, None],
            "normal": np.einsum("kij,kj->ki", turned, table["normal"]),
            "middle": self.ends.mean(1),
            "reach": length / 2.0 + table["radii"].max(1),
            "stretch": 1.0 / table["squeeze"] - 1.0,
            "squeeze": table["squeeze"],
            "length": length,
            "slope": slope,
            "lean": slope / np.sqrt(1.0 - slope**2),
            "radius": table["radii"][:, 0],
        }
        self.numbers = {
            key: np.round(value, 6).astype(np.float32).T[..., None]
            for key, value in numbers.items()
        }
        self.groups, self.materials = table["group"], table["material"]
        self.joints = {bone: joint.astype(np.float32) for bone, joint in joints.items()}

    def kept(self, members: np.ndarray) -> "Flesh":
        """The field of some of the round cones only, (K,) bool."""
        few = copy(self)
        few.numbers = {key: value[..., members, :] for key, value in self.numbers.items()}
        few.groups, few.materials = self.groups[members], self.materials[members]
        few.ends = self.ends[members]
        return few

    def pieces(self, points: np.ndarray) -> np.ndarray:
        """(K, N) lower bounds of the distances of points (3, N) to the round cones, m.

        A point's nearest ball of a cone has its centre ``along - off * tan(lean)`` on the axis. The
        space of a flattened cone is stretched along its normal; its distance then shrinks by the
        same factor, and that of the ball around the cone takes over where it is the better bound.
        """
        it = self.numbers
        x, y, z = (points[i] - it["start"][i] for i in range(3))
        flat = np.flatnonzero(it["squeeze"][:, 0] < 1.0)
        if len(flat):
            n = it["normal"][:, flat]
            across = (x[flat] * n[0] + y[flat] * n[1] + z[flat] * n[2]) * it["stretch"][flat]
            x[flat] += across * n[0]
            y[flat] += across * n[1]
            z[flat] += across * n[2]
        along = x * it["axis"][0] + y * it["axis"][1] + z * it["axis"][2]
        off = np.maximum(x * x + y * y + z * z - along * along, np.float32(0.0))
        centre = along - np.sqrt(off) * it["lean"]
        centre = np.minimum(np.maximum(centre, np.float32(0.0)), it["length"])
        along -= centre
        gaps = np.sqrt(off + along * along) - it["radius"] + it["slope"] * centre
        if len(flat):
            x, y, z = (points[i] - it["middle"][i, flat] for i in range(3))
            around = np.sqrt(x * x + y * y + z * z) - it["reach"][flat]
            gaps[flat] = np.maximum(gaps[flat] * it["squeeze"][flat], around)
        return gaps

    def distance(self, points: np.ndarray) -> np.ndarray:
        """(N,) signed distance of points (3, N) to the flesh, m; never too large."""
        pieces = self.pieces(points)
        whole = None
        for group in dict.fromkeys(self.groups.tolist()):
            side, _, kind = group.rpartition("_")
            within, root, joining = BLENDS[kind]
            part = _melted(pieces[self.groups == group], np.float32(within))
            if whole is None:
                whole = part
                continue
            blend = self._nearness(points, sided(root, side)) * np.float32(joining)
            whole = _melted(np.stack([whole, part]), blend)
        return whole

    def _nearness(self, points: np.ndarray, bone: str) -> np.ndarray:
        """(N,) from 1 within 4 cm of a joint down to 0.05 beyond 19 cm."""
        x, y, z = (points[i] - self.joints[bone][i] for i in range(3))
        near = np.float32(1.25) - np.sqrt(x * x + y * y + z * z) * np.float32(1.0 / 0.16)
        return np.minimum(np.maximum(near, np.float32(0.05)), np.float32(1.0))


def _melted(gaps: np.ndarray, blend) -> np.ndarray:
    """Smooth minimum (N,) of distances (K, N), whatever their order.

    With m the minimum: m - sum over the others of max(blend - (d - m), 0)^2 / (4 blend).
    """
    if len(gaps) == 1:
        return gaps[0]
    least = gaps.min(0)
    bite = np.maximum(blend + least - gaps, np.float32(0.0))
    bite *= bite
    total = bite[0]
    for row in bite[1:]:
        total = total + row
    return least - (total / blend - blend) * np.float32(0.25)


@dataclass(frozen=True, eq=False)
class Trace:
    """What rays met.

    Attributes:
        depth: (N,) distance to the flesh along the ray, m; infinite for a miss.
        entry: (N,) range, m, from which on a neighbouring ray may meet flesh; infinite: none can.
    """

    depth: np.ndarray
    entry: np.ndarray


def traced(flesh: Flesh, centre, rays, near: float, start=None) -> Trace | None:
    """Sphere tracing of a narrow bundle of unit rays; None where no ray comes near the flesh.

    Args:
        flesh: what to meet.
        centre: (3,) where the rays begin, m.
        rays: (N, 3) unit directions.
        near: clearance that marks a ray's `Trace.entry`.
        start: (N,) ranges known to be free, m; by default up to the flesh's bounding balls.
    """
    middle, reach = flesh.numbers["middle"][:, :, 0].T - centre, flesh.numbers["reach"][:, 0]
    axis = rays.mean(0) / np.linalg.norm(rays.mean(0))
    spread = np.linalg.norm(rays - axis, axis=1).max()
    depth = middle @ axis
    gap = np.linalg.norm(middle - depth[:, None] * axis, axis=1) - reach - spread * (depth + reach)
    members = gap < MARGIN
    if not (gap < 0.02).any():
        return None
    if start is None:
        start = np.full(len(rays), (depth - reach)[members].min(), np.float32)
    span = (start, np.float32((depth + reach)[members].max() * 1.1))
    origin, ways = np.float32(centre)[:, None], np.ascontiguousarray(rays.T, np.float32)
    return Trace(*_march(flesh.kept(members), origin, ways, span, np.float32(near)))


def _march(flesh, origin, ways, span, near) -> np.ndarray:
    """Step rays (3, N) forward, each as long as it is under way: depth and entry, (2, N)."""
    depth, entry = np.full((2, ways.shape[1]), np.inf, np.float32)
    alive, t = np.arange(ways.shape[1]), span[0].copy()
    for _ in range(STEPS):
        gap = flesh.distance(origin + ways[:, alive] * t)
        close = gap < near * t
        entry[alive[close]] = np.minimum(entry[alive[close]], t[close])
        hit = gap < SURFACE
        depth[alive[hit]] = t[hit]
        t = t + np.maximum(gap * np.float32(0.95), LEAST_STEP)
        going = ~hit & (t < span[1])
        alive, t = alive[going], t[going]
        if not len(alive):
            break
    return np.stack([depth, entry])


def window(flesh: Flesh, camera: Camera) -> list[tuple[slice, slice]]:
    """Tiles (rows, columns) of the picture that may show the performer."""
    corners = np.array([[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)]) * 0.12
    pixels = camera.projected(flesh.ends.reshape(-1, 1, 3) + corners).reshape(-1, 2)
    low = np.maximum(np.floor(pixels.min(0)).astype(int), 0)
    high = np.minimum(np.ceil(pixels.max(0)).astype(int) + 1, (WIDTH, HEIGHT))
    return [
        (slice(y, min(y + TILE, high[1])), slice(x, min(x + TILE, high[0])))
        for y in range(low[1], high[1], TILE)
        for x in range(low[0], high[0], TILE)
    ]


def coverage(flesh: Flesh, camera: Camera) -> tuple[np.ndarray, np.ndarray]:
    """How many of a pixel's nine samples the performer covers (H, W), and the depth (H, W), m."""
    near = CLEARANCE_PX / camera.matrix[0, 0]
    pixels = np.stack(np.meshgrid(np.arange(WIDTH), np.arange(HEIGHT)), -1).astype(float)
    rays, centre = camera.rays(pixels), camera.centre
    depth, entry = np.full((2, HEIGHT, WIDTH), np.inf, np.float32)
    tiles = window(flesh, camera)
    for tile in tiles:
        trace = traced(flesh, centre, rays[tile].reshape(-1, 3), near)
        if trace is not None:
            depth[tile] = trace.depth.reshape(depth[tile].shape)
            entry[tile] = trace.entry.reshape(entry[tile].shape)
    inside = cv2.erode(np.isfinite(depth).astype(np.uint8), np.ones((3, 3), np.uint8)) > 0
    outline = np.isfinite(entry) & ~inside
    count = np.where(inside, 9, 0).astype(np.uint8)
    for tile in tiles:
        edge = outline[tile]
        if not edge.any():
            continue
        samples = camera.rays(pixels[tile][edge][:, None] + np.array(SAMPLES)).reshape(-1, 3)
        start = np.repeat(entry[tile][edge], len(SAMPLES)) - np.float32(0.01)
        trace = traced(flesh, centre, samples, near, start)
        count[tile][edge] = np.isfinite(trace.depth).reshape(-1, len(SAMPLES)).sum(1)
    return count, depth


def mask(flesh: Flesh, camera: Camera) -> np.ndarray:
    """The silhouette (H, W) uint8: 255 where at least five of nine samples are covered."""
    return np.where(coverage(flesh, camera)[0] >= 5, 255, 0).astype(np.uint8)
