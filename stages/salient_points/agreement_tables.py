"""Agreement of attention models with human gaze and with marks: claims (T3.1.5, T3.2) and tables.

`agreement` has one row per method and metric, over the objects that have ground truth. The claims compare weights, SVMs
and models on human gaze. The tables (gaze on meshes, gaze on point clouds, marks) state the findings in words. The
learned methods of the gaze tables leave out the judged object; only methods with a star have seen it.
"""

from collections.abc import Iterator, Sequence
from contextlib import suppress

import pandas as pd

from stages.bench import has_seen
from stages.charts.drawing import label
from stages.charts.items import Table, shared_notes
from stages.charts.pareto import attention_seconds
from stages.charts.results import NotRun, Results, require_rows
from stages.charts.tables import Ranking, interval_columns, number, records, signed, with_interval
from stages.engine.statistics import interval

OURS, ANY_POSE, HUMAN = "glance", "glance_any_pose", "human"
CLASSICAL, THESIS = "itti", "VisAttAll"
NO_RIVALS = (OURS, ANY_POSE, HUMAN)  # our models, and the ceiling
SAME = ("VisAtt",)  # the classical model under the thesis's name
NAMES = {"random": "random points", "svm": "thesis, SVM"}  # elsewhere blind touch, and a classifier
ALONE = {"nss": "NSS", "auc": "AUC"}  # shown with their interval, and in which ours is compared with each other method
MEAN, GAIN = ["mean", "low", "high"], ["gain", "gain_low", "gain_high"]  # columns: of a method, and over another


def method_text(method: str) -> str:
    """A method's name as a person says it, with a star where it has seen the object."""
    name = NAMES.get(method) or label(method)
    return f"{name} *" if has_seen(method) else name


def scores(rows: pd.DataFrame, metric: str) -> pd.DataFrame:
    """Frame objects x methods of one metric; NotRun where it was not measured."""
    values = rows[rows["metric"] == metric].dropna(subset=["value"])
    require_rows(values, f"no {metric}: no object has ground truth", "salient_points", runnable=False)
    return values[~values["method"].isin(SAME)].pivot_table(index="item", columns="method", values="value", sort=False)


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
    return interval_columns("gain", interval(table[first] - table[second]))


def agreement(rows: pd.DataFrame, metrics: Sequence[str]) -> pd.DataFrame:
    """Tidy frame: method, has_seen, metric, objects, MEAN and, for ALONE, GAIN: of ours over the method.

    95 % intervals over the objects. In order of NSS, the human ceiling first.
    """
    tables, lines = {metric: scores(rows, metric) for metric in metrics}, []
    order = map(str, tables["nss"].mean().sort_values(ascending=False).index)
    for method in sorted(order, key=lambda name: name != HUMAN):
        for metric, table in tables.items():
            if method in table:
                line = {"method": method, "has_seen": has_seen(method), "metric": metric}
                line["objects"] = table[method].count()
                line |= interval_columns("mean", interval(table[method]), prefix="")
                lines.append(line | (gain(table, OURS, method) if metric in ALONE and method != HUMAN else {}))
    return pd.DataFrame(lines)


COUNTED = "points_strong"
MARKED = "household"  # the data set whose marks come with the project


MEANS = {
    "cc": "CC", "sim": "SIM", "kl": "KL", COUNTED: "points", "fne@0.05": "FNE", "fpe@0.05": "FPE", "wme@0.05": "WME",
}  # fmt: skip
NAMED = 5  # methods that a sentence names at most
PEEKED = {"guided_ssim": "guided_ssim+seen", "guided_ed": "guided_ed+seen", "svm": "svm+object"}


def against_gaze(results: Results) -> Table:
    """The meshes with human gaze, each left out of the learning."""
    rows = results.rows("salient_points", "gaze")
    return _table(results, rows, list(MEANS), {"count": rows["item"].nunique()})


def against_clouds(results: Results) -> Table:
    """The point clouds with human gaze, each left out of the learning; how their surfaces are made costs apart."""
    rows = results.rows("salient_points", "gaze_clouds")
    return _table(results, rows, list(MEANS), {"count": rows["item"].nunique()})


def against_marks(results: Results) -> Table:
    """The marks on this run's own objects."""
    rows = results.measured("salient_points")
    dataset, count = rows["dataset"].iloc[0], rows.loc[rows["metric"] == "nss", "item"].nunique()
    default = f"The truth is what comes with the data set {dataset}."
    truth = shared_notes(__package__, "marks") if dataset == MARKED else default
    return _table(results, rows, [COUNTED, "fne@0.05", "fpe@0.05"], {"count": count, "truth": truth})


def _table(results: Results, rows: pd.DataFrame, beside: Sequence[str], words: dict) -> Table:
    """The judged rows, with those of MEANS that stand beside NSS and AUC; words: without those that the numbers say.

    The seconds are those from the pictures to the points; of a set without rows of pictures or maps there are none.
    """
    cost: dict[str, float] = {}
    with suppress(NotRun):
        cost = attention_seconds(results, rows["dataset"].iloc[0])
    frame = agreement(rows, [*ALONE, *beside])
    names, lines = list(ALONE.values()), {}
    columns = ["method", *names, *(f"ours − it, {name}" for name in names), *map(MEANS.get, beside)]
    columns += ["seconds"] if cost else []
    for row in records(frame.reindex(columns=frame.columns.union(GAIN))):
        line = lines.setdefault(row.method, dict.fromkeys(columns, "–"))
        line |= {"method": method_text(row.method), "seconds": number(cost[row.method]) if row.method in cost else "–"}
        if row.metric in ALONE:
            line[ALONE[row.metric]] = with_interval(row.mean, row.low, row.high, places=2)
        elif row.mean == row.mean:
            line[MEANS[row.metric]] = f"{row.mean:.{1 if row.metric == COUNTED else 2}f}"
        if row.gain == row.gain:
            line[f"ours − it, {ALONE[row.metric]}"] = signed(row.gain, row.gain_low, row.gain_high)
    findings = "\n".join([*_ours_and_rivals(rows), *_learned(rows), *_peeking(rows)])
    words = words | {"findings": findings, "reading": shared_notes(__package__, "reading")}
    cells = pd.DataFrame(lines.values())
    truth_and_peeking = [method_text(name) for name in lines if name == HUMAN or has_seen(name)]
    answer = [name for name in columns if name not in MEANS.values() or name == MEANS[COUNTED]]
    return Table(frame, cells, words, Ranking("NSS", exempt=truth_and_peeking), answer)


def _ours_and_rivals(rows: pd.DataFrame) -> Iterator[str]:
    """The place of ours, and the rivals that it does not beat beyond chance."""
    table = scores(rows, "nss")
    if OURS not in table:
        return
    first = f"{label(OURS)}: NSS {with_interval(*interval(table[OURS]), places=2)}"
    if HUMAN in table:
        first += f"; {label(HUMAN)}, spread as smoothly, has {table[HUMAN].mean():.2f}"
    yield f"{first}."
    best = next(iter(rivals(rows, "nss")), None)
    if best is None:
        return
    gains = [f"{name} {signed(*interval(difference(rows, metric, OURS, best)))}" for metric, name in ALONE.items()]
    yield f"The best other method that has not seen the object is {label(best)}: ours − it {_and(gains)}."
    for metric, name in ALONE.items():
        table, methods = scores(rows, metric), rivals(rows, metric)
        left = [label(rival) for rival in methods if not interval(table[OURS] - table[rival])[1] > 0]
        labels = left if len(left) <= NAMED else [*left[:NAMED], f"{len(left) - NAMED} more"]
        yield (
            f"In {name} ours is higher than {len(methods) - len(left)} of the {len(methods)} others that have not seen "
            "the object, with an interval that excludes zero" + (f"; not than {_and(labels)}." if left else ".")
        )


def _learned(rows: pd.DataFrame) -> Iterator[str]:
    """The gain of more channels with equal weights over the classical model, and of learned weights over equal ones."""
    base = "equal" if "equal" in scores(rows, "nss") else THESIS
    for pair in ((THESIS, CLASSICAL), ("equal", CLASSICAL), ("guided_ssim", base), ("guided_ed", base)):
        with suppress(NotRun):
            gains = []
            for metric, name in ALONE.items():
                mean, low, high = interval(difference(rows, metric, *pair))
                word = "higher" if low > 0 else "lower" if high < 0 else "not told apart"
                gains.append(f"{name} {signed(mean, low, high, places=3)} ({word})")
            yield f"{' − '.join(map(label, pair))}: {_and(gains)}."


def _peeking(rows: pd.DataFrame) -> Iterator[str]:
    """The gain of the same method from having seen the object: the leak of the thesis's way of testing."""
    gains = []
    for clean, peeked in PEEKED.items():
        with suppress(NotRun):
            gains.append(f"{label(clean)} {signed(*interval(difference(rows, 'nss', peeked, clean)))}")
    if gains:
        text = "* has seen the object: the method learned from the object's own truth, too. Gain in NSS: "
        yield f"{text}{'; '.join(gains)}."


def _and(parts: list[str]) -> str:
    return " and ".join([", ".join(parts[:-1]), parts[-1]]) if len(parts) > 1 else "".join(parts)
