"""What is measured of a set of points."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from scipy.spatial import cKDTree  # pyright: ignore[reportAttributeAccessIssue] (compiled, without a stub)

from haptic_glance.look.points.options import Detection
from haptic_glance.mesh.mesh import Mesh
from stages.kit.rows import some_rows

SUMMARISED = ("points", "points_strong", "spread", "saliency_at_points", "nss", "auc")  # metrics that the gate checks


def mean_spacing(positions: np.ndarray) -> float:
    """Mean distance of each point (k, 3) to its nearest neighbour, in units; NaN for fewer than two points."""
    if len(positions) < 2:
        return np.nan
    return float(cKDTree(positions).query(positions, k=2)[0][:, 1].mean())


def measurement_rows(
    name: str, method: str, found: Detection, mesh: Mesh, standard: np.ndarray | None, seconds: float
) -> list[dict]:
    """The tidy rows of one method on one object. standard (n,): the saliency at which all methods are read, or None."""
    values = {
        "points_strong": found.strong,
        "points": len(found.points),
        "spread": mean_spacing(mesh.vertices[found.points]),
        "saliency_at_points": np.nan if standard is None else float(standard[found.points].mean()),
    }
    row = {"item": name, "method": method, "seconds": seconds}
    return [row | {"metric": metric, "value": value} for metric, value in values.items()]


def summary(rows: Sequence[dict]) -> dict[str, float]:
    """Means over the objects of the SUMMARISED metrics, for the gate: dict "METHOD.METRIC" -> value, six digits."""
    table = some_rows(rows, ("method", "metric", "value"), SUMMARISED).dropna()
    means = pd.DataFrame(table.groupby(["method", "metric"])["value"].mean()).reset_index()
    return {f"{method}.{metric}": round(float(value), 6) for method, metric, value in means.itertuples(index=False)}
