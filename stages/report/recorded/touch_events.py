"""Touches over time: events of a fingertip beside the published networks, and grasps by a hand with pressure arrays."""

from collections.abc import Iterator

import pandas as pd

from stages.engine.statistics import interval
from stages.report.drawing import label
from stages.report.items import Table
from stages.report.results import Results
from stages.report.tables import Ranking, grouped, number, percent, records, signed, with_interval, within

SET = "touch_events"
GROUPS = {"objects": "36 objects", "containers": "20 containers"}
SHOWN = ("discriminant", "linear_svm", "knn")  # of the chart, and of what it takes
OURS = "discriminant"
# Per cent on the publisher's test part: as Zhu, Hu, Zhou, Du and Li list them (Localist topographic expert routing,
# NeurIPS 2025, table 1), their own last.
PUBLISHED = {
    "GCN (Gu and others 2020)": (85.14, 58.83),
    "grid-based CNN (Gu and others 2020)": (88.40, 60.17),
    "TactileSGNet, spiking graph network (Gu and others 2020)": (89.44, 64.17),
    "GGT-SNN (2024)": (92.36, 75.00),
    "barrel network, shared (Zhu and others 2025)": (94.44, 86.67),
}
SPIKING = {"objects": 0.8944, "containers": 0.6417}  # TactileSGNet, whose data these are
CONDITIONS = {
    "heard": "share of the touch heard", "cells": "taxels", "dead_taxels": "share of the taxels dead",
    "dropped_events": "share of the events dropped", "jitter": "deviation of an event's time, steps",
}  # fmt: skip


def build(results: Results) -> Table:
    """Each method on the publisher's test part, asked one time, beside the published figures."""
    rows = results.rows("recorded", SET)
    tested = rows[(rows["part"] == "test") & (rows["metric"] == "accuracy")]
    scores = {key: part.set_index("item")["value"] for key, part in grouped(tested, ["group", "method"])}
    overall = {
        key: part["value"].iloc[0] for key, part in grouped(rows[rows["item"].isna()], ["group", "method", "metric"])
    }
    frame = pd.DataFrame([
        {"group": group, "method": method, **dict(zip(("accuracy", "low", "high"), within(part), strict=True))}
        | dict(zip(("gain", "gain_low", "gain_high"), interval(scores[group, OURS] - part), strict=True))
        | {metric: overall[group, method, metric] for metric in ("cross_validated", "milliseconds", "training_seconds")}
        | tested[(tested["group"] == group) & (tested["method"] == method)].iloc[0][["bins", "parameter"]].to_dict()
        for (group, method), part in scores.items()
    ])  # fmt: skip
    published = [{"method": f"published: {name}"} | {
        GROUPS[group]: f"{share:.2f}" for group, share in zip(GROUPS, shares, strict=True)
    } for name, shares in PUBLISHED.items()]  # fmt: skip
    ours = [_line(part) for _, part in grouped(frame, ["method"])]
    text_table = pd.DataFrame(ours + published).fillna("–")
    return Table(frame, text_table, {"chosen": _chosen(frame)})


def conditions(results: Results) -> Table:
    """Accuracy within the training part by time heard, taxels and disturbance."""
    lines = [
        {"group": group, "method": method, "condition": condition, "level": level}
        | dict(zip(("accuracy", "low", "high"), within(trials["value"]), strict=True))
        for condition, rows in _varied(results)
        for (group, method, level), trials in grouped(rows, ["group", "method", "level"])
    ]
    frame = pd.DataFrame(lines)
    subset = frame[frame["method"].isin(SHOWN)]
    cells = [with_interval(row.accuracy, row.low, row.high, 100, 0) for row in records(subset)]
    names = [
        f"{GROUPS[group]}: {label(method)}, %" for group, method in zip(subset["group"], subset["method"], strict=True)
    ]
    wide = subset.assign(cell=cells, name=pd.Categorical(names, list(dict.fromkeys(names))))
    wide = wide.pivot(index=["condition", "level"], columns="name", values="cell")
    wide = wide.reindex(frame.set_index(["condition", "level"]).index.unique()).rename_axis(columns=None).reset_index()
    return Table(frame, wide.assign(condition=wide["condition"].map(CONDITIONS), level=wide["level"].map(number)))


def _line(rows: pd.DataFrame) -> dict[str, str]:
    line = {"method": label(rows["method"].iloc[0])}
    for row in records(rows):
        ends = [100 * value for value in (row.gain, row.gain_low, row.gain_high)]
        line[GROUPS[row.group]] = with_interval(row.accuracy, row.low, row.high, 100, 2)
        line[f"{label(OURS)} − it, {row.group}"] = "–" if row.method == OURS else signed(*ends, places=1)
    for row in records(rows):
        line[f"in training, {row.group}, %"] = percent(row.cross_validated, 1)
    for row in records(rows):
        line[f"milliseconds a touch, {row.group}"] = number(row.milliseconds)
    return line


def _chosen(frame: pd.DataFrame) -> str:
    """The method of each group with the highest accuracy in training, and its accuracy on the test part."""
    best = frame.loc[frame.groupby("group", sort=False)["cross_validated"].idxmax()]
    texts = [
        f"of the {GROUPS[row.group]} {label(row.method)}, {with_interval(row.accuracy, row.low, row.high, 100, 1)} %"
        for row in records(best)
    ]
    return "; ".join(texts)


def _varied(results: Results) -> Iterator[tuple[str, pd.DataFrame]]:
    """(condition, its rows within the training part, with the column level); undisturbed for heard and cells."""
    rows = results.rows("recorded", SET, part="training", metric="accuracy")
    plain, max_cells = rows[rows["disturbance"].isna()], rows["cells"].max()
    yield "heard", plain[plain["cells"] == max_cells].assign(level=lambda part: part["heard"])
    yield (
        "cells",
        plain[plain["heard"] == 1].assign(level=lambda part: part["cells"]).sort_values("level", kind="stable"),
    )
    for kind, part in grouped(rows.dropna(subset=["disturbance"]), ["disturbance"]):
        yield str(kind[0]), part.assign(level=part["severity"])


GRASPS = "schunk"
BEST_GRASPS = Ranking("grasps left out in turn, %")


def grasp_series(results: Results) -> Table:
    """Each method: all grasps left out in turn, with intervals over grasps, and the publisher's five test grasps."""
    rows = results.rows("recorded", GRASPS, metric="accuracy")
    scores = {key: trials.set_index("item")["value"] for key, trials in grouped(rows, ["method", "part"])}
    lines = []
    for method in rows["method"].unique():
        trials, test_hits = scores[method, "training"], scores[method, "test"]
        line = {"method": method, **dict(zip(("accuracy", "low", "high"), within(trials), strict=True))}
        gain = dict(zip(("gain", "gain_low", "gain_high"), interval(scores[OURS, "training"] - trials), strict=True))
        lines.append(line | gain | {"grasps": len(trials), "listed": int(test_hits.sum()), "listed_of": len(test_hits)})
    frame = pd.DataFrame(lines)
    text_table = pd.DataFrame({
        "method": frame["method"].map(label),
        "grasps left out in turn, %": [
            with_interval(row.accuracy, row.low, row.high, 100, 0) for row in records(frame)
        ],
        f"{label(OURS)} − it": [
            "–" if row.method == OURS else signed(100 * row.gain, 100 * row.gain_low, 100 * row.gain_high, places=0)
            for row in records(frame)
        ],
        "published test list": frame["listed"].astype(str) + " of " + frame["listed_of"].astype(str),
    })  # fmt: skip
    counts = rows[rows["part"] == "training"].drop_duplicates("item")["item"].str.split("/").str[0].value_counts()
    return Table(
        frame, text_table, {"grasps": int(counts.sum()), "commonest": 100 * counts.max() / counts.sum()}, BEST_GRASPS
    )
