"""The face count learned from other objects: the thesis's networks, and a linear model as alternative (T3.1.3)."""

import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from sklearn.compose import TransformedTargetRegressor
from sklearn.exceptions import ConvergenceWarning
from sklearn.linear_model import LinearRegression
from sklearn.neural_network import MLPRegressor
from sklearn.pipeline import Pipeline, make_pipeline
from sklearn.preprocessing import StandardScaler

from .curves import Curve
from .distance import focal_length

FLOOR = 1e-6  # of the diagonal: below it an error is rounding, independent of the face count
DISTANCES = (1.0, 2.0, 4.0, 8.0, 16.0, 32.0)  # in diagonals: from an object that fills the screen to one of 30 pixels
FEWEST = 4  # a tetrahedron
HIDDEN = 30  # T3.1.3, empirically determined there
DECAY = 1.0  # weight decay: from 0.01 to 10 the results differ by less than their intervals
ITERATIONS = 100  # of the quasi-Newton search: twice as many change as little


def network(seed: int) -> Pipeline:
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


def linear(seed: int) -> LinearRegression:
    """Least squares on the logarithms: a product of powers of the inputs. Deterministic, so the seed is unused."""
    return LinearRegression()


KINDS: dict[str, Callable[[int], Any]] = {"network": network, "linear": linear}

Points = ArrayLike | Mapping[str, ArrayLike]  # numbers of salient points, for all or per combination


@dataclass(frozen=True)
class Counts:
    """The model of `fit_counts`: one regressor per combination of channels, whose predictions are averaged."""

    regressors: dict[str, Any]  # scikit-learn regressors
    focal: float

    def faces_needed(
        self, tolerance: ArrayLike, distance: ArrayLike, initial_faces: ArrayLike, points: Points
    ) -> int | np.ndarray:
        """The faces that an object needs, averaged over the combinations (T3.1.3): (k,) i8, or an int for numbers.

        tolerance in pixels; distance in bounding-box diagonals of the object; initial_faces of its full mesh; points:
        the number of salient points, one for all or a dict combination -> number. All may be arrays of one length.
        Between 4 and initial_faces. Raises ValueError for values that are not finite or not above zero.
        """
        points = points if isinstance(points, Mapping) else dict.fromkeys(self.regressors, points)
        missing = sorted(set(self.regressors) - set(points))
        if missing:
            raise ValueError(f"no number of points is given for {', '.join(missing)}")
        predictions, full = [], np.atleast_1d(initial_faces)
        for name, regressor in self.regressors.items():
            inputs = np.broadcast_arrays(*np.atleast_1d(tolerance, distance, initial_faces, points[name]))
            predictions.append(np.exp(np.minimum(regressor.predict(_logs(*inputs)), 0)) * inputs[2])
        found = np.maximum(np.ceil(np.mean(predictions, axis=0) - 1e-6), FEWEST)
        found = np.minimum(found, full).astype(np.int64)
        scalar = not any(map(np.ndim, (tolerance, distance, initial_faces, *points.values())))
        return int(found[0]) if scalar else found


def fit_counts(
    curves: Sequence[Curve], combinations: Sequence[str], kind: str = "network", seed: int = 0,
    focal: float | None = None,
) -> Counts:  # fmt: skip
    """Counts learned from measured curves, one regressor per combination of channels (T3.1.3).

    combinations: names of methods, of which those without a curve are left out. kind: `network` or `linear`. Inputs:
    logarithms of the tolerance in pixels, the distance, the initial faces and the points plus one; output: the
    logarithm of the share of the faces. Each measured point of a curve is used at all of DISTANCES, with the tolerance
    of its error there. Measured errors below FLOOR are left out. Equal seeds give equal models.
    Raises ValueError for an unknown kind or where no combination has a curve.
    """
    if kind not in KINDS:
        raise ValueError(f"unknown kind {kind!r}: choose one of {', '.join(KINDS)}")
    focal = focal_length() if focal is None else focal
    regressors = {}
    for name in combinations:
        examples = [_examples(curve, focal) for curve in curves if curve.method == name]
        if sum(len(shares) for _, shares in examples):
            inputs, shares = (np.concatenate(part) for part in zip(*examples, strict=True))
            regressors[name] = _fitted(KINDS[kind](seed), inputs, shares)
    if not regressors:
        raise ValueError(
            f"no measured curve above an error of {FLOOR:g} for any of {', '.join(combinations) or 'none'}"
        )
    return Counts(regressors, focal)


def _examples(curve, focal):
    """(inputs (k, 4), log shares (k,)) of one curve, at all distances."""
    used = curve.errors > FLOOR
    error, distance = (grid.ravel() for grid in np.meshgrid(curve.errors[used], DISTANCES, indexing="ij"))
    faces = np.repeat(curve.faces[used], len(DISTANCES))
    initial, points = np.full(len(faces), curve.initial_faces), np.full(len(faces), curve.points)
    return _logs(error * focal / distance, distance, initial, points), np.log(faces / curve.initial_faces)


def _fitted(regressor, inputs, shares):
    with warnings.catch_warnings():
        warnings.simplefilter(
            "ignore", ConvergenceWarning
        )  # the limit of iterations is intended: it prevents overfitting
        return regressor.fit(inputs, shares)


def _logs(tolerance, distance, initial, points):
    for name, values in (("tolerance", tolerance), ("distance", distance), ("initial_faces", initial)):
        if not np.isfinite(values).all() or (values <= 0).any():
            raise ValueError(f"{name} must be finite and above 0")
    if not np.isfinite(points).all() or (points < 0).any():
        raise ValueError("points must be finite and 0 or more")
    return np.column_stack([np.log(tolerance), np.log(distance), np.log(initial), np.log1p(points)])
