"""The "deep learning" of T4.2.4: a small feed-forward network trained sample by sample with Adadelta, compiled."""

import numba
import numpy as np
from sklearn.base import BaseEstimator, ClassifierMixin

from haptic_glance.base.jit import cached_njit

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
        samples = np.ascontiguousarray(samples, dtype=PRECISION)
        if samples.ndim != 2 or len(samples) != len(labels) or not np.isfinite(samples).all():
            raise ValueError(f"samples must be finite, of shape (k, d), one per label: {samples.shape}, {len(labels)}")
        self.classes_, targets = np.unique(labels, return_inverse=True)
        random = np.random.default_rng(self.seed)
        sizes = (samples.shape[1], *self.hidden, len(self.classes_))
        widths = [-(-(size + 1) // LANES) * LANES for size in sizes]
        units = tuple(np.zeros(shape, PRECISION) for shape in zip(sizes[1:], widths[:-1], strict=True))
        self._layers = [(layer[:, :size].T, layer[:, size]) for layer, size in zip(units, sizes[:-1], strict=True)]
        for weights, _ in self._layers:
            bound = np.sqrt(6 / sum(weights.shape))  # Glorot and Bengio 2010
            weights[...] = random.uniform(-bound, bound, weights.shape)
        passes = [random.permutation(len(samples)) for _ in range(self.epochs)]
        order = np.concatenate([np.empty(0, dtype=np.int64), *passes])
        values, errors = (tuple(np.zeros(width, PRECISION) for width in widths) for _ in range(2))
        for layer, size in zip(values[:-1], sizes[:-1], strict=True):
            layer[size] = 1  # the input of the biases
        squares, steps = (tuple(np.zeros_like(layer) for layer in units) for _ in range(2))
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


REAL = np.float32
Layers = tuple[np.ndarray, ...]


# It divides as numpy does, without a branch on zero, which would prevent vectorisation of Adadelta's loop.
@cached_njit()
def train(
    weights: Layers,
    squares: Layers,
    steps: Layers,
    values: Layers,
    errors: Layers,
    samples: np.ndarray,
    targets: np.ndarray,
    order: np.ndarray,
    rho: np.float32,
    epsilon: np.float32,
) -> None:
    """Moves the weights in place, by one step of Adadelta for every sample index in `order`.

    weights: an array (units, width) f4 for each layer, a row has the weights of a unit's inputs, its bias, and zeros;
    squares, steps: zeros of the same shapes. values, errors: (width,) f4 of the inputs and of each layer; in `values` 1
    where the next layer has its biases, 0 elsewhere. samples (k, d) f4; targets (k,) i8; rho, epsilon f4 (Zeiler 2012,
    algorithm 1).
    """
    depth, classes = len(weights), len(weights[-1])
    for i in order:
        values[0][: samples.shape[1]] = samples[i]
        for layer in range(depth):
            _forward(weights[layer], values[layer], values[layer + 1], layer < depth - 1)
        _softmax_error(values[depth], classes, targets[i], errors[depth])
        for layer in range(depth - 1, -1, -1):
            if layer > 0:
                _back(weights[layer], values[layer], errors[layer + 1], errors[layer])
            _adadelta(weights[layer], squares[layer], steps[layer], values[layer], errors[layer + 1], rho, epsilon)


# reassoc: sums are vectorised, which adds them up in another order.
@numba.njit(error_model="numpy", fastmath={"reassoc", "contract"})
def _forward(weights, values, out, rectified):
    """Fills in the units of the next layer."""
    for unit in range(len(weights)):
        total = REAL(0)
        for k in range(len(values)):
            total += weights[unit, k] * values[k]
        out[unit] = max(total, REAL(0)) if rectified else total


@numba.njit(error_model="numpy")
def _softmax_error(values, classes, target, errors):
    """The gradient of the cross-entropy with respect to the last layer's values."""
    top, total = values[:classes].max(), REAL(0)
    for k in range(classes):
        errors[k] = np.exp(values[k] - top)
        total += errors[k]
    for k in range(classes):
        errors[k] /= total
    errors[target] -= REAL(1)


@numba.njit(error_model="numpy")
def _back(weights, values, errors, back):
    """Fills in the errors of a layer from those of the next one; a unit at rest has none."""
    back[:] = 0
    for unit in range(len(weights)):
        error = errors[unit]
        if error != 0:
            for k in range(len(back)):
                back[k] += error * weights[unit, k]
    for k in range(len(back)):
        back[k] = back[k] if values[k] > 0 else REAL(0)


@numba.njit(error_model="numpy")
def _adadelta(weights, squares, steps, values, errors, rho, epsilon):
    """One step of Zeiler 2012, algorithm 1, for a layer; of a unit without an error the means decay alone."""
    for unit in range(len(weights)):
        error = errors[unit]
        if error == 0:
            for k in range(len(values)):
                squares[unit, k] *= rho
                steps[unit, k] *= rho
            continue
        for k in range(len(values)):
            slope = error * values[k]
            squares[unit, k] = rho * squares[unit, k] + (REAL(1) - rho) * (slope * slope)
            change = np.sqrt((steps[unit, k] + epsilon) / (squares[unit, k] + epsilon)) * slope
            weights[unit, k] -= change
            steps[unit, k] = rho * steps[unit, k] + (REAL(1) - rho) * (change * change)
