"""The training loop of the small feed-forward network, compiled by numba, ten times as fast as plain numpy."""

import numba
import numpy as np

REAL = np.float32


# error_model: divides as numpy does, without a branch on zero that would prevent vectorisation of Adadelta's loop.
@numba.njit(cache=True, nogil=True, error_model="numpy")
def train(
    parameters: np.ndarray,
    sizes: np.ndarray,
    samples: np.ndarray,
    targets: np.ndarray,
    order: np.ndarray,
    rho: np.float32,
    epsilon: np.float32,
) -> None:
    """Moves the parameters (n,) f4 in place, by one step of Adadelta for every sample index in `order`.

    The parameters are, layer by layer, weights (rows, columns) and biases (columns,), one after another. sizes (d,) i8
    units of each layer, inputs first; samples (k, sizes[0]) f4; targets (k,) i8; rho, epsilon f4 (Zeiler 2012,
    algorithm 1).
    """
    depth, count = len(sizes) - 1, len(parameters)
    squares, steps, gradient = np.zeros(count, REAL), np.zeros(count, REAL), np.zeros(count, REAL)
    starts, places = np.zeros(depth + 1, np.int64), np.zeros(depth + 2, np.int64)
    for layer in range(depth):
        starts[layer + 1] = starts[layer] + (sizes[layer] + 1) * sizes[layer + 1]
    for layer in range(depth + 1):
        places[layer + 1] = places[layer] + sizes[layer]
    values, errors = np.zeros(places[-1], REAL), np.zeros(places[-1], REAL)
    for i in order:
        values[: sizes[0]] = samples[i]
        _forward(parameters, sizes, starts, places, values)
        _softmax_error(values[places[depth] :], targets[i], errors[places[depth] :])
        _backward(parameters, sizes, starts, places, values, errors, gradient)
        _adadelta(parameters, gradient, squares, steps, rho, epsilon)


@numba.njit(error_model="numpy")
def _forward(parameters, sizes, starts, places, values):
    """Fills in the units of all layers but the first; the last layer is not rectified."""
    depth = len(sizes) - 1
    for layer in range(depth):
        rows, columns, start = sizes[layer], sizes[layer + 1], starts[layer]
        out = values[places[layer + 1] : places[layer + 1] + columns]
        out[:] = parameters[start + rows * columns : start + (rows + 1) * columns]
        for row in range(rows):
            value = values[places[layer] + row]
            if value != 0:
                weights = parameters[start + row * columns : start + (row + 1) * columns]
                for column in range(columns):
                    out[column] += value * weights[column]
        if layer < depth - 1:
            for column in range(columns):
                out[column] = max(out[column], REAL(0))


@numba.njit(error_model="numpy")
def _softmax_error(values, target, errors):
    """The gradient of the cross-entropy with respect to the last layer's values."""
    top, total = values.max(), REAL(0)
    for k in range(len(values)):
        errors[k] = np.exp(values[k] - top)
        total += errors[k]
    for k in range(len(values)):
        errors[k] /= total
    errors[target] -= REAL(1)


@numba.njit(error_model="numpy")
def _backward(parameters, sizes, starts, places, values, errors, gradient):
    """Fills in the gradient of the parameters, from the errors of the last layer."""
    for layer in range(len(sizes) - 2, -1, -1):
        rows, columns, start = sizes[layer], sizes[layer + 1], starts[layer]
        error = errors[places[layer + 1] : places[layer + 1] + columns]
        gradient[start + rows * columns : start + (rows + 1) * columns] = error
        for row in range(rows):
            value, back = values[places[layer] + row], REAL(0)
            weights = parameters[start + row * columns : start + (row + 1) * columns]
            slot = gradient[start + row * columns : start + (row + 1) * columns]
            for column in range(columns):
                slot[column] = value * error[column]
            if layer > 0 and value > 0:
                for column in range(columns):
                    back += weights[column] * error[column]
            errors[places[layer] + row] = back


@numba.njit(error_model="numpy")
def _adadelta(parameters, gradient, squares, steps, rho, epsilon):
    """One step of Zeiler 2012, algorithm 1."""
    for k in range(len(parameters)):
        slope = gradient[k]
        squares[k] = rho * squares[k] + (REAL(1) - rho) * (slope * slope)
        change = np.sqrt((steps[k] + epsilon) / (squares[k] + epsilon)) * slope
        parameters[k] -= change
        steps[k] = rho * steps[k] + (REAL(1) - rho) * (change * change)
