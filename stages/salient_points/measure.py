"""Measures of the salient points of an object, their agreement with people, and their files.

Agreement is measured where an object has ground truth (T3.2.3; Dutagaci 2012; Bylinskii 2019).
"""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree  # pyright: ignore[reportAttributeAccessIssue] (compiled, without a stub)

from haptic_glance.base.files import read_arrays, write_arrays
from haptic_glance.look.agreement import GroundTruth, agreement, interest_point_errors
from haptic_glance.look.points.options import Detection
from haptic_glance.mesh.mesh import Mesh
from stages.engine.rows import some_rows
from stages.weights.ground_truth import spread_on_surface
from stages.weights.training import SPREAD

SUMMARISED = ("points", "points_strong", "spread", "saliency_at_points", "nss", "auc")  # metrics that the gate checks


def mean_spacing(positions: np.ndarray) -> float:
    """Mean distance of each point (k, 3) to its nearest neighbour, in units; NaN for fewer than two points."""
    if len(positions) < 2:
        return np.nan
    return float(cKDTree(positions).query(positions, k=2)[0][:, 1].mean())


def measurement_rows(
    name: str, method: str, detection: Detection, mesh: Mesh, standard: np.ndarray | None, seconds: float
) -> list[dict]:
    """The tidy rows of one method on one object. standard (n,): the saliency at which all methods are read, or None."""
    values = {
        "points_strong": detection.strong,
        "points": len(detection.points),
        "spread": mean_spacing(mesh.vertices[detection.points]),
        "saliency_at_points": np.nan if standard is None else float(standard[detection.points].mean()),
    }
    row = {"item": name, "method": method, "seconds": seconds}
    return [row | {"metric": metric, "value": value} for metric, value in values.items()]


def summary(rows: Sequence[dict]) -> dict[str, float]:
    """Means over the objects of the SUMMARISED metrics, for the gate: dict "METHOD.METRIC" -> value, six digits."""
    table = some_rows(rows, ("method", "metric", "value"), SUMMARISED).dropna()
    means = table.groupby(["method", "metric"])["value"].mean()
    return {".".join(names): round(float(value), 6) for names, value in means.items()}  # type: ignore[arg-type]  # texts


TOLERANCES = (0.02, 0.05, 0.1)  # of the diagonal: where the errors of the points are measured
HUMAN = "human"  # the ground truth scored against itself: the best that a density of this smoothness can reach


def agreement_rows(
    mesh: Mesh, ground_truth: Mapping[str, np.ndarray], detections: Mapping[str, Detection]
) -> list[dict]:
    """Rows of metrics: cc, nss, auc, sim, kl of every method's saliency, and fne, fpe, wme of its points.

    ground_truth: arrays of stages.weights.training; detections: dict method -> Detection. A method that only places
    points gets, as its saliency, these points spread as far as the ground truth is. The errors of the points are those
    of the strong ones, at the TOLERANCES (shares of the diagonal), as metric `fne@0.05` and so on.
    """
    truth = GroundTruth(ground_truth["amounts"], ground_truth["density"], ground_truth["areas"])
    rows = [(HUMAN, name, value) for name, value in agreement(ground_truth["density"], truth).items()]
    for method, result in detections.items():
        values = _as_density(mesh, result) if result.saliency is None else result.saliency
        rows += [(method, name, value) for name, value in agreement(values, truth).items()]
        strong = result.points[: result.strong]
        errors = interest_point_errors(
            mesh, strong, ground_truth["points"], ground_truth["shares"], np.array(TOLERANCES)
        )
        rows += [
            (method, f"{error}@{tolerance}", float(value))
            for error, values in errors.items()
            for tolerance, value in zip(TOLERANCES, values, strict=True)
        ]
    return [{"method": method, "metric": metric, "value": value} for method, metric, value in rows]


def _as_density(mesh, result):
    marks = np.zeros(len(mesh.vertices))
    marks[result.points[: result.strong]] = 1
    return spread_on_surface(mesh, marks, SPREAD * mesh.diagonal)


def write_points(path: Path, detections: Mapping[str, Detection]) -> None:
    """Writes dict method -> Detection: METHOD.points, METHOD.strong and, if any, METHOD.saliency (n,) f4."""
    arrays = {}
    for method, result in detections.items():
        arrays[f"{method}.points"] = result.points.astype(np.int64)
        arrays[f"{method}.strong"] = np.int64(len(result.points) if result.strong is None else result.strong)
        if result.saliency is not None:
            arrays[f"{method}.saliency"] = result.saliency.astype(np.float32)
    write_arrays(path, **arrays)


def read_points(path: Path) -> dict[str, np.ndarray]:
    """dict method -> (k,) i8 vertex ids, most salient first."""
    return _read(path, "points")


def read_strong_points(path: Path) -> dict[str, np.ndarray]:
    """dict method -> (k',) i8: the leading ones that pass the method's own threshold (T3.2.5)."""
    strong = _read(path, "strong")
    return {method: points[: strong[method]] for method, points in read_points(path).items()}


def read_saliency(path: Path) -> dict[str, np.ndarray]:
    """dict method -> (n,) f4 in 0..1 per vertex; methods without one (random, farthest) are absent."""
    return _read(path, "saliency")


def _read(path, kind):
    arrays = read_arrays(path)
    return {key.rpartition(".")[0]: arrays[key] for key in arrays if key.endswith(f".{kind}")}
