"""Scores of predicted counts: the error of the count and of the mesh, with intervals over the objects."""

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd

from haptic_glance.base.rng import rng

from .cases import Case

RESAMPLES = 400  # of the objects, with all their cases: the interval's ends are then within a tenth of its width


def score_counts(cases: Sequence[Case], counts: np.ndarray) -> pd.DataFrame:
    """Frame with one row per case: object, ratio (count / needed), error (over the tolerance), within (tolerance met).

    The error is read from the object's whole measured curve. For a count below all measured ones it is that of the
    coarsest mesh, which is too low: the case still does not meet the tolerance.
    """
    rows = []
    for case, count in zip(cases, counts, strict=True):
        error = float(case.curve.error_at(count)) / case.error
        rows.append({"object": case.curve.object, "ratio": count / case.needed, "error": error})
    frame = pd.DataFrame(rows, columns=["object", "ratio", "error"])
    return frame.assign(within=frame["ratio"] >= 1)


def summarise(frame: pd.DataFrame, seed: int) -> dict[str, tuple[float, float, float]]:
    """dict metric -> (value, low, high): over the cases of a frame of `score_counts`, 95 % bootstrap over its objects.

    count_bias: geometric mean of count / needed. factor_median, factor_90: the factor, up or down, within which half
    and 90 % of the counts are. within: share of cases within the tolerance. excess: error over the tolerance, minus
    one, median of the cases beyond it, NaN where there is none. waste: mean of the excess faces over the needed ones.
    """
    groups = [group for _, group in frame.groupby("object")]
    values = _metrics(frame)
    draw = rng(seed, "objects resampled")
    columns = {name: [group[name].to_numpy() for group in groups] for name in ("ratio", "error", "within")}
    resampled = []
    for _ in range(RESAMPLES if len(groups) > 1 else 0):
        picks = draw.integers(len(groups), size=len(groups))
        resampled.append(_metrics({name: np.concatenate([parts[k] for k in picks]) for name, parts in columns.items()}))
    found = {}
    for name, value in values.items():
        spread = [each[name] for each in resampled if np.isfinite(each[name])]
        low, high = np.quantile(spread, [0.025, 0.975]) if spread else (np.nan, np.nan)
        found[name] = (float(value), float(low), float(high))
    return found


def _metrics(cases: Mapping | pd.DataFrame) -> dict[str, float]:
    ratio, error, within = (np.asarray(cases[name]) for name in ("ratio", "error", "within"))
    factor = np.exp(np.abs(np.log(ratio)))
    return {
        "count_bias": np.exp(np.log(ratio).mean()),
        "factor_median": np.median(factor),
        "factor_90": np.quantile(factor, 0.9),
        "within": within.mean(),
        "excess": np.median(error[~within]) - 1 if not within.all() else np.nan,
        "waste": np.maximum(ratio - 1, 0).mean(),
    }
