"""What is measured of a set of points."""

import numpy as np
import pandas as pd
from scipy.spatial import cKDTree

HELD = ("points", "points_strong", "spread", "saliency_at_points", "nss", "auc")


def spread(positions):
    """Mean distance of each point (k, 3) to its nearest neighbour, in units; NaN for fewer than two points."""
    if len(positions) < 2:
        return np.nan
    return float(cKDTree(positions).query(positions, k=2)[0][:, 1].mean())


def rows_of(name, method, found, mesh, judge, seconds):
    """The tidy rows of one method on one object. judge (n,): the saliency that all methods are read on, or None."""
    values = {
        "points_strong": found.strong,
        "points": len(found.points),
        "spread": spread(mesh.vertices[found.points]),
        "saliency_at_points": np.nan if judge is None else float(judge[found.points].mean()),
    }
    row = {"object": name, "method": method, "seconds": seconds}
    return [row | {"metric": metric, "value": value} for metric, value in values.items()]


def summary(rows):
    """Means over the objects of the HELD metrics, for the gate: dict "METHOD.METRIC" -> value, six digits."""
    table = pd.DataFrame(rows, columns=["method", "metric", "value"])
    means = table[table.metric.isin(HELD)].dropna().groupby(["method", "metric"])["value"].mean()
    return {f"{method}.{metric}": round(float(value), 6) for (method, metric), value in means.items()}
