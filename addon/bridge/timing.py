"""Frames of a take to frames of a scene.

A scene's rate is never changed silently: only the scene made for a take gets the take's rate, and
there frame numbers agree. Elsewhere keys lie where their time falls, if need be between frames.
"""

from fractions import Fraction

import bpy
import numpy as np


def set_rate(scene: bpy.types.Scene, rate: Fraction) -> None:
    """Gives the scene ``rate`` frames per second, as near as Blender's floats allow."""
    whole = max(1, round(rate))
    scene.render.fps = whole
    scene.render.fps_base = float(whole / rate)


def scene_frames(scene: bpy.types.Scene, frames: np.ndarray, rate: Fraction) -> np.ndarray:
    """(T,) frames of the scene, whole or not, at which frames (T,) of a take of ``rate`` happen.

    Frame 0 of the take is frame 0 of the scene.
    """
    ratio = scene.render.fps / scene.render.fps_base / float(rate)
    places = np.asarray(frames, float) * ratio
    whole = np.round(places)
    return np.where(np.abs(places - whole) < 1e-3, whole, places)
