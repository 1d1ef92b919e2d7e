"""An object's own measured error curve, and the lookup of face counts for an error in it (T3.1.3, T3.1.5)."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import cast

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

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
