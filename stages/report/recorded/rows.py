"""Rows of the stage recorded_networks, for the table and the chart of networks on recorded touches."""

from contextlib import suppress

import numpy as np
import pandas as pd

from haptic_glance.know.split import Split, shared_by
from stages.engine.statistics import interval
from stages.report.networks import of_passes
from stages.report.results import NotRun, Results
from stages.report.tables import everywhere, grouped, within

STAGE = "recorded_networks"
DATA = {
    "pressure": "pressure array, 22 objects",
    "grasps_object": "fingertips, which of 51 objects",
    "grasps_slip": "fingertips, slips or not",
    "vt60": "VT-60 (BathTip)",
    "vitac": "ViTac (GelSight)",
    "bigs": "BiGS (Barrett hand)",
    "bigs_instant": "BiGS, one reading of 7 x 3 cells",
    "schunk": "hand with arrays, 5 objects, 294 readings as one picture",
    "schunk_instant": "hand with arrays, 5 objects, one reading of 27 x 6 cells",
    "schunk_coarse": "hand with arrays, 5 objects, one reading of 7 x 3 cells",
}
SPLITS = {
    Split.RANDOM: "touches at random",
    Split.BLOCKS: "neighbouring touches together",
    Split.TEST_OBJECTS: "objects kept for the test",
    Split.OBJECTS: "objects or recordings together",
}
OVER = (Split.TEST_OBJECTS,)  # splits whose values are of independent objects, not of repetitions
KEYS = ["data", "split", "method", "weights", "mode", "size"]
GAINS = [f"over_{control}{end}" for control in ("features", "random") for end in ("", "_low", "_high", "_pairs")]
VALUES = ["accuracy", "low", "high", "values", *GAINS, "guess"]
CLASSICAL = ("features_knn", "", "", "")  # the control without a network: neither weights, nor mode, nor size


def measured(results: Results, *metrics: str) -> pd.DataFrame:
    """Rows of some metrics that have a value after the printed passes, of all recorded data sets; "" where KEYS lack.

    unit: the repetition, whose number is the same split for all, or the object where OVER. NotRun without any.
    """
    message = f"no {' or '.join(metrics)} of networks on recorded touches"
    by_set = everywhere(results, STAGE, message, metric=list(metrics))
    rows = of_passes(pd.concat(by_set.values(), ignore_index=True)).astype({"size": "Int64"})
    rows = rows[rows["item"].notna() == rows["split"].isin(OVER)].astype(dict.fromkeys(["item", *KEYS], object))
    return rows.fillna(dict.fromkeys(KEYS, "")).assign(unit=rows["item"].fillna(rows["repetition"]))


def measured_lines(results: Results) -> pd.DataFrame:
    """A frame with a row a data set, split, network, start, mode and size that was measured, the classical first.

    accuracy with low and high over so many values; guess; over_features and over_random: the gain over the classical
    features and over the same network untrained, each with _low, _high and the number of _pairs.
    """
    rows, guess, lines = measured(results, "accuracy"), _guesses(results), []
    groups = {key: values.groupby("unit")["value"].mean() for key, values in grouped(rows, KEYS)}
    for key, values in groups.items():
        data, split, method, _, mode, size = key
        shared = 0.0 if split in OVER else shared_by(Split.RANDOM)
        line = [*key, *within(values, shared), len(values)]
        for control in (data, split, *CLASSICAL), (data, split, method, "random", mode, size):
            gains = (values - groups[control]).dropna() if control in groups and control != key else values[:0]
            line += [*interval(gains, shared), len(gains)]
        lines.append([*line, guess.get((data, split), np.nan)])
    frame = pd.DataFrame(lines, columns=[*KEYS, *VALUES]).join(rows.groupby(KEYS)["pretrained"].first(), on=KEYS)
    order = {name: k for k, name in enumerate([*DATA, *SPLITS, CLASSICAL[0]])}
    sort_options = {"by": ["data", "split", "method"], "key": lambda names: names.map(order).fillna(len(order))}
    return frame.sort_values(**sort_options, kind="stable", ignore_index=True)


def commonest(results: Results) -> pd.Series:
    """Share of right answers by object kept for the test, where the answer is always the commonest in training."""
    where = {"task": "slip", "split": Split.TEST_OBJECTS, "palm": "all", "scaled": "training"}
    rows = results.measured("recorded", "biotac_grasps", **where, classifier="majority", metric="accuracy")
    return rows.groupby("item")["value"].mean()


def _guesses(results: Results) -> dict[tuple[str, str], float]:
    """{(data, split): share that guessing gets right}: any class, or always the commonest, the better on average."""
    shares = {}
    with suppress(NotRun):
        rows = measured(results, "chance", "majority")
        means = rows.groupby(["data", "split", "metric", "unit"])["value"].mean().groupby(level=[0, 1, 2]).mean()
        shares |= means.groupby(level=[0, 1]).max().to_dict()
    with suppress(NotRun):  # which another stage has object by object
        shares["grasps_slip", Split.TEST_OBJECTS] = commonest(results).mean()
    return shares
