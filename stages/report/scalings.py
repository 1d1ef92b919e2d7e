"""Rows by the scale of the samples, a reading of T4.2.4, and means over classifiers with and without the SVM."""

import pandas as pd

from haptic_glance.know.classifiers import BEFOREHAND, MIN_MAX, TRAINING, TWICE

READINGS = {  # beside ours, TRAINING
    BEFOREHAND: "all data standardised beforehand (T4.2.4)", TWICE: "components standardised, too",
    MIN_MAX: "all data from 0 to 1",
}  # fmt: skip
CLASSIFIERS = ("knn", "svm", "decision_tree", "naive_bayes", "deep_learning")  # the thesis's order, reversed
MEANS = {"mean_of_all": CLASSIFIERS, "mean_without_svm": tuple(name for name in CLASSIFIERS if name != "svm")}


def scaled(rows: pd.DataFrame, scaling: str = TRAINING) -> pd.DataFrame:
    """The rows of one scaling; those that are about no classifier have none, and stay with TRAINING."""
    return rows[rows["scaling"].fillna(TRAINING) == scaling]


def with_means(rows: pd.DataFrame) -> pd.DataFrame:
    """The rows, and behind them the means over the classifiers of MEANS where each of these was run."""
    columns = ("dataset", "set", "repetition", "group", "method", "variant", "split", "metric", "scaling")
    keys, found = [name for name in columns if name in rows], [rows]
    for name, classifiers in MEANS.items():
        own = rows[rows["classifier"].isin(classifiers)].groupby(keys, dropna=False, sort=False)
        means = own.agg({"value": "mean", "classifier": "nunique"}).reset_index()
        found.append(means[means["classifier"] == len(classifiers)].assign(classifier=name))
    return pd.concat(found, ignore_index=True)
