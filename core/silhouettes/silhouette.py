"""What one view shows of the performer."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class Silhouette:
    """The observed silhouette of one view.

    Attributes:
        foreground: (H, W) bool, True where the performer was seen.
        observed: (H, W) bool, False where the picture says nothing: under an ignore mask, or
            without a source pixel after undistortion.
    """

    foreground: np.ndarray
    observed: np.ndarray
