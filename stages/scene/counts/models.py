"""The number of faces learned from other objects: the thesis's networks, and a linear model in their place (T3.1.3)."""

import warnings
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from sklearn.compose import TransformedTargetRegressor
from sklearn.exceptions import ConvergenceWarning
from sklearn.linear_model import LinearRegression
from sklearn.neural_network import MLPRegressor
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler

from .distance import focal_length

FLOOR = 1e-6  # of the diagonal: below it an error is rounding, and says nothing about the number of faces
DISTANCES = (1.0, 2.0, 4.0, 8.0, 16.0, 32.0)  # in diagonals: an object that fills the screen to one of 30 pixels
FEWEST = 4  # a tetrahedron
HIDDEN = 30  # T3.1.3, empirically determined there
DECAY = 1.0  # weight decay: from 0.01 to 10 nothing changes that the intervals of the judgement can tell
ITERATIONS = 100  # of the quasi-Newton search: twice as many change as little


def network(seed):
    """Two layers, feed forward, 30 hidden neurons (T3.1.3; tanh and linear output, which the thesis does not name)."""
    layers = MLPRegressor(
        hidden_layer_sizes=(HIDDEN,),
        activation="tanh",
        solver="lbfgs",
        alpha=DECAY,
        max_iter=ITERATIONS,
        random_state=seed,
    )
    return make_pipeline(StandardScaler(), TransformedTargetRegressor(layers, transformer=StandardScaler()))


def linear(seed):
    """Least squares on the logarithms: a product of powers of the inputs. It draws nothing, so the seed is unused."""
    return LinearRegression()


KINDS = {"network": network, "linear": linear}


@dataclass(frozen=True)
class Counts:
    """What `fit_counts` learned: a regressor a combination, whose answers are averaged."""

    regressors: dict
    focal: float

    def faces_needed(self, tolerance, distance, initial_faces, points):
        """The faces that an object needs, the average over the combinations (T3.1.3): int, or (k,) i8 for arrays.

        tolerance in pixels; distance in bounding-box diagonals of the object; initial_faces of its full mesh; points:
        the number of salient points, one for all or a dict combination -> number. All may be arrays of one length.
        Never below 4 or above initial_faces. Raises ValueError for values that are not finite or not above zero.
        """
        points = points if isinstance(points, Mapping) else dict.fromkeys(self.regressors, points)
        lacking = sorted(set(self.regressors) - set(points))
        if lacking:
            raise ValueError(f"no number of points is given for {', '.join(lacking)}")
        answers = []
        for name, regressor in self.regressors.items():
            inputs = np.broadcast_arrays(*np.atleast_1d(tolerance, distance, initial_faces, points[name]))
            answers.append(np.exp(np.minimum(regressor.predict(_logs(*inputs)), 0)) * inputs[2])
        found = np.maximum(np.ceil(np.mean(answers, axis=0) - 1e-6), FEWEST)
        found = np.minimum(found, inputs[2]).astype(np.int64)
        scalar = not any(map(np.ndim, (tolerance, distance, initial_faces, *points.values())))
        return int(found[0]) if scalar else found


def fit_counts(curves, combinations, kind="network", seed=0, focal=None):
    """Counts learned from measured curves, one regressor a combination of channels (T3.1.3).

    curves: list of Curve; combinations: names of methods, of which those without a curve are left out. kind: `network`
    or `linear`. Inputs: logarithms of the tolerance in pixels, the distance, the initial faces and the points plus one;
    output: the logarithm of the share of the faces. Each measured point of a curve is seen from all of DISTANCES, with
    the tolerance that its error covers there (`tolerated_error`). Measured errors below FLOOR are left out.
    Equal seed, equal answers. Raises ValueError for an unknown kind or where no combination has a curve.
    """
    if kind not in KINDS:
        raise ValueError(f"unknown kind {kind!r}: choose one of {', '.join(KINDS)}")
    focal = focal_length() if focal is None else focal
    regressors = {}
    for name in combinations:
        lessons = [_lesson(curve, focal) for curve in curves if curve.method == name]
        inputs, shares = (np.concatenate(part) for part in zip(*lessons, strict=True)) if lessons else ((), ())
        if len(shares):
            regressors[name] = _fitted(KINDS[kind](seed), inputs, shares)
    if not regressors:
        raise ValueError(
            f"no measured curve above an error of {FLOOR:g} for any of {', '.join(combinations) or 'none'}"
        )
    return Counts(regressors, focal)


def _lesson(curve, focal):
    """(inputs (k, 4), log shares (k,)) of one curve, from all distances."""
    known = curve.errors > FLOOR
    error, distance = (grid.ravel() for grid in np.meshgrid(curve.errors[known], DISTANCES, indexing="ij"))
    faces = np.repeat(curve.faces[known], len(DISTANCES))
    initial, points = np.full(len(faces), curve.initial_faces), np.full(len(faces), curve.points)
    return _logs(error * focal / distance, distance, initial, points), np.log(faces / curve.initial_faces)


def _fitted(regressor, inputs, shares):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ConvergenceWarning)  # the limit of iterations is meant: it stops overfitting
        return regressor.fit(inputs, shares)


def _logs(tolerance, distance, initial, points):
    for name, values in (("tolerance", tolerance), ("distance", distance), ("initial_faces", initial)):
        if not np.isfinite(values).all() or (values <= 0).any():
            raise ValueError(f"{name} must be finite and above 0")
    if not np.isfinite(points).all() or (points < 0).any():
        raise ValueError("points must be finite and 0 or more")
    return np.column_stack([np.log(tolerance), np.log(distance), np.log(initial), np.log1p(points)])
