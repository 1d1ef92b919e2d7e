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
        errors = np.maximum.accumulate(np.maximum(errors, TINY)[::-1])[::-1]
        object.__setattr__(self, "faces", faces)
        object.__setattr__(self, "errors", errors)

    def __len__(self) -> int:
        return len(self.faces)

    def faces_needed(self, error: ArrayLike) -> np.ndarray:
        """The fewest faces with at most an error (k,) over the diagonal: (k,) i8.

        Between measured counts linear in the logarithms; above the largest, linear down to no error at the object's own
        count; for errors above all measured ones the lowest measured count, which is safe.
        """
        target = np.asarray(error, dtype=np.float64)
        inside = np.exp(np.interp(-np.log(np.maximum(target, TINY)), -np.log(self.errors), np.log(self.faces)))
        last, finest = self.faces[-1], self.errors[-1]
        beyond = last + (self.initial_faces - last) * (1 - np.minimum(target / finest, 1))
        return np.ceil(np.where(target < finest, beyond, inside) - 1e-6).astype(np.int64)  # 1e-6: exp(log(f)) is f

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


def read_curves(rows: pd.DataFrame, initial_faces: Mapping[str, int]) -> list[Curve]:
    """The curves of Metro's mean error in the rows of the lod stage, by object and method, in the order of their names.

    initial_faces: dict object -> face count. Cells without a mesh are left out.
    """
    rows = pd.DataFrame(rows[(rows["metric"] == "metro_mean") & rows["value"].notna() & rows["faces"].notna()])
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
FOCAL = float(1080 / (2 * np.tan(np.radians(60) / 2)))  # pixels: a full-HD screen with a view angle of 60 degrees


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


@dataclass(frozen=True)
class Counts:
    """The model of `fit_counts`: one regressor per combination of channels, whose predictions are averaged."""

    regressors: dict[str, Any]  # scikit-learn regressors

    def faces_needed(
        self, tolerance: ArrayLike, distance: ArrayLike, initial_faces: ArrayLike, points: Mapping[str, ArrayLike]
    ) -> np.ndarray:
        """(k,) i8 faces that an object needs, averaged over the combinations (T3.1.3): 4 to initial_faces.

        tolerance in pixels; distance in bounding-box diagonals of the object; initial_faces of its full mesh; points:
        dict combination -> number of salient points. All may be arrays of one length.
        """
        predictions = []
        for name, regressor in self.regressors.items():
            inputs = np.broadcast_arrays(*np.atleast_1d(tolerance, distance, initial_faces, points[name]))
            predictions.append(np.exp(np.minimum(regressor.predict(_logs(*inputs)), 0)) * inputs[2])
        counts = np.maximum(np.ceil(np.mean(predictions, axis=0) - 1e-6), FEWEST)
        return np.minimum(counts, np.atleast_1d(initial_faces)).astype(np.int64)


def fit_counts(
    curves: Sequence[Curve], combinations: Sequence[str], kind: str, seed: int, focal: float = FOCAL
) -> Counts:
    """Counts learned from measured curves, one regressor per combination of channels (T3.1.3).

    combinations: names of methods, of which those without a curve are left out. kind: `network` or `linear`. Inputs:
    logarithms of the tolerance in pixels, the distance, the initial faces and the points plus one; output: the
    logarithm of the share of the faces. Each measured point of a curve is used at all of DISTANCES, with the tolerance
    of its error there. Measured errors below FLOOR are left out. Equal seeds give equal models. focal: in pixels.
    Raises ValueError where no combination has a curve.
    """
    regressors = {}
    for name in combinations:
        examples = [_examples(curve, focal) for curve in curves if curve.method == name]
        if sum(len(shares) for _, shares in examples):
            inputs, shares = (np.concatenate(part) for part in zip(*examples, strict=True))
            with warnings.catch_warnings():  # the limit of iterations is intended: it prevents overfitting
                warnings.simplefilter("ignore", ConvergenceWarning)
                regressors[name] = KINDS[kind](seed).fit(inputs, shares)
    if not regressors:
        raise ValueError(
            f"no measured curve above an error of {FLOOR:g} for any of {', '.join(combinations) or 'none'}"
        )
    return Counts(regressors)


def _examples(curve, focal):
    """(inputs (k, 4), log shares (k,)) of one curve, at all distances."""
    above_floor = curve.errors > FLOOR
    error, distance = (grid.ravel() for grid in np.meshgrid(curve.errors[above_floor], DISTANCES, indexing="ij"))
    faces = np.repeat(curve.faces[above_floor], len(DISTANCES))
    initial, points = np.full(len(faces), curve.initial_faces), np.full(len(faces), curve.points)
    return _logs(error * focal / distance, distance, initial, points), np.log(faces / curve.initial_faces)


def _logs(tolerance, distance, initial, points):
    return np.column_stack([np.log(tolerance), np.log(distance), np.log(initial), np.log1p(points)])
