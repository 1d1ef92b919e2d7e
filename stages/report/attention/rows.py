"""How well methods agree with people: one row per method and metric, over objects that have ground truth."""

from collections.abc import Sequence

import pandas as pd

from stages.bench import has_seen
from stages.kit.stats import interval
from stages.report.results import NotRun, some
from stages.report.style import label

OURS, ANY_POSE, HUMAN = "glance", "glance_any_pose", "human"
CLASSICAL, THESIS = "itti", "VisAttAll"
NO_RIVALS = (OURS, ANY_POSE, HUMAN)  # our models, and the ceiling
BLACK = "-black"  # behind the name of a method: with the black background filtered together with the object
SAME = ("VisAtt",)  # the classical model under the thesis's name
NAMES = {"random": "random points", "svm": "thesis, SVM"}  # elsewhere blind touch, and a classifier
ALONE = {"nss": "NSS", "auc": "AUC"}  # shown with their interval, and in which ours is compared with each other method
MEAN, GAIN = ["mean", "low", "high"], ["gain", "gain_low", "gain_high"]  # columns: of a method, and over another


def method_text(method: str) -> str:
    """A method's name as a person says it, with a star where it has seen the object."""
    if method.endswith(BLACK):
        return f"{label(method.removesuffix(BLACK))}, black background"
    name = NAMES.get(method) or label(method)
    return f"{name} *" if has_seen(method) else name


def scores(rows: pd.DataFrame, metric: str) -> pd.DataFrame:
    """Frame objects x methods of one metric; NotRun where it was not measured."""
    found = rows[rows["metric"] == metric].dropna(subset=["value"])
    some(found, f"no {metric}: no object has ground truth", "salient_points", runnable=False)
    return found[~found["method"].isin(SAME)].pivot_table(index="item", columns="method", values="value", sort=False)


def difference(rows: pd.DataFrame, metric: str, first: str, second: str) -> pd.Series:
    """First minus second, an object; NotRun where either was not judged."""
    table = scores(rows, metric)
    missing = [method for method in (first, second) if method not in table]
    if missing:
        raise NotRun(f"{' and '.join(missing)} not judged on objects with ground truth", "salient_points", False)
    return pd.Series(table[first] - table[second])


def rivals(rows: pd.DataFrame, metric: str) -> list[str]:
    """The methods that ours are to beat, best first: all but these, the ceiling, and those that peeked."""
    means = scores(rows, metric).mean().sort_values(ascending=False)
    return [method for method in map(str, means.index) if method not in NO_RIVALS and not has_seen(method)]


def gain(table: pd.DataFrame, first: str, second: str) -> dict[str, float]:
    """GAIN of one method over another, paired over the objects of `scores`; {} where either is absent."""
    if first == second or first not in table or second not in table:
        return {}
    return dict(zip(GAIN, interval(table[first] - table[second]), strict=True))


def agreement(rows: pd.DataFrame, metrics: Sequence[str]) -> pd.DataFrame:
    """Tidy frame: method, has_seen, metric, objects, MEAN and, for ALONE, GAIN: of ours over the method.

    95 % intervals over the objects. In order of NSS, the human ceiling first.
    """
    tables, found = {metric: scores(rows, metric) for metric in metrics}, []
    order = map(str, tables["nss"].mean().sort_values(ascending=False).index)
    for method in sorted(order, key=lambda name: name != HUMAN):
        for metric, table in tables.items():
            if method in table:
                line = {"method": method, "has_seen": has_seen(method), "metric": metric}
                line |= {"objects": table[method].count(), **dict(zip(MEAN, interval(table[method]), strict=True))}
                found.append(line | (gain(table, OURS, method) if metric in ALONE and method != HUMAN else {}))
    return pd.DataFrame(found)
