"""The number of faces from one mesh of the object: its error once measured, carried along a common power law."""

from dataclasses import dataclass

import numpy as np

from .models import FEWEST, FLOOR


@dataclass(frozen=True)
class PowerLaw:
    """faces ~ error ** -exponent, the same for all objects."""

    exponent: float

    def faces_needed(self, error, faces, measured, initial_faces):
        """The faces for an error over the diagonal, from one simplified mesh: its count `faces`, its error `measured`.

        All may be arrays: (k,) i8, or an int. Never below 4 or above initial_faces.
        """
        wanted, known = np.maximum(error, FLOOR), np.maximum(measured, FLOOR)
        found = np.ceil(faces * (known / wanted) ** self.exponent - 1e-6)
        found = np.minimum(np.maximum(found, FEWEST), initial_faces).astype(np.int64)
        return int(found) if found.ndim == 0 else found


def fit_power_law(curves):
    """The PowerLaw of measured curves: least squares of log faces on log error about the mean of each curve.

    Errors below FLOOR are left out. Raises ValueError where no curve has two points of unequal error.
    """
    up, across = 0.0, 0.0
    for curve in curves:
        known = curve.errors > FLOOR
        if known.any():
            errors, faces = np.log(curve.errors[known]), np.log(curve.faces[known])
            up += ((errors - errors.mean()) * (faces - faces.mean())).sum()
            across += ((errors - errors.mean()) ** 2).sum()
    if across == 0:
        raise ValueError(f"a power law needs a curve with two points above an error of {FLOOR:g}")
    return PowerLaw(float(-up / across))
