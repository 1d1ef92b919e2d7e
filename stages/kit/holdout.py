"""Which items train, which validate and which test."""

from typing import NamedTuple

import numpy as np


class Split(NamedTuple):
    """Ids of items: `train` and `test` are disjoint and hold all; `validation`, a part of `train`, chooses settings."""

    train: np.ndarray
    validation: np.ndarray
    test: np.ndarray

    @property
    def fit(self) -> np.ndarray:
        """The part of `train` that is not in `validation`."""
        return np.setdiff1d(self.train, self.validation)
