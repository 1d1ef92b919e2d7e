"""How well methods agree with people: one row per method and metric, over objects that have ground truth."""

from collections.abc import Sequence

import pandas as pd

from stages.kit.stats import interval
from stages.report.results import NotRun
from stages.report.style import label

OURS, HUMAN, CLASSICAL, THESIS = "enhanced", "human", "itti", "VisAttAll"
PER_OBJECT = ("svm_object", "svm_viewpoint")  # T3.2.3: an SVM for the object itself
SAME = {"VisAtt": CLASSICAL}  # the classical model under the thesis's name
NAMES = {"random": "random points"}  # nobody touches here
GAINS = ("nss", "auc")  # metrics in which ours is compared with each other method
MEAN, GAIN = ["mean", "low", "high"], ["gain", "gain_low", "gain_high"]  # columns: of a method, and over another


def has_seen(method: str) -> bool:
    """True for a method that learned from the very object that it is judged on."""
    return method in PER_OBJECT or method.endswith("_seen")


def method_text(method: str) -> str:
    """A method's name as a person says it, with a star where it has seen the object."""
    return NAMES.get(method, label(method)) + (" *" if has_seen(method) else "")


def scores(rows: pd.DataFrame, metric: str) -> pd.DataFrame:
    """Frame objects x methods of one metric; NotRun where it was not measured."""
    found = rows.loc[rows["metric"] == metric]
    if found["value"].isna().all():
        raise NotRun(f"no {metric}: no object has ground truth", "salient_points", runnable=False)
    found = found.loc[~found["method"].isin(list(SAME))]
    return found.pivot_table(index="item", columns="method", values="value", sort=False)


def difference(rows: pd.DataFrame, metric: str, first: str, second: str) -> pd.Series:
    """First minus second, an object; NotRun where either was not judged."""
    table = scores(rows, metric)
    missing = [method for method in (first, second) if method not in table]
    if missing:
        raise NotRun(f"{' and '.join(missing)} not judged on objects with ground truth", "salient_points", False)
    return pd.Series(table[first] - table[second]).dropna()


def rivals(rows: pd.DataFrame, metric: str) -> list[str]:
    """The methods that ours is to beat, best first: all but itself, the ceiling, and those that peeked."""
    means = scores(rows, metric).mean().sort_values(ascending=False)
    return [method for method in map(str, means.index) if method not in (OURS, HUMAN) and not has_seen(method)]


def gain(table: pd.DataFrame, first: str, second: str) -> dict[str, float]:
    """GAIN of one method over another, paired over the objects of `scores`; {} where either is absent."""
    if first == second or first not in table or second not in table:
        return {}
    return dict(zip(GAIN, interval(table[first] - table[second]), strict=True))


def agreement(rows: pd.DataFrame, metrics: Sequence[str]) -> pd.DataFrame:
    """Tidy frame: method, has_seen, metric, objects, mean, low, high, and gain, gain_low, gain_high.

    The gain is that of ours over the method, paired over objects, for GAINS. 95 % intervals over objects. In order of
    NSS, the human ceiling first.
    """
    tables, found = {metric: scores(rows, metric) for metric in metrics}, []
    order = map(str, tables["nss"].mean().sort_values(ascending=False).index)
    for method in sorted(order, key=lambda name: name != HUMAN):
        for metric, table in tables.items():
            if method in table:
                line = {"method": method, "has_seen": has_seen(method), "metric": metric}
                line |= {"objects": table[method].count(), **dict(zip(MEAN, interval(table[method]), strict=True))}
                found.append(line | (gain(table, OURS, method) if metric in GAINS and method != HUMAN else {}))
    return pd.DataFrame(found)
