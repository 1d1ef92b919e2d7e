"""The measurements of the sensor along one contour (T4.4.5)."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Sequence:
    """The frames of one contour, in the order of motion.

    images (frames, rows, cols) f4 in 0..1 (the cutaneous cues), normals (frames, 3) unit vectors of the array and
    positions (frames, 3) in units of the mesh (the kinesthetic cues), pitches (frames,) units between neighbouring
    cells. loops: the number of curves of the section; length of the one that was followed, in units; share: of the
    length of all curves.
    """

    images: np.ndarray
    normals: np.ndarray
    positions: np.ndarray
    pitches: np.ndarray
    loops: int
    length: float
    share: float
