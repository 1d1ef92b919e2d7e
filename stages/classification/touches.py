"""Several touches as one sample: each imprint as a position on a self-organising map (T4.2.3.5)."""

from typing import Any

import numpy as np

# The thesis's software was RapidMiner; these are the defaults of its self-organising map.
SIDE = 10  # neurons along each edge of the map
PASSES = 30  # passes over the imprints
RATES = (0.8, 0.01)  # learning rate in the first and the last pass
RADII = (10.0, 1.0)  # width of the neighbourhood in the first and the last pass, in neurons


class TouchMap:
    """A self-organising map of 10 x 10 neurons that reduces an imprint's features to two numbers (Kohonen 1990).

    Features are standardised by those that `fit` is given. Radius and rate fall geometrically from pass to pass, as in
    Ritter and Schulten 1988. The library is MiniSom, whose random numbers are determined by `seed`.
    """

    def __init__(self, seed: int = 0) -> None:
        self.seed = seed

    def fit(self, samples: np.ndarray) -> "TouchMap":
        """Fits the map to features (k, d)."""
        from minisom import MiniSom
        from sklearn.preprocessing import StandardScaler

        self._scaler = StandardScaler().fit(samples)
        scaled = np.asarray(self._scaler.transform(samples))
        settings: dict[str, Any] = {  # the stub infers types from the defaults
            "sigma": RADII[0], "learning_rate": RATES[0], "decay_function": _geometric_decay(RATES),
            "sigma_decay_function": "asymptotic_decay", "random_seed": self.seed,
        }  # fmt: skip
        self._map = MiniSom(SIDE, SIDE, scaled.shape[1], **settings)
        self._map._sigma_decay_function = _geometric_decay(RADII)
        self._map.random_weights_init(scaled)
        self._map.train(scaled, PASSES, random_order=True, use_epochs=True)
        return self

    def transform(self, samples: np.ndarray) -> np.ndarray:
        """(k, 2): row and column of the neuron nearest to each sample, 0..9."""
        weights = np.asarray(self._map.get_weights()).reshape(SIDE * SIDE, -1)
        scaled = np.asarray(self._scaler.transform(samples))
        distances = (weights**2).sum(axis=1) - 2 * scaled @ weights.T
        return np.stack(np.divmod(distances.argmin(axis=1), SIDE), axis=1).astype(np.float64)


def _geometric_decay(first_and_last):
    """A function (start, pass, passes) that falls from the first to the last value by an equal factor per pass."""

    def decay(start, t, passes):
        return start * (first_and_last[1] / first_and_last[0]) ** (t / max(passes - 1, 1))

    return decay


def draw_combinations(truth: np.ndarray, count: int, random: np.random.Generator) -> np.ndarray:
    """(k, count) indices: one combination per imprint, itself and count - 1 random others of its object.

    The thesis gives neither the number of combinations nor whether an imprint may occur twice. One per imprint keeps
    the number of samples equal from one touch to five, and no imprint occurs twice in a combination. Raises ValueError
    if an object has fewer imprints than a combination needs.
    """
    truth = np.asarray(truth)
    combinations = np.empty((len(truth), count), dtype=np.int64)
    for one in np.unique(truth):
        own = np.flatnonzero(truth == one)
        if len(own) < count:
            raise ValueError(f"an object has {len(own)} imprints, a combination needs {count}")
        keys = random.random((len(own), len(own)))
        np.fill_diagonal(keys, -1)  # the imprint itself comes first
        combinations[own] = own[keys.argsort(axis=1)[:, :count]]
    return combinations


def concatenate_touches(numbers: np.ndarray, combinations: np.ndarray) -> np.ndarray:
    """(k, count * d): the numbers (n, d) of the imprints of each combination (k, count), one after another."""
    return numbers[combinations].reshape(len(combinations), -1)
