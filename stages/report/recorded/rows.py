"""What the table and the chart of networks on recorded touches read: rows of the stage recorded_networks."""

from contextlib import suppress

import numpy as np
import pandas as pd

from stages.kit.split import Split, shared_by
from stages.kit.stats import interval
from stages.report.grid import within
from stages.report.results import NotRun, Results

STAGE = "recorded_networks"
DATA = {
    "pressure": "pressure array, 22 objects",
    "grasps_object": "fingertips, which of 51 objects",
    "grasps_slip": "fingertips, slips or not",
    "vt60": "VT-60 (BathTip)",
    "vitac": "ViTac (GelSight)",
    "bigs": "BiGS (Barrett hand)",
}
SPLITS = {
    Split.RANDOM: "touches at random",
    Split.BLOCKS: "neighbouring touches together",
    Split.TEST_OBJECTS: "objects kept for the test",
    Split.OBJECTS: "objects or recordings together",
}
OVER = (Split.TEST_OBJECTS,)  # splits whose values are of independent objects, not of repetitions
KEYS = ["data", "split", "method", "weights", "mode", "size"]
CLASSICAL = ("features_knn", "", "", "")  # the control without a network: neither weights, nor mode, nor size


def measured(results: Results, *metrics: str) -> pd.DataFrame:
    """Rows of some metrics that have a value, of all recorded data sets; NotRun without any.

    What a row has not of KEYS, such as weights, is "". unit: the repetition, whose number is the same split for all, or
    the object where OVER.
    """
    found = []
    for dataset in results.datasets(STAGE):
        with suppress(NotRun):
            found.append(results.measured(STAGE, dataset, metric=list(metrics)))
    if not found:
        raise NotRun(f"no {' or '.join(metrics)} of networks on recorded touches", STAGE)
    rows = pd.concat(found, ignore_index=True).astype({"size": "Int64"})
    rows = rows[rows["item"].notna() == rows["split"].isin(OVER)]
    unit = rows["item"].astype(object).where(rows["item"].notna(), rows["repetition"])
    return rows.assign(unit=unit, **{key: rows[key].astype(object).where(rows[key].notna(), "") for key in KEYS})


def measured_lines(results: Results) -> pd.DataFrame:
    """A frame with a row a data set, split, network, start, mode and size that was measured, the classical first.

    accuracy with low and high over so many values; guess; over_features and over_random: the gain over the classical
    features and over the same network untrained, each with _low, _high and the number of _pairs.
    """
    rows = measured(results, "accuracy")
    found = {key: own.groupby("unit")["value"].mean() for key, own in rows.groupby(KEYS, sort=False)}
    lines = pd.DataFrame([_line(found, key) for key in found])
    guess = _guesses(results)
    lines["guess"] = [guess.get(pair, np.nan) for pair in zip(lines["data"], lines["split"], strict=True)]
    lines = lines.join(rows.groupby(KEYS)["pretrained"].first(), on=KEYS)
    order = {name: k for k, name in enumerate([*DATA, *SPLITS, CLASSICAL[0]])}
    by = {"by": ["data", "split", "method"], "key": lambda names: names.map(order).fillna(len(order))}
    return lines.sort_values(**by, kind="stable", ignore_index=True)


def commonest(results: Results) -> pd.Series:
    """Share of right answers by object kept for the test, where the answer is always the commonest in training."""
    wanted = {"task": "slip", "split": Split.TEST_OBJECTS, "palm": "all", "scaled": "training"}
    rows = results.measured("recorded", "biotac_grasps", **wanted, classifier="majority", metric="accuracy")
    return rows.groupby("item")["value"].mean()


def _line(found: dict[tuple, pd.Series], key: tuple) -> dict[str, object]:
    data, split, method, _, mode, size = key
    shared = 0.0 if split in OVER else shared_by(Split.RANDOM)
    mean, low, high = within(found[key], shared)
    line = dict(zip(KEYS, key, strict=True)) | {"accuracy": mean, "low": low, "high": high, "values": len(found[key])}
    controls = {"features": (data, split, *CLASSICAL), "random": (data, split, method, "random", mode, size)}
    for name, control in controls.items():
        gains = (found[key] - found[control]).dropna() if control in found and control != key else found[key][:0]
        ends = zip(("", "_low", "_high", "_pairs"), (*interval(gains, shared), len(gains)), strict=True)
        line |= {f"over_{name}{end}": value for end, value in ends}
    return line


def _guesses(results: Results) -> dict[tuple[str, str], float]:
    """{(data, split): the share that guessing gets right}: any class, or always the commonest, the better on average.

    Of objects kept for the test it is the latter, which the stage `recorded` has object by object.
    """
    found = {}
    with suppress(NotRun):
        rows = measured(results, "chance", "majority")
        means = rows.groupby(["data", "split", "metric", "unit"])["value"].mean().groupby(level=[0, 1, 2]).mean()
        found |= means.groupby(level=[0, 1]).max().to_dict()
    with suppress(NotRun):
        found["grasps_slip", Split.TEST_OBJECTS] = commonest(results).mean()
    return found
