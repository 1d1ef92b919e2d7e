"""Several touches as one sample: each imprint as a place on a self-organising map, then joined (T4.2.3.5)."""

import numpy as np

# The thesis's software was RapidMiner; these are the defaults of its self-organising map.
SIDE = 10  # neurons along each edge of the map
ROUNDS = 30  # passes over the imprints
RATES = (0.8, 0.01)  # strength of adaption in the first and the last pass
RADII = (10.0, 1.0)  # reach of adaption, in neurons


class TouchMap:
    """A self-organising map of 10 x 10 neurons that reduces an imprint's features to two numbers (Kohonen 1990).

    Features are standardised by those that `fit` was given. Radius and rate fall geometrically from pass to pass, as
    in Ritter and Schulten 1988. The library is MiniSom, which keeps its own random numbers: `seed` decides the map.
    """

    def __init__(self, seed=0):
        self.seed = seed

    def fit(self, samples):
        """Learns the map of features (k, d)."""
        from minisom import MiniSom
        from sklearn.preprocessing import StandardScaler

        self._scaler = StandardScaler().fit(samples)
        scaled = self._scaler.transform(samples)
        self._map = MiniSom(
            SIDE, SIDE, scaled.shape[1], sigma=RADII[0], learning_rate=RATES[0], decay_function=_falling(RATES),
            sigma_decay_function="asymptotic_decay", random_seed=self.seed,
        )  # fmt: skip
        self._map._sigma_decay_function = _falling(RADII)
        self._map.random_weights_init(scaled)
        self._map.train(scaled, ROUNDS, random_order=True, use_epochs=True)
        return self

    def transform(self, samples):
        """(k, 2) row and column of the neuron nearest to each sample, 0..9."""
        weights = self._map.get_weights().reshape(SIDE * SIDE, -1)
        scaled = self._scaler.transform(samples)
        gaps = (weights**2).sum(axis=1) - 2 * scaled @ weights.T
        return np.stack(np.divmod(gaps.argmin(axis=1), SIDE), axis=1).astype(np.float64)


def _falling(ends):
    """decay(start, pass, passes): from the first to the last of `ends`, by an equal factor a pass."""

    def decay(start, t, passes):
        return start * (ends[1] / ends[0]) ** (t / max(passes - 1, 1))

    return decay


def combine(truth, count, random):
    """(k, count) indices: one combination an imprint, itself and count - 1 others of its object at random.

    The thesis tells neither how many combinations it drew nor whether an imprint may come twice: one for each imprint
    keeps the number of samples equal from one touch to five, and no imprint comes twice in a combination.
    Raises ValueError where an object has fewer imprints than a combination takes.
    """
    truth = np.asarray(truth)
    joined = np.empty((len(truth), count), dtype=np.int64)
    for one in np.unique(truth):
        own = np.flatnonzero(truth == one)
        if len(own) < count:
            raise ValueError(f"{len(own)} imprints of one object make no combination of {count}")
        keys = random.random((len(own), len(own)))
        np.fill_diagonal(keys, -1)  # itself comes first
        joined[own] = own[keys.argsort(axis=1)[:, :count]]
    return joined


def join(numbers, combinations):
    """(k, count * d) the numbers (n, d) of the imprints of each combination (k, count), one after another."""
    return numbers[combinations].reshape(len(combinations), -1)
