"""Sequential touch: one place after another until the belief in one object is strong (T4.2.3.5).

Public names: calibrate, explore, split_touches, stop, Calibration, Trial, LIKELIHOODS, SPLITS, STRATEGIES.
"""

from .belief import Calibration, calibrate
from .choose import STRATEGIES
from .explore import explore, stop
from .split_touches import SPLITS, split_touches
from .trial import LIKELIHOODS, Trial

__all__ = [
    "LIKELIHOODS",
    "SPLITS",
    "STRATEGIES",
    "Calibration",
    "Trial",
    "calibrate",
    "explore",
    "split_touches",
    "stop",
]
