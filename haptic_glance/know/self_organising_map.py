"""A self-organising map of one to eight dimensions: samples become positions on a grid (T4.2.3.5, T4.4.9)."""

import numpy as np
from sklearn.base import BaseEstimator, TransformerMixin

NEURONS = 600  # approximately, for any number of dimensions: a map of 5 dimensions has 4 per side, one of 2 has 24
PASSES = 20  # over all samples; RapidMiner's default is 30, for the slower training sample by sample
MAX_WIDTH = 0.5  # of the map's side: the neighbourhood's width in the first pass
MAX_DIMENSIONS = 8  # with two neurons per side, the least, the map then has 256 neurons


class SelfOrganisingMap(TransformerMixin, BaseEstimator):
    """Batch map (Kohonen 2001, section 3.6) on a grid of `dimensions` dimensions, in the manner of scikit-learn.

    `transform` gives (k, dimensions) f8: the position of each sample's nearest neuron in the grid, 0..1. Neurons start
    on the plane of the first principal components, and each pass uses all samples at once. So the map needs no random
    numbers and does not depend on the order of the samples. The maintained packages have maps of two dimensions only.
    The thesis tries output sizes of 2 to 6, which are dimensions of the map in RapidMiner, the tool of T4.2.
    neurons: how many, approximately; each side has the same whole number of them.
    """

    def __init__(self, dimensions: int = 2, neurons: int = NEURONS) -> None:
        self.dimensions = dimensions
        self.neurons = neurons

    def fit(self, samples: np.ndarray, labels: np.ndarray | None = None) -> "SelfOrganisingMap":
        """Fits to samples (k, d), finite, with d at least the number of dimensions; labels are ignored."""
        samples = self._check(samples)
        side = max(2, round(self.neurons ** (1 / self.dimensions)))
        axis_positions = np.linspace(0, 1, side)
        grid = np.stack(np.meshgrid(*[axis_positions] * self.dimensions, indexing="ij"), axis=-1)
        self.positions_ = grid.reshape(-1, self.dimensions)
        self.neurons_ = _initial_neurons(samples, self.positions_)
        samples_and_ones = np.column_stack([samples, np.ones(len(samples))])  # the last column counts samples
        for width in np.geomspace(MAX_WIDTH, MAX_WIDTH / (side - 1), PASSES):
            sums = np.zeros((len(self.positions_), samples_and_ones.shape[1]))
            np.add.at(sums, self._nearest(samples), samples_and_ones)
            kernel = np.exp(-((axis_positions[:, None] - axis_positions) ** 2) / (2 * width**2))
            smoothed = _smooth_grid(kernel, sums.reshape(*grid.shape[:-1], -1)).reshape(sums.shape)
            counts, least = smoothed[:, -1:], np.finfo(float).tiny
            means = smoothed[:, :-1] / np.maximum(counts, least)
            self.neurons_ = np.where(counts < least, self.neurons_, means)  # far from any sample weights underflow
        return self

    def transform(self, samples: np.ndarray) -> np.ndarray:
        """(k, dimensions): the grid position of the neuron nearest to each sample."""
        return self.positions_[self._nearest(np.asarray(samples, dtype=np.float64))]

    def _check(self, samples: np.ndarray) -> np.ndarray:
        samples = np.asarray(samples, dtype=np.float64)
        if not 1 <= self.dimensions <= MAX_DIMENSIONS:
            raise ValueError(f"a map has 1 to {MAX_DIMENSIONS} dimensions, got {self.dimensions}")
        if samples.ndim != 2 or len(samples) < 2 or samples.shape[1] < self.dimensions:
            raise ValueError(f"a map of {self.dimensions} dimensions needs samples (k, d) of as many: {samples.shape}")
        if not np.isfinite(samples).all():
            raise ValueError("samples hold NaN or infinite values")
        return samples

    def _nearest(self, samples: np.ndarray) -> np.ndarray:
        """(k,) index of the neuron nearest to each sample, the first of equals."""
        neurons = self.neurons_
        return np.concatenate(
            [
                ((neurons**2).sum(axis=1) - 2 * part @ neurons.T).argmin(axis=1)
                for part in np.array_split(samples, max(-(-len(samples) // 4096), 1))
            ]
        )


def _smooth_grid(kernel, sums):
    """Sums on the grid (side, ..., side, d) smoothed along each axis in turn: a Gaussian is separable."""
    for axis in range(sums.ndim - 1):
        sums = np.moveaxis(np.tensordot(kernel, sums, axes=(1, axis)), 0, axis)
    return sums


def _initial_neurons(samples, positions):
    """(neurons, d): the grid within one standard deviation of the mean, along the first principal components."""
    mean = samples.mean(axis=0)
    _, smoothed, axes = np.linalg.svd(samples - mean, full_matrices=False)
    count = min(positions.shape[1], len(smoothed))
    axes = axes[:count] * np.sign(axes[np.arange(count), np.abs(axes[:count]).argmax(axis=1)])[:, None]
    return mean + (2 * positions[:, :count] - 1) @ (axes * smoothed[:count, None] / np.sqrt(len(samples)))
