"""Ready masks and mattes from any tool: decoding, and writing our own.

A pixel belongs to the performer when it is at least half of full scale (128 of 255). A mask with
transparency is its alpha channel: tools that cut people out leave the colours behind it alone.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from ..errors import MocapError
from ..footage.patterns import for_camera, for_frame
from ..footage.pictures import write_picture


def mask_from_picture(picture: np.ndarray, lossy: bool = False) -> np.ndarray:
    """(H, W) bool, True where the performer is.

    White means the performer; of coloured masks the strongest channel counts. Pictures without
    any value above 1 are read as 0/1 masks. All-black and all-white pictures stay as they are.

    Args:
        picture: (H, W), (H, W, 3) or (H, W, 4), uint8, uint16 or float in 0 to 1.
        lossy: whether the picture was compressed with loss: then values of 0 and 1 are black.
    """
    values = _mask_values(picture)
    if values.dtype.kind == "f":
        return values >= 0.5
    top = int(values.max(initial=0))
    if top <= 1 and not lossy:
        return values == 1
    # some tools store 8-bit masks in 16-bit files
    eight_bit = values.dtype == np.uint8 or top <= 255
    return values >= (128 if eight_bit else 128 * 257)


def _mask_values(picture: np.ndarray) -> np.ndarray:
    if picture.ndim == 2:
        return picture
    if picture.shape[2] == 4:
        alpha = picture[:, :, 3]
        opaque = 1 if alpha.dtype.kind == "f" else np.iinfo(alpha.dtype).max
        if (alpha != opaque).any():
            return alpha
    return picture[:, :, :3].max(axis=2)


@dataclass(frozen=True)
class ReadyMasks:
    """Takes the footage itself as masks (see ``mask_from_picture``)."""

    lossy: bool = False

    def foreground(self, picture: np.ndarray) -> np.ndarray:
        """(H, W) bool, True where the performer is."""
        return mask_from_picture(picture, self.lossy)


def write_masks(pattern: str | Path, camera: str, masks: Iterable[tuple[int, np.ndarray]]) -> int:
    """Writes the masks of one camera as one-bit PNG files; returns how many.

    Args:
        pattern: path with ``{frame}`` or ``{frame:06d}`` and ``{camera}``.
        camera: the camera's name.
        masks: frame number and (H, W) bool, one by one.
    """
    count = 0
    for frame, mask in masks:
        path = for_frame(for_camera(pattern, camera), frame)
        picture = np.where(mask, np.uint8(255), np.uint8(0))
        write_picture(path, picture, (cv2.IMWRITE_PNG_BILEVEL, 1))
        count += 1
    return count


def write_mask_video(path: Path, masks: Iterable[np.ndarray], fps: float) -> int:
    """Writes masks, in order, as a silhouette video (MPEG-4); returns how many.

    The compression loses a little at the contour; threshold it at 128 when reading.

    Args:
        path: the file to write, ending in .mp4; missing folders are made.
        masks: (H, W) bool, all of one size, one by one.
        fps: frames per second.

    Raises:
        MocapError: the place cannot be written to.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    video, count = None, 0
    try:
        for mask in masks:
            if video is None:
                code = cv2.VideoWriter.fourcc(*"mp4v")
                video = cv2.VideoWriter(str(path), code, fps, mask.shape[::-1])
                if not video.isOpened():
                    raise MocapError("cannot be written as a video", "use .mp4", file=path)
            grey = np.where(mask, np.uint8(255), np.uint8(0))
            video.write(cv2.cvtColor(grey, cv2.COLOR_GRAY2BGR))
            count += 1
    finally:
        if video is not None:
            video.release()
    return count
