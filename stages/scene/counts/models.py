"""Models that predict the fewest faces of an object for an error (T3.1.3, T3.1.5).

An object's own measured curve answers by lookup. The thesis's networks, and a linear model as the alternative, learn
from other objects. The thesis determined its distances by moving each object away in VRML until features seemed to
disappear (T3.1.3). Here the distance follows from the screen by perspective: an error on the surface is tolerated up to
a number of pixels.
"""

import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, cast

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike
from sklearn.compose import TransformedTargetRegressor
from sklearn.exceptions import ConvergenceWarning
from sklearn.linear_model import LinearRegression
from sklearn.neural_network import MLPRegressor
from sklearn.pipeline import Pipeline, make_pipeline
from sklearn.preprocessing import StandardScaler

TINY = 1e-12  # of the diagonal: an exact surface has a rounding error, whose logarithm must exist


@dataclass(frozen=True, eq=False)
class Curve:
    """Measured errors of one object against face counts, with the points of one method kept.

    points: how many salient points; initial_faces: the object's own count, where the error is zero. faces (k,) i8,
    fewest first, and errors (k,) f8 over the bounding-box diagonal, decreasing: each is the largest error measured at
    that count or a higher one, so that noise never suggests a mesh coarser than one that exceeded the error.
    """

    object: str
    method: str
    points: int
    initial_faces: int
    faces: np.ndarray
    errors: np.ndarray

    def __post_init__(self) -> None:
        faces, first = np.unique(np.asarray(self.faces, dtype=np.int64), return_index=True)
        errors = np.asarray(self.errors, dtype=np.float64)[first]
        if len(faces) == 0 or faces[0] < 1 or faces[-1] > self.initial_faces:
            raise ValueError(
                f"{self.object}: a curve needs counts from 1 to {self.initial_faces}, got {faces.tolist()}"
            )
        if not np.isfinite(errors).all() or errors.min() < 0:
            raise ValueError(f"{self.object}: errors must be finite and 0 or more, got {errors.tolist()}")
        errors = np.maximum.accumulate(np.maximum(errors, TINY)[::-1])[::-1]
        object.__setattr__(self, "faces", faces)
        object.__setattr__(self, "errors", errors)

    def __len__(self) -> int:
        return len(self.faces)

    def faces_needed(self, error: ArrayLike) -> int | np.ndarray:
        """The fewest faces with at most an error (k,) over the diagonal: (k,) i8, or an int for one error.

        Between measured counts linear in the logarithms; above the largest, linear down to no error at the object's own
        count; for errors above all measured ones the lowest measured count, which is safe.
        Raises ValueError for an error that is negative or not finite.
        """
        target = np.asarray(error, dtype=np.float64)
        if not np.isfinite(target).all() or (target < 0).any():
            raise ValueError(f"the tolerated error must be finite and 0 or more, got {error}")
        inside = np.exp(np.interp(-np.log(np.maximum(target, TINY)), -np.log(self.errors), np.log(self.faces)))
        last, finest = self.faces[-1], self.errors[-1]
        beyond = last + (self.initial_faces - last) * (1 - np.minimum(target / finest, 1))
        found = np.ceil(np.where(target < finest, beyond, inside) - 1e-6).astype(np.int64)  # 1e-6: exp(log(f)) is f
        return int(found) if found.ndim == 0 else found

    def error_at(self, faces: ArrayLike) -> np.ndarray:
        """The expected error at a count (k,), by the inverse function; below all counts the coarsest mesh's error."""
        count = np.minimum(np.asarray(faces, dtype=np.float64), self.initial_faces)
        inside = np.exp(np.interp(np.log(np.maximum(count, 1)), np.log(self.faces), np.log(self.errors)))
        last = self.faces[-1]
        beyond = self.errors[-1] * (self.initial_faces - count) / max(self.initial_faces - last, 1)
        return np.where(count > last, beyond, inside)

    def only(self, kept: np.ndarray) -> "Curve | None":
        """The curve of some of its points, kept (k,) boolean; None where none is left."""
        if not np.any(kept):
            return None
        place = self.object, self.method, self.points, self.initial_faces
        return Curve(*place, self.faces[kept], self.errors[kept])


def read_curves(rows: pd.DataFrame, initial_faces: Mapping[str, int], metric: str = "metro_mean") -> list[Curve]:
    """The curves in the rows of the lod stage, one per object and method, in the order of their names.

    rows: frame with columns item, method, points, faces, metric, value. initial_faces: dict object -> face count.
    Cells without a mesh are left out. Raises ValueError for missing columns and for objects without a face count.
    """
    missing = {"item", "method", "points", "faces", "metric", "value"} - set(rows.columns)
    if missing:
        raise ValueError(f"rows of curves lack the columns {', '.join(sorted(missing))}")
    rows = pd.DataFrame(rows[(rows["metric"] == metric) & rows["value"].notna() & rows["faces"].notna()])
    unknown = sorted(set(rows["item"]) - set(initial_faces))
    if unknown:
        raise ValueError(f"no face count is given for {', '.join(unknown[:3])}")
    curves = []
    for key, group in rows.groupby(["item", "method"]):
        name, method = cast(tuple[str, str], key)
        points, faces, errors = (group[column].to_numpy() for column in ("points", "faces", "value"))
        curves.append(Curve(name, method, int(points.max()), int(initial_faces[name]), faces, errors))
    return curves


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


ROWS, VIEW_ANGLE = 1080, 60.0  # a full-HD screen and a common view angle over its rows, in degrees


def focal_length(rows: int = ROWS, view_angle: float = VIEW_ANGLE) -> float:
    """The focal length in pixels, rows / (2 tan(view_angle / 2)): the size on the screen of one unit at distance one.

    Raises ValueError for fewer than one row or an angle outside 0 to 180 degrees.
    """
    if rows < 1 or not 0 < view_angle < 180:
        raise ValueError(f"a screen cannot have {rows} rows and a view angle of {view_angle} degrees")
    return float(rows / (2 * np.tan(np.radians(view_angle) / 2)))
