"""Principal components of standardised features, as the steps of `reduction` give them, without scikit-learn."""

import numpy as np
from scipy.linalg import svd

COMPONENTS = 12  # T4.2.3.4


class Components:
    """Fitted to samples (n, d): the z-transform of each feature, then the first COMPONENTS principal components.

    The operations and their order are those of scikit-learn's StandardScaler and PCA, so that no bit differs.
    """

    def __init__(self, samples: np.ndarray) -> None:
        count, eps = len(samples), np.finfo(float).eps
        self._mean = samples.sum(axis=0) / count
        away = samples - self._mean
        variance = ((away**2).sum(axis=0) - away.sum(axis=0) ** 2 / count) / count
        constant = variance <= count * eps * variance + (count * self._mean * eps) ** 2  # but for rounding
        self._scale = np.where(constant, 1, np.sqrt(variance))
        scaled = self._scaled(samples)
        self._centre = scaled.mean(axis=0)
        axes = svd(scaled - self._centre, full_matrices=False)[2][:COMPONENTS]
        largest = np.take_along_axis(axes, np.abs(axes).argmax(axis=1)[:, None], axis=1)
        self._axes = np.sign(largest) * axes

    def transform(self, samples: np.ndarray) -> np.ndarray:
        """(k, COMPONENTS) of samples (k, d)."""
        return self._scaled(samples) @ self._axes.T - self._centre[None] @ self._axes.T

    def _scaled(self, samples: np.ndarray) -> np.ndarray:
        return (samples - self._mean) / self._scale
