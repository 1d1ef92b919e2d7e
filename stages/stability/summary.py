"""The numbers of a run that the gate checks: repeatability, breaking points, outcomes on broken meshes."""

from collections import Counter
from collections.abc import Sequence
from typing import cast

import numpy as np
import pandas as pd

from stages.kit.breaking_point import breaking_interval, breaking_point
from stages.kit.units import unit

from .perturbations import PERTURBATIONS
from .simplification import OUTCOMES, SMALLEST

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
    found = {}
    for key, own in rows[rows["metric"] == "repeatability"].groupby(["perturbation", "method"], sort=False):
        perturbation, method = cast(tuple[str, str], key)
        wide = own.assign(unit=own["item"].map(unit)).pivot_table(
            index="unit", columns="severity", values="value", sort=False
        )
        severities = [one for one in dict.fromkeys(own["severity"]) if one in wide.columns]
        if severities:
            curves = wide[severities].to_numpy()
            found[perturbation, method] = breaking_interval(severities, curves, PERTURBATIONS[perturbation].unharmed)
    return found


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


def summarise_simplification(rows: Sequence[dict]) -> dict[str, dict]:
    """Numbers for the gate, per backend: the share of its cases by outcome, and of the smallest counts that were met.

    Crashes are counted: none is allowed on any machine.
    """
    rows, found = [row for row in rows if row["metric"] == "faces"], {}
    for backend in dict.fromkeys(row["method"] for row in rows):
        cases = [row for row in rows if row["method"] == backend]
        outcomes = Counter(row["outcome"] for row in cases)
        met = [row["outcome"] == "valid" for row in cases if row["budget"] == SMALLEST]
        found[backend] = {outcome: round(outcomes[outcome] / len(cases), 6) for outcome in OUTCOMES[:-1]}
        found[backend]["smallest_had"] = round(sum(met) / len(met), 6) if met else None
        found[backend]["crashes"] = outcomes[OUTCOMES[-1]]
    return found


def _curves(rows):
    """(perturbation, method, severities, mean repeatabilities) of each perturbation and method."""
    for key, group in mean_repeatability(rows).groupby(["perturbation", "method"], sort=False):
        perturbation, method = cast(tuple[str, str], key)
        yield perturbation, method, list(group["severity"]), list(group["value"])


def _rounded(values):
    """Values rounded to six digits; NaN (never broken, or never measured) becomes None, which the gate ignores."""
    return {key: round(value, 6) if np.isfinite(value) else None for key, value in values.items()}
