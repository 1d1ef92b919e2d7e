"""Accuracies on recorded touches by what they were measured on, for the table and the claims that pair them."""

from contextlib import suppress

import pandas as pd

from stages.kit.split import Split, shared_by
from stages.report.results import NotRun

KEYS = ["data", "split", "method", "weights", "mode", "size"]
CLASSICAL = ("features_knn", "", "", "")  # the control without a network: neither weights, nor mode, nor size
OVER = (Split.TEST_OBJECTS,)  # splits whose values are of independent objects, not of repetitions


def shared(split):
    """Test over training share of the repetitions of a split (stages.report.intervals); 0 where objects are paired."""
    return 0.0 if split in OVER else shared_by("random")


def accuracies(results):
    """{(data, split, method, weights, mode, size): Series of accuracies}; what a row has not, such as weights, is "".

    A value a repetition, whose number is the same split for all; of OVER a value an object, the mean of its trainings.
    NotRun where nothing was measured.
    """
    rows = measured_rows(results, "accuracy")
    return {key: _values(part, key[1]) for key, part in rows.groupby(KEYS, sort=False)}


def gain(found, first, second):
    """Series of `first` minus `second` (keys of `found`) on the same splits or objects; empty where one is absent."""
    if first not in found or second not in found:
        return pd.Series(dtype=float)
    return (found[first] - found[second]).dropna()


def guesses(results, data, split):
    """Series of the share that guessing gets right, a repetition or an object; empty where no network was asked.

    Guessing takes any class, or always the commonest in training: what is right more often on average. Of objects kept
    for the test it is the latter, which reports/touch has object by object; NotRun without it.
    """
    if split in OVER:
        return _commonest(results)
    found = []
    for metric in ("chance", "majority"):
        rows = measured_rows(results, metric)
        found.append(_values(rows[(rows["data"] == data) & (rows["split"] == split)], split))
    return max(found, key=lambda values: values.mean() if len(values) else 0.0)


def measured_rows(results, metric):
    """Rows of a metric that have a value, of all recorded data sets, their KEYS without gaps; NotRun without any."""
    stage, found = "recorded_networks", []
    for dataset in results.datasets(stage):
        with suppress(NotRun):
            found.append(results.measured(stage, dataset, metric=metric))
    if not found:
        raise NotRun(f"no {metric} of networks on recorded touches", stage)
    rows = pd.concat(found, ignore_index=True).astype({"size": "Int64"})
    return rows.assign(**{key: rows[key].astype(object).where(rows[key].notna(), "") for key in KEYS})


def _values(rows, split):
    rows = rows[rows["item"].notna() == (split in OVER)]
    return rows.groupby("item" if split in OVER else "repetition")["value"].mean()


def _commonest(results):
    wanted = {"task": "slip", "split": Split.TEST_OBJECTS, "palm": "all", "scaled": "training"}
    rows = results.measured("recorded", "biotac_grasps", **wanted, classifier="majority", metric="accuracy")
    return rows.groupby("item")["value"].mean()
