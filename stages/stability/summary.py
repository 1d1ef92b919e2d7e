"""The few numbers of a run that the gate looks at: repeatability, breaking points, what became of broken meshes."""

import numpy as np
import pandas as pd

from .measures import breaking_point
from .perturbations import PERTURBATIONS
from .simplification import OUTCOMES, SMALLEST


def middle(severities):
    """The severity in the middle of a list, the milder one of two: harsh enough to tell methods apart."""
    return severities[(len(severities) - 1) // 2]


def mean_repeatability(rows):
    """Frame with columns perturbation, method, severity, value: the mean over the objects, in the rows' own order."""
    table = pd.DataFrame(rows)
    table = table[(table["metric"] == "repeatability")].assign(value=lambda frame: frame["value"].astype(float))
    return table.groupby(["perturbation", "method", "severity"], sort=False)["value"].mean().reset_index()


def breaking_points(rows):
    """dict (perturbation, method) -> the severity at which the mean repeatability falls below one half, or NaN.

    Also NaN where a severity has no value at all before that.
    """
    found = {}
    for (perturbation, method), group in mean_repeatability(rows).groupby(["perturbation", "method"], sort=False):
        unharmed = PERTURBATIONS[perturbation].unharmed
        found[perturbation, method] = breaking_point(list(group["severity"]), list(group["value"]), unharmed)
    return found


def summarise(rows):
    """Numbers for the gate: `repeatability`, of each PERTURBATION.METHOD at the middle severity; `breaking_point`."""
    means = mean_repeatability(rows)
    mids = {}
    for (perturbation, method), group in means.groupby(["perturbation", "method"], sort=False):
        at = middle(list(group["severity"]))
        mids[f"{perturbation}.{method}"] = float(group.loc[group["severity"] == at, "value"].iloc[0])
    breaks = {f"{perturbation}.{method}": value for (perturbation, method), value in breaking_points(rows).items()}
    return {"repeatability": _known(mids), "breaking_point": _known(breaks)}


def summarise_simplification(rows):
    """Numbers for the gate, of each backend: shares of its cases by outcome, and of the smallest counts that were had.

    Crashes are a count: none is allowed, on any machine.
    """
    rows, found = [row for row in rows if row["metric"] == "faces"], {}
    for backend in dict.fromkeys(row["method"] for row in rows):
        cases = pd.DataFrame([row for row in rows if row["method"] == backend])
        shares = {outcome: round(float((cases["outcome"] == outcome).mean()), 6) for outcome in OUTCOMES[:-1]}
        least = cases.loc[cases["budget"] == SMALLEST, "outcome"] == "valid"
        found[backend] = shares | {"smallest_had": round(float(least.mean()), 6) if len(least) else None}
        found[backend]["crashes"] = int((cases["outcome"] == OUTCOMES[-1]).sum())
    return found


def _known(values):
    """Rounded to six digits; what is NaN (never broke, or never measured) is None, which the gate passes over."""
    return {key: round(value, 6) if np.isfinite(value) else None for key, value in values.items()}
