"""Agreement with gaze against the seconds of looking: of every method, and of our model by its settings."""

import numpy as np
import pandas as pd

from stages.kit.stats import interval
from stages.report.costs import attention_seconds
from stages.report.items import Figure
from stages.report.markdown import signed
from stages.report.pareto import pareto_chart
from stages.report.results import NotRun, Results
from stages.report.style import label

from .rows import CLASSICAL, HUMAN, agreement, method_text

SETTING = ["views", "rows", "channels"]
MODEL = "fixations"
LOSS = 0.02  # of NSS: a mean loss under this is nothing, if it is not beyond chance, nor that of AUC
NAMED = 3  # smallest settings that the caption names


def by_method(results: Results) -> Figure:
    """NSS on gaze against seconds, for every method."""
    frame = agreement(results.rows("salient_points", "gaze"), ["nss"])
    frame = frame[~frame["has_seen"] & (frame["method"] != HUMAN)]
    frame = frame.assign(
        seconds=frame["method"].map(attention_seconds(results, "gaze")), name=frame["method"].map(method_text)
    )
    frame = frame.dropna(subset=["seconds"])
    if CLASSICAL not in set(frame["method"]):
        raise NotRun(f"no cost of {CLASSICAL} on the meshes with gaze", "gaze", runnable=False)
    chart = pareto_chart(
        frame, "seconds", "mean", "name", name="attention", title="Predicting where people look",
        reference=label(CLASSICAL), quality_label="NSS on human gaze", folder=results.reports / "tradeoff",
    )  # fmt: skip
    chart.caption += (
        " Cost: twelve views, the maps of the method's channels and the points, of the median of "
        f"{frame['objects'].max()} meshes. What was learned has not seen the mesh that it is judged on. NSS 0: chance."
    )
    return chart


def by_setting(results: Results) -> Figure:
    """How little looking our model needs: NSS against cost over views, image size and channels."""
    rows = results.rows("attention_settings")
    rows = rows[rows["method"] == MODEL]
    wide = rows.pivot_table(index=[*SETTING, "item", "seconds"], columns="metric", values="value", sort=False)
    tables = {key: group.set_index("item") for key, group in wide.reset_index().groupby(SETTING, sort=False)}
    if len(tables) < 2:
        raise NotRun("fewer than two settings were measured", "settings", runnable=False)
    best = max(tables, key=lambda key: tables[key]["nss"].mean())
    frame = pd.DataFrame([_line(key, table, tables[best], key == best) for key, table in tables.items()])
    chart = pareto_chart(
        frame, "seconds", "gain", "name", name="attention_settings", title="How little looking the model of gaze needs",
        reference=_named(*best), quality_label="NSS on gaze, minus that of the best setting",
        folder=results.reports / "tradeoff",
        colour="views", marker="rows",
    )  # fmt: skip
    chart.caption += " " + _said(frame, _named(*best), len(tables[best]))
    return chart


def _line(key, table, best, itself):
    both = table.join(best[["nss", "auc"]].add_prefix("best_")).dropna(subset=["nss", "best_nss"])
    gain, low, high = (0.0, np.nan, np.nan) if itself else interval(both["nss"] - both["best_nss"])
    auc_high = 0.0 if itself else interval(both["auc"] - both["best_auc"])[2]
    found = {"gain": gain, "low": low, "high": high, "nss": both["nss"].mean(), "auc": both["auc"].mean()}
    found |= {"seconds": both["seconds"].median(), "objects": len(both)}
    nothing = not (high < 0 or auc_high < 0) and gain > -LOSS
    return dict(zip(SETTING, key, strict=True)) | {"name": _named(*key)} | found | {"loses_nothing": nothing}


def _said(frame, best, objects):
    """The smallest settings that lose nothing measurable, in words."""
    full = frame.loc[frame["name"] == best].iloc[0]
    enough = frame[frame["loses_nothing"]].sort_values("seconds")[:NAMED]
    named = "; ".join(
        f"{row.name} ({full['seconds'] / row.seconds:.1f} times as fast, {signed(row.gain, row.low, row.high, 3)})"
        for row in enough.itertuples()
    )
    return (
        f"One core, {objects} meshes, each left out of the learning. Smallest settings that lose nothing measurable "
        f"against the best one ({best}; mean loss under {LOSS} NSS, neither NSS nor AUC lost beyond chance): {named}."
    )


def _named(views, rows, channels):
    return f"{views}, {rows} rows, {channels}"
