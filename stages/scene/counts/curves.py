"""An object's own measured error curve, and the lookup in it: how many faces for a given error (T3.1.3, T3.1.5)."""

from dataclasses import dataclass

import numpy as np

TINY = 1e-12  # of the diagonal: a surface that is met exactly has an error of rounding, whose logarithm must exist


@dataclass(frozen=True, eq=False)
class Curve:
    """Measured errors of one object against face counts, with the points of one method kept.

    points: how many salient points; initial_faces: the object's own count, where the error is zero. faces (k,) i8,
    fewest first, and errors (k,) f8 over the bounding-box diagonal, falling: each is the largest error measured at that
    count or above it, so that noise of the measure never promises a mesh that a finer one did not keep to.
    """

    object: str
    method: str
    points: int
    initial_faces: int
    faces: np.ndarray
    errors: np.ndarray

    def __post_init__(self):
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

    def __len__(self):
        return len(self.faces)

    def faces_needed(self, error):
        """The fewest faces that keep to an error (k,) over the diagonal: (k,) i8, or an int for one error.

        Between measured counts a straight line in logarithms; above the largest a straight line to no error at the
        object's own count; for errors above all that were measured the smallest measured count, which is safe.
        Raises ValueError for an error that is negative or not finite.
        """
        wanted = np.asarray(error, dtype=np.float64)
        if not np.isfinite(wanted).all() or (wanted < 0).any():
            raise ValueError(f"the tolerated error must be finite and 0 or more, got {error}")
        inside = np.exp(np.interp(-np.log(np.maximum(wanted, TINY)), -np.log(self.errors), np.log(self.faces)))
        last, finest = self.faces[-1], self.errors[-1]
        beyond = last + (self.initial_faces - last) * (1 - np.minimum(wanted / finest, 1))
        found = np.ceil(np.where(wanted < finest, beyond, inside) - 1e-6).astype(np.int64)  # 1e-6: exp(log(f)) is f
        return int(found) if found.ndim == 0 else found

    def error_at(self, faces):
        """The error to expect at a count (k,): the same lines read the other way; the coarsest error below them all."""
        count = np.minimum(np.asarray(faces, dtype=np.float64), self.initial_faces)
        inside = np.exp(np.interp(np.log(np.maximum(count, 1)), np.log(self.faces), np.log(self.errors)))
        last = self.faces[-1]
        beyond = self.errors[-1] * (self.initial_faces - count) / max(self.initial_faces - last, 1)
        return np.where(count > last, beyond, inside)

    def only(self, kept):
        """The curve of some of its points, kept (k,) boolean; None where none is left."""
        if not np.any(kept):
            return None
        place = self.object, self.method, self.points, self.initial_faces
        return Curve(*place, self.faces[kept], self.errors[kept])


def read_curves(rows, initial_faces, metric="metro_mean"):
    """list[Curve] of the rows of the lod stage, one an object and method, in the order of their names.

    rows: frame with columns object, method, points, faces, metric, value. initial_faces: dict object -> face count.
    Cells without a mesh have no row of an error and are left out. Raises ValueError for columns that are missing and
    for objects whose own count is not given.
    """
    missing = {"object", "method", "points", "faces", "metric", "value"} - set(rows.columns)
    if missing:
        raise ValueError(f"rows of curves lack the columns {', '.join(sorted(missing))}")
    rows = rows[(rows["metric"] == metric) & rows["value"].notna() & rows["faces"].notna()]
    unknown = sorted(set(rows["object"]) - set(initial_faces))
    if unknown:
        raise ValueError(f"no face count is given for {', '.join(unknown[:3])}")
    return [
        Curve(name, method, int(group["points"].max()), int(initial_faces[name]), group["faces"], group["value"])
        for (name, method), group in rows.groupby(["object", "method"])
    ]
