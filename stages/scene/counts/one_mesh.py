"""The face count from one simplified mesh of the object: its error, extrapolated by a common power law."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from .curves import Curve
from .models import FEWEST, FLOOR


@dataclass(frozen=True)
class PowerLaw:
    """faces ~ error ** -exponent, the same for all objects."""

    exponent: float

    def faces_needed(
        self, error: ArrayLike, faces: ArrayLike, measured: ArrayLike, initial_faces: ArrayLike
    ) -> int | np.ndarray:
        """The faces for an error over the diagonal, from one simplified mesh with `faces` faces and error `measured`.

        All may be arrays: (k,) i8, or an int for numbers. Between 4 and initial_faces.
        """
        ratio = np.maximum(measured, FLOOR) / np.maximum(error, FLOOR)
        found = np.ceil(np.asarray(faces) * ratio**self.exponent - 1e-6)
        found = np.minimum(np.maximum(found, FEWEST), initial_faces).astype(np.int64)
        return int(found) if found.ndim == 0 else found


def fit_power_law(curves: Sequence[Curve]) -> PowerLaw:
    """The PowerLaw of measured curves: least squares of log faces on log error about the mean of each curve.

    Errors below FLOOR are left out. Raises ValueError where no curve has two points of unequal error.
    """
    covariance, variance = 0.0, 0.0
    for curve in curves:
        used = curve.errors > FLOOR
        if used.any():
            errors, faces = np.log(curve.errors[used]), np.log(curve.faces[used])
            covariance += ((errors - errors.mean()) * (faces - faces.mean())).sum()
            variance += ((errors - errors.mean()) ** 2).sum()
    if variance == 0:
        raise ValueError(f"a power law needs a curve with two points above an error of {FLOOR:g}")
    return PowerLaw(float(-covariance / variance))
