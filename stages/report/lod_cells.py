"""The errors of simplified meshes, compared on the same objects only: kept points put some targets out of reach."""

import pandas as pd

CELL = ["object", "target"]
PLAIN = "qem"


def cells(results, metrics):
    """Measured rows of the lod stage with these metrics.

    `seconds` is the simplification's; `plain` the value of plain QEM for the same object, target and metric.
    """
    rows = results.measurements("lod", metric=metrics).dropna(subset=["value"]).drop(columns="seconds")
    made = results.measurements("lod", metric="faces").dropna(subset=["value"])
    rows = rows.merge(made[[*CELL, "method", "seconds"]], on=[*CELL, "method"])
    plain = rows.loc[rows["method"] == PLAIN, [*CELL, "metric", "value"]].rename(columns={"value": "plain"})
    return rows.merge(plain, on=[*CELL, "metric"], how="left").astype({"target": str})


def paired_cells(results, metrics, methods):
    """As `cells`, of those of the methods that were run, only where all of them reach the target of the object."""
    rows = cells(results, metrics)
    rows = rows[rows["method"].isin(methods)]
    reached = rows.groupby(CELL)["method"].nunique()
    everywhere = reached.index[reached == rows["method"].nunique()]
    return rows[pd.MultiIndex.from_frame(rows[CELL]).isin(everywhere)]
