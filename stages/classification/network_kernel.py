"""The training loop of the small feed-forward network, compiled by numba, ten times as fast as plain numpy."""

import numba
import numpy as np

from stages.kit.jit import kernel_of

REAL = np.float32
Layers = tuple[np.ndarray, ...]


# It divides as numpy does, without a branch on zero, which would prevent vectorisation of Adadelta's loop.
@kernel_of(__file__)
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
