"""The thesis's "deep learning": a small feed-forward network trained sample by sample with Adadelta (T4.2.4)."""

import numpy as np
from sklearn.base import BaseEstimator, ClassifierMixin

RHO = 0.99  # Adadelta's decay; RapidMiner's default
PRECISION = np.float32  # as in RapidMiner's H2O
LANES = 16  # a unit's weights and bias fill a multiple of these, so that compiled loops leave no remainder
EPSILON = 1e-8  # Adadelta's smallest step, squared; RapidMiner's default


class FeedForward(ClassifierMixin, BaseEstimator):
    """Fully connected network with rectified hidden layers and softmax, as a scikit-learn estimator.

    The thesis gives rectified units, stochastic gradient descent, Adadelta (Zeiler 2012) and 10 epochs, but no layers.
    Two layers of 50, Adadelta's constants and one sample per step are the defaults of RapidMiner, which it used. The
    loop is compiled: at this size a step takes a hundredth of its time in an autograd framework, and the result does
    not depend on the number of threads.

    hidden: units of each hidden layer; epochs: passes over the samples, each in an order drawn from `seed`.
    """

    def __init__(self, hidden: tuple[int, ...] = (50, 50), epochs: int = 10, seed: int = 0) -> None:
        self.hidden = hidden
        self.epochs = epochs
        self.seed = seed

    def fit(self, samples: np.ndarray, labels: np.ndarray) -> "FeedForward":
        """Trains on samples (k, d), finite and standardised, and labels (k,)."""
        from .network_kernel import train  # numba takes half a second to load

        samples = np.ascontiguousarray(samples, dtype=PRECISION)
        if samples.ndim != 2 or len(samples) != len(labels) or not np.isfinite(samples).all():
            raise ValueError(f"samples must be finite, of shape (k, d), one per label: {samples.shape}, {len(labels)}")
        self.classes_, targets = np.unique(labels, return_inverse=True)
        random = np.random.default_rng(self.seed)
        sizes = (samples.shape[1], *self.hidden, len(self.classes_))
        widths = [-(-(size + 1) // LANES) * LANES for size in sizes]
        units = tuple(np.zeros(shape, PRECISION) for shape in zip(sizes[1:], widths[:-1], strict=True))
        self._layers = [(own[:, :size].T, own[:, size]) for own, size in zip(units, sizes[:-1], strict=True)]
        for weights, _ in self._layers:
            bound = np.sqrt(6 / sum(weights.shape))  # Glorot and Bengio 2010
            weights[...] = random.uniform(-bound, bound, weights.shape)
        passes = [random.permutation(len(samples)) for _ in range(self.epochs)]
        order = np.concatenate([np.empty(0, dtype=np.int64), *passes])
        values, errors = (tuple(np.zeros(width, PRECISION) for width in widths) for _ in range(2))
        for own, size in zip(values[:-1], sizes[:-1], strict=True):
            own[size] = 1  # the input of the biases
        squares, steps = (tuple(np.zeros_like(own) for own in units) for _ in range(2))
        train(units, squares, steps, values, errors, samples, targets, order, PRECISION(RHO), PRECISION(EPSILON))
        return self

    def predict_proba(self, samples: np.ndarray) -> np.ndarray:
        """(k, classes) probabilities."""
        values = np.asarray(samples, dtype=PRECISION)
        for weights, bias in self._layers[:-1]:
            values = np.maximum(values @ weights + bias, 0)
        weights, bias = self._layers[-1]
        return _softmax(values @ weights + bias)

    def predict(self, samples: np.ndarray) -> np.ndarray:
        """(k,) labels."""
        return self.classes_[self.predict_proba(samples).argmax(axis=1)]


def _softmax(values):
    powers = np.exp(values - values.max(axis=-1, keepdims=True))
    return powers / powers.sum(axis=-1, keepdims=True)
