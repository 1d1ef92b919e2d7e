"""The severity at which a method loses half of its points, and the numbers of the gate."""

from __future__ import annotations

from collections.abc import Sequence
from typing import cast

import numpy as np

from haptic_glance.base.lazy import pandas as pd
from haptic_glance.disturb.objects import PERTURBATIONS
from stages.engine.rows import unit
from stages.engine.statistics import breaking_interval, breaking_point

KEYS = ["perturbation", "method", "severity"]


def middle_severity(severities: Sequence[float]) -> float:
    """The severity in the middle of a list, the milder of two: harsh enough to separate the methods."""
    return severities[(len(severities) - 1) // 2]


def mean_repeatability(rows: Sequence[dict] | pd.DataFrame) -> pd.DataFrame:
    """Frame of perturbation, method, severity and value, the mean over the objects, in the order of the rows."""
    table = pd.DataFrame(rows)
    table = table.loc[table["metric"] == "repeatability", [*KEYS, "value"]].astype({"value": float})
    return table.groupby(KEYS, sort=False, as_index=False).mean()


def breaking_points(rows: pd.DataFrame) -> dict[tuple[str, str], tuple[float, float, float]]:
    """dict (perturbation, method) -> the severity at which the mean repeatability falls below one half, and its ends.

    The interval is over the units of the objects, see `breaking_interval`; NaN is beyond the harshest severity. Also
    NaN where a severity before it has no value at all.
    """
    points = {}
    for key, part in rows[rows["metric"] == "repeatability"].groupby(["perturbation", "method"], sort=False):
        perturbation, method = cast(tuple[str, str], key)
        wide = part.assign(unit=part["item"].map(unit)).pivot_table(
            index="unit", columns="severity", values="value", sort=False
        )
        severities = [severity for severity in dict.fromkeys(part["severity"]) if severity in wide.columns]
        if severities:
            curves = wide[severities].to_numpy()
            points[perturbation, method] = breaking_interval(severities, curves, PERTURBATIONS[perturbation].unharmed)
    return points


def summarise(rows: Sequence[dict]) -> dict[str, dict]:
    """Numbers for the gate: `repeatability`, of each PERTURBATION.METHOD at the middle severity; `breaking_point`."""
    means = {
        f"{perturbation}.{method}": values[severities.index(middle_severity(severities))]
        for perturbation, method, severities, values in _curves(rows)
    }
    breaks = {
        f"{perturbation}.{method}": breaking_point(severities, values, PERTURBATIONS[perturbation].unharmed)
        for perturbation, method, severities, values in _curves(rows)
    }
    return {"repeatability": _rounded(means), "breaking_point": _rounded(breaks)}


def _curves(rows):
    """(perturbation, method, severities, mean repeatabilities) of each perturbation and method."""
    for key, group in mean_repeatability(rows).groupby(["perturbation", "method"], sort=False):
        perturbation, method = cast(tuple[str, str], key)
        yield perturbation, method, list(group["severity"]), list(group["value"])


def _rounded(values):
    """Values rounded to six digits; NaN (never broken, or never measured) becomes None, which the gate ignores."""
    return {key: round(value, 6) if np.isfinite(value) else None for key, value in values.items()}
