"""How well methods agree with people: one row per method and metric, over objects that have ground truth."""

import pandas as pd

from stages.kit.stats import interval
from stages.report.markdown import number
from stages.report.results import NotRun
from stages.report.style import label

OURS, HUMAN, CLASSICAL, THESIS = "enhanced", "human", "itti", "VisAttAll"
PER_OBJECT = ("svm_object", "svm_viewpoint")  # T3.2.3: an SVM for the object itself
SAME = {"VisAtt": CLASSICAL}  # the classical model under the thesis's name
NAMES = {"random": "random points"}  # nobody touches here
GAINS = ("nss", "auc")  # metrics in which ours is compared with each other method


def gaze_first(datasets):
    """Names of data sets in their order, that of the people's gaze before all others."""
    return sorted(datasets, key=lambda name: name != "gaze")


def has_seen(method):
    """True for a method that learned from the very object that it is judged on."""
    return method in PER_OBJECT or method.endswith("_seen")


def method_text(method):
    """A method's name as a person says it, with a star where it has seen the object."""
    return NAMES.get(method, label(method)) + (" *" if has_seen(method) else "")


def scores(rows, metric):
    """Frame objects x methods of one metric; NotRun where it was not measured."""
    found = rows[rows["metric"] == metric]
    if found["value"].isna().all():
        raise NotRun(f"no {metric}: no object has ground truth", "salient_points", runnable=False)
    found = found[~found["method"].isin(SAME)]
    return found.pivot_table(index="item", columns="method", values="value", sort=False)


def difference(rows, metric, first, second):
    """Series of first minus second, an object; NotRun where either was not judged."""
    table = scores(rows, metric)
    missing = [method for method in (first, second) if method not in table]
    if missing:
        raise NotRun(f"{' and '.join(missing)} not judged on objects with ground truth", "salient_points", False)
    return (table[first] - table[second]).dropna()


def rivals(table):
    """The methods of a frame of scores that ours is to beat: all but itself, the ceiling, and those that peeked."""
    return [method for method in table if method not in (OURS, HUMAN) and not has_seen(method)]


def best_rival(rows, metric="nss"):
    """The rival with the highest mean; NotRun where there is none."""
    table = scores(rows, metric)
    if not rivals(table):
        raise NotRun("no method to compare with", "salient_points", runnable=False)
    return table[rivals(table)].mean().idxmax()


def agreement(rows, metrics):
    """Tidy frame: method, has_seen, metric, objects, mean, low, high, and gain, gain_low, gain_high.

    The gain is that of ours over the method, paired over objects, for GAINS. 95 % intervals over objects. In order of
    NSS, the human ceiling first.
    """
    tables = {metric: scores(rows, metric) for metric in metrics}
    order = tables["nss"].mean().sort_values(ascending=False).index
    order = sorted(order, key=lambda method: method != HUMAN)
    found = []
    for method in order:
        for metric, table in tables.items():
            if method not in table:
                continue
            values = table[method].dropna()
            mean, low, high = interval(values)
            line = {"method": method, "has_seen": has_seen(method), "metric": metric, "objects": len(values)}
            found.append(line | {"mean": mean, "low": low, "high": high} | _gain(table, metric, method))
    return pd.DataFrame(found)


def _gain(table, metric, method):
    if metric not in GAINS or method in (OURS, HUMAN) or OURS not in table:
        return {}
    both = table[[OURS, method]].dropna()
    return dict(zip(("gain", "gain_low", "gain_high"), interval(both[OURS] - both[method]), strict=True))


def seconds(rows):
    """dict method -> median seconds of an object."""
    timed = rows.dropna(subset=["seconds"]).drop_duplicates(["item", "method", "seconds"])
    return {method: number(value) for method, value in timed.groupby("method")["seconds"].median().items()}
