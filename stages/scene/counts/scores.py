"""What answers are worth: the error of the count and the quality that follows, with intervals over the objects."""

import numpy as np
import pandas as pd

from stages.kit.rng import rng

RESAMPLES = 400  # of the objects, with all their cases: the interval's ends are then known to a tenth of its width


def scored(cases, found):
    """Frame of a row a case: object, ratio (count / needed), error (error there / tolerance), within (kept to it).

    The error is read from the object's whole measured curve. Where the count lies below all that were measured it is
    that of the coarsest mesh, which is too small: the case still counts as broken.
    """
    rows = []
    for case, count in zip(cases, found, strict=True):
        error = float(case.curve.error_at(count)) / case.error
        rows.append({"object": case.curve.object, "ratio": count / case.needed, "error": error})
    frame = pd.DataFrame(rows, columns=["object", "ratio", "error"])
    return frame.assign(within=frame["ratio"] >= 1)


def summarise(frame, seed):
    """dict metric -> (value, low, high): over the cases of a frame of `scored`, 95 % bootstrap over its objects.

    count_bias: geometric mean of count / needed. factor_median, factor_90: the factor, either way, that half and 90 %
    of the counts stay within. within: share of cases within the tolerance. excess: error over the tolerance, less one,
    median of those that break it, NaN where none does. waste: faces beyond the needed ones over the needed ones, mean.
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


def _metrics(cases):
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
