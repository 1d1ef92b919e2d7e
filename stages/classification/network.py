"""The thesis's "deep learning": a small feed-forward net trained sample by sample with Adadelta (T4.2.4)."""

import numpy as np
from sklearn.base import BaseEstimator, ClassifierMixin

RHO = 0.99  # Adadelta's memory; RapidMiner's default
PRECISION = np.float32  # as in RapidMiner's H2O
EPSILON = 1e-8  # Adadelta's smallest step, squared; RapidMiner's default


class FeedForward(ClassifierMixin, BaseEstimator):
    """Fully connected net with rectified hidden layers and softmax, in the manner of scikit-learn's estimators.

    The thesis gives rectified units, stochastic gradient descent, Adadelta (Zeiler 2012) and 10 epochs, no layers: two
    of 50 are the default of RapidMiner, which it used, and so are Adadelta's constants and one sample a step. Plain
    numpy: at this size a step takes a tenth of what an autograd framework spends on it, and it is the same on any
    number of threads.

    hidden: units of each hidden layer; epochs: passes over the samples, each in an order drawn from `seed`.
    """

    def __init__(self, hidden=(50, 50), epochs=10, seed=0):
        self.hidden = hidden
        self.epochs = epochs
        self.seed = seed

    def fit(self, samples, labels):
        """Trains on samples (k, d), finite and standardised, and labels (k,)."""
        samples = np.asarray(samples, dtype=PRECISION)
        if samples.ndim != 2 or len(samples) != len(labels) or not np.isfinite(samples).all():
            raise ValueError(f"samples must be finite, of shape (k, d), one a label: {samples.shape}, {len(labels)}")
        self.classes_, targets = np.unique(labels, return_inverse=True)
        random = np.random.default_rng(self.seed)
        sizes = (samples.shape[1], *self.hidden, len(self.classes_))
        self._parameters, self._layers = _layers(sizes)
        for weights, _ in self._layers:
            bound = np.sqrt(6 / sum(weights.shape))  # Glorot and Bengio 2010
            weights[...] = random.uniform(-bound, bound, weights.shape)
        gradient, slots = _layers(sizes)
        update = _Adadelta(len(gradient))
        for _ in range(self.epochs):
            for i in random.permutation(len(samples)):
                self._backward(samples[i], targets[i], slots)
                update(self._parameters, gradient)
        return self

    def predict_proba(self, samples):
        """(k, classes) probabilities."""
        values = np.asarray(samples, dtype=PRECISION)
        for weights, bias in self._layers[:-1]:
            values = np.maximum(values @ weights + bias, 0)
        weights, bias = self._layers[-1]
        return _softmax(values @ weights + bias)

    def predict(self, samples):
        """(k,) labels."""
        return self.classes_[self.predict_proba(samples).argmax(axis=1)]

    def _backward(self, sample, target, slots):
        """Writes the gradient of the cross-entropy at one sample into the slots."""
        inputs = [sample]
        for weights, bias in self._layers[:-1]:
            inputs.append(np.maximum(inputs[-1] @ weights + bias, 0))
        weights, bias = self._layers[-1]
        error = _softmax(inputs[-1] @ weights + bias)
        error[target] -= 1
        for (weights, _), (slot, bias_slot), value in zip(self._layers[::-1], slots[::-1], inputs[::-1], strict=True):
            np.multiply(value[:, None], error, out=slot)
            bias_slot[...] = error
            error = (weights @ error) * (value > 0)


def _layers(sizes):
    """(vector, [(weights, bias), ...]): the layers are views into one vector, so that one update serves all."""
    shapes = list(zip(sizes[:-1], sizes[1:], strict=True))
    vector = np.zeros(sum((rows + 1) * columns for rows, columns in shapes), dtype=PRECISION)
    layers, start = [], 0
    for rows, columns in shapes:
        middle, end = start + rows * columns, start + (rows + 1) * columns
        layers.append((vector[start:middle].reshape(rows, columns), vector[middle:end]))
        start = end
    return vector, layers


class _Adadelta:
    """The steps of Zeiler 2012, algorithm 1, in buffers of its own: memory is most of a step's cost at this size."""

    def __init__(self, count):
        self._squares, self._steps, self._change, self._below = np.zeros((4, count), dtype=PRECISION)

    def __call__(self, parameters, gradient):
        """Moves the parameters one step against the gradient, in place."""
        squares, steps, change, below = self._squares, self._steps, self._change, self._below
        _remember(squares, gradient, change)
        np.add(steps, EPSILON, out=change)
        np.add(squares, EPSILON, out=below)
        change /= below
        np.sqrt(change, out=change)
        change *= gradient
        parameters -= change
        _remember(steps, change, below)


def _remember(mean, value, scratch):
    """mean = RHO mean + (1 - RHO) value^2, in place."""
    np.multiply(value, value, out=scratch)
    scratch *= 1 - RHO
    mean *= RHO
    mean += scratch


def _softmax(values):
    powers = np.exp(values - values.max(axis=-1, keepdims=True))
    return powers / powers.sum(axis=-1, keepdims=True)
