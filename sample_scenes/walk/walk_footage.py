"""Colour footage of the sample: a painted room, the performer in it, a soft shadow, sensor noise.

The shadow on the floor scales all three channels alike: it darkens and keeps the hue.
"""

import cv2
import numpy as np
from walk_figure import MATERIALS
from walk_render import HEIGHT, WIDTH, Camera, Flesh

LIGHT = np.array([0.30, -0.42, 0.86])
LIGHT_SPREAD = 0.07
ROOM_RADIUS = 6.0
SHADOW_SIDE, SHADOW_STEP = 8.0, 0.02
# a lamp that gives half of the light: 1 - 0.5 ** (1 / 2.2) in gamma-encoded values
SHADOW_DEPTH = 0.27
NOISE = 1.6
COLOURS_RGB = {
    "skin": (214, 166, 138), "hair": (62, 42, 32), "shirt": (178, 58, 52),
    "trousers": (98, 82, 48), "shoes": (88, 50, 34),
}  # fmt: skip
FLOOR_RGB, WALL_RGB = (132, 141, 160), (168, 190, 166)


def _blotches(shape: tuple[int, int], cells: int, rng: np.random.Generator) -> np.ndarray:
    """Smooth noise (H, W) float32 of unit spread with about ``cells`` blotches across."""
    coarse = rng.normal(size=(cells, cells)).astype(np.float32)
    return cv2.resize(coarse, shape[::-1], interpolation=cv2.INTER_CUBIC)


class Room:
    """The empty room as one camera sees it.

    Attributes:
        picture: (H, W, 3) float32 BGR, 0..255.
        floor: (H, W, 2) float32 world x, y of the floor in each pixel; far away on the wall.
    """

    def __init__(self, camera: Camera, seed: int):
        rng = np.random.default_rng(seed)
        pixels = np.stack(np.meshgrid(np.arange(WIDTH), np.arange(HEIGHT)), -1).astype(float)
        rays, centre = camera.rays(pixels), camera.centre
        down = np.minimum(rays[..., 2], -1e-6)
        ground = centre[:2] - centre[2] / down[..., None] * rays[..., :2]
        on_floor = np.linalg.norm(ground, axis=-1) < ROOM_RADIUS
        a = (rays[..., :2] ** 2).sum(-1)
        b = rays[..., :2] @ centre[:2]
        range_ = (np.sqrt(b**2 - a * (centre[:2] @ centre[:2] - ROOM_RADIUS**2)) - b) / a
        wall = centre + range_[..., None] * rays
        around = np.arctan2(wall[..., 1], wall[..., 0])
        folds = 1.0 + 0.05 * np.sin(26.0 * around) + 0.03 * np.sin(61.0 * around + 1.0)
        joints = (np.abs((ground / 0.6) % 1.0 - 0.5) > 0.485).any(-1)
        tiles = 1.0 + 0.04 * np.sin(12.9898 * np.floor(ground / 0.6) @ [1.0, 6.053]) - 0.12 * joints
        texture = np.where(on_floor, tiles, folds)
        for cells, strength in ((40, 0.035), (9, 0.03)):
            texture = texture + strength * _blotches((HEIGHT, WIDTH), cells, rng)
        colour = np.where(on_floor[..., None], FLOOR_RGB[::-1], WALL_RGB[::-1])
        self.picture = cv2.GaussianBlur(np.float32(colour * texture[..., None]), (0, 0), 0.6)
        self.floor = np.float32(np.where(on_floor[..., None], ground, 1e3))

    def plate(self) -> np.ndarray:
        """The mean of many empty pictures, (H, W, 3) uint8 BGR."""
        return np.uint8(np.clip(np.rint(self.picture), 0, 255))


def floor_shadow(flesh: Flesh) -> np.ndarray:
    """How much of the lamp each cell of the floor misses, (S, S) float32 0..1, x along columns."""
    side = round(SHADOW_SIDE / SHADOW_STEP)
    total = np.zeros((side, side), np.float32)
    thickness = np.rint(2.0 * flesh.numbers["radius"][:, 0] / SHADOW_STEP).astype(int)
    lamps = [(0.0, 0.0), *((np.cos(a), np.sin(a)) for a in np.arange(8) * np.pi / 4.0)]
    for lamp in lamps:
        lean = (LIGHT[:2] + LIGHT_SPREAD * np.array(lamp)) / LIGHT[2]
        cast = flesh.ends[..., :2] - flesh.ends[..., 2:] * lean
        cells = np.rint(cast / SHADOW_STEP + side / 2.0).astype(int)
        layer = np.zeros((side, side), np.uint8)
        for (start, end), width in zip(cells, thickness, strict=True):
            cv2.line(layer, start.tolist(), end.tolist(), 1, max(int(width), 1))
        total += layer
    return cv2.GaussianBlur(total / len(lamps), (0, 0), 1.5)


def _shaded(flesh: Flesh, camera: Camera, depth: np.ndarray) -> np.ndarray:
    """Colours (H, W, 3) float32 BGR of the performer where ``depth`` is finite, else 0."""
    hit = np.isfinite(depth)
    rows, columns = np.nonzero(hit)
    rays = camera.rays(np.stack([columns, rows], -1).astype(float))
    points = np.float32(camera.centre + rays * depth[hit][:, None]).T
    step = np.float32(2e-3) * np.eye(3, dtype=np.float32)
    slopes = [
        flesh.distance(points + s[:, None]) - flesh.distance(points - s[:, None]) for s in step
    ]
    normals = np.stack(slopes, -1)
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    lamp = np.maximum(normals @ LIGHT / np.linalg.norm(LIGHT), 0.0)
    palette = np.array([COLOURS_RGB[name][::-1] for name in MATERIALS], np.float32)
    colours = palette[flesh.materials[np.argmin(flesh.pieces(points), 0)]]
    picture = np.zeros((*depth.shape, 3), np.float32)
    picture[hit] = colours * (0.5 + 0.2 * normals[:, 2:] + 0.55 * lamp[:, None])
    return picture


def filmed(flesh: Flesh, camera: Camera, room: Room, seen, seed) -> np.ndarray:
    """One noisy picture (H, W, 3) uint8 BGR of the performer in the room.

    Args:
        flesh: the performer in the pose of the frame.
        camera: the camera that films.
        room: the room as that camera sees it.
        seen: samples covered (H, W), 0..9, and depth (H, W) of the performer.
        seed: integers that seed the sensor noise.
    """
    count, depth = seen
    paint, known = _shaded(flesh, camera, depth), np.isfinite(depth).astype(np.float32)
    spread = cv2.blur(paint, (5, 5)) / np.maximum(cv2.blur(known, (5, 5)), 1e-6)[..., None]
    paint = np.where(known[..., None] > 0, paint, spread)
    cells = (room.floor / SHADOW_STEP + round(SHADOW_SIDE / SHADOW_STEP) / 2.0).astype(np.float32)
    shadow = cv2.remap(floor_shadow(flesh), cells, None, cv2.INTER_LINEAR, borderValue=0.0)
    empty = room.picture * (1.0 - SHADOW_DEPTH * shadow[..., None])
    share = count[..., None].astype(np.float32) / 9.0
    noise = np.random.default_rng(seed).normal(0.0, NOISE, paint.shape)
    return np.uint8(np.clip(np.rint(share * paint + (1.0 - share) * empty + noise), 0, 255))
