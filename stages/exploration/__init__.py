"""No more touches than needed: touch one place after another until the belief in one object is strong (T4.2.3.5).

Public names: hold_out, SPLITS, Trial, LIKELIHOODS, Calibration, calibrate, explore, stop, WAYS.
"""

from .belief import Calibration, calibrate
from .choose import WAYS
from .explore import explore, stop
from .hold_out import SPLITS, hold_out
from .trial import LIKELIHOODS, Trial

__all__ = ["LIKELIHOODS", "SPLITS", "WAYS", "Calibration", "Trial", "calibrate", "explore", "hold_out", "stop"]
