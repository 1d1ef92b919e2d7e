"""A self-organising map in two dimensions or more: many numbers to a few that keep neighbours together (T4.4.9)."""

import numpy as np
from sklearn.base import BaseEstimator, TransformerMixin

NEURONS = 600  # about so many, whatever the dimension: a map of 5 dimensions has 4 a side, one of 2 has 24
ROUNDS = 20  # passes over all samples; RapidMiner's default is 30, of the slower kind that takes one by one
WIDEST = 0.5  # of the map's side: the neighbourhood in the first pass
LARGEST = 8  # dimensions: at three neurons a side the map then has 6,561


class SelfOrganisingMap(TransformerMixin, BaseEstimator):
    """Batch map (Kohonen 2001, section 3.6) on a grid of `dimensions` dimensions, in the manner of scikit-learn.

    `transform` gives (k, dimensions) f8: the place of each sample's nearest neuron in the grid, 0..1. It starts on the
    plane of the first principal components and takes all samples at once, so that it needs no random numbers and does
    not depend on the order of the samples. The kept packages know flat maps alone; the thesis tries output sizes of 2
    to 6, which is the number of dimensions in RapidMiner's map, the tool of T4.2.
    """

    def __init__(self, dimensions=2):
        self.dimensions = dimensions

    def fit(self, samples, labels=None):
        """Learns from samples (k, d), finite, d at least the number of dimensions; labels are not looked at."""
        samples = self._check(samples)
        side = max(2, round(NEURONS ** (1 / self.dimensions)))
        along = np.linspace(0, 1, side)
        grid = np.stack(np.meshgrid(*[along] * self.dimensions, indexing="ij"), axis=-1)
        self.places_ = grid.reshape(-1, self.dimensions)
        self.neurons_ = _start(samples, self.places_)
        whole = np.column_stack([samples, np.ones(len(samples))])  # the last column counts
        for width in np.geomspace(WIDEST, WIDEST / (side - 1), ROUNDS):
            sums = np.zeros((len(self.places_), whole.shape[1]))
            np.add.at(sums, self._nearest(samples), whole)
            pull = np.exp(-((along[:, None] - along) ** 2) / (2 * width**2))
            spread = _along_each_side(pull, sums.reshape(*grid.shape[:-1], -1)).reshape(sums.shape)
            self.neurons_ = spread[:, :-1] / np.maximum(spread[:, -1:], np.finfo(float).tiny)
        return self

    def transform(self, samples):
        """(k, dimensions): where the nearest neuron of each sample lies."""
        return self.places_[self._nearest(np.asarray(samples, dtype=np.float64))]

    def _check(self, samples):
        samples = np.asarray(samples, dtype=np.float64)
        if not 1 <= self.dimensions <= LARGEST:
            raise ValueError(f"a map has 1 to {LARGEST} dimensions, got {self.dimensions}")
        if samples.ndim != 2 or len(samples) < 2 or samples.shape[1] < self.dimensions:
            raise ValueError(f"a map of {self.dimensions} dimensions needs samples (k, d) of as many: {samples.shape}")
        if not np.isfinite(samples).all():
            raise ValueError("samples hold NaN or infinite values")
        return samples

    def _nearest(self, samples):
        """(k,) the neuron nearest to each sample, the first of equals."""
        neurons = self.neurons_
        return np.concatenate(
            [
                ((neurons**2).sum(axis=1) - 2 * part @ neurons.T).argmin(axis=1)
                for part in np.array_split(samples, -(-len(samples) // 4096))
            ]
        )


def _along_each_side(pull, sums):
    """Sums on the grid (side, ..., side, d) spread over it: a Gaussian of many dimensions is one along each in turn."""
    for axis in range(sums.ndim - 1):
        sums = np.moveaxis(np.tensordot(pull, sums, axes=(1, axis)), 0, axis)
    return sums


def _start(samples, places):
    """(neurons, d): the grid spread over one standard deviation to each side along the first principal components."""
    mean = samples.mean(axis=0)
    _, spread, axes = np.linalg.svd(samples - mean, full_matrices=False)
    count = min(places.shape[1], len(spread))
    axes = axes[:count] * np.sign(axes[np.arange(count), np.abs(axes[:count]).argmax(axis=1)])[:, None]
    return mean + (2 * places[:, :count] - 1) @ (axes * spread[:count, None] / np.sqrt(len(samples)))
