"""Agreement with gaze against the seconds of looking: of every method, and of our model by its settings."""

import numpy as np
import pandas as pd

from stages.kit.stats import interval
from stages.report.costs import attention_seconds
from stages.report.grid import grouped, records
from stages.report.items import Figure
from stages.report.markdown import signed
from stages.report.pareto import pareto_chart
from stages.report.results import NotRun, Results
from stages.report.style import label

from .rows import CLASSICAL, HUMAN, agreement, method_text, scores

SETTING = ["views", "rows", "channels"]
LOSS = 0.02  # of NSS: a mean loss under this is nothing, if it is not beyond chance, nor that of AUC


def by_method(results: Results) -> Figure:
    """NSS on gaze against seconds, for every method."""
    rows = results.rows("salient_points", "gaze")
    frame = agreement(rows, ["nss"])
    frame = frame.loc[~frame["has_seen"] & (frame["method"] != HUMAN)]
    seconds = frame["method"].map(attention_seconds(results, "gaze"))
    frame = frame.assign(seconds=seconds, name=frame["method"].map(method_text)).dropna(subset=["seconds"])
    title, unit = "Predicting where people look", label(CLASSICAL)
    chart = pareto_chart(
        frame, "mean", title=title, reference=unit, quality_label="NSS on human gaze",
        clock=results.clock("salient_points", "gaze"), units=scores(rows, "nss").rename(columns=method_text),
    )  # fmt: skip
    chart.words["objects"] = frame["objects"].max()
    return chart


def by_setting(results: Results) -> Figure:
    """How little looking our model needs: NSS against cost over views, image size and channels."""
    rows = results.rows("attention_settings", method="fixations").astype({"rows": int})
    wide = rows.pivot_table(index=[*SETTING, "item", "seconds"], columns="metric", values="value", sort=False)
    tables = {
        f"{views}, {height} rows, {channels.replace('dkl', label('dkl'))}": group.set_index("item")
        for (views, height, channels), group in grouped(wide.reset_index(), SETTING)
    }
    if len(tables) < 2:
        raise NotRun("fewer than two settings were measured", "settings", runnable=False)
    best = max(tables, key=lambda name: tables[name]["nss"].mean())
    frame = pd.DataFrame([_line(name, table, tables[best]) for name, table in tables.items()])
    chart = pareto_chart(
        frame, "gain", title="How little looking the model of gaze needs", reference=best,
        quality_label="NSS on gaze, minus that of the best setting", colour="views", marker="rows",
        legends={"views": "viewpoints", "rows": "rows of a picture"}, clock=results.clock("attention_settings"),
        units=pd.DataFrame({name: table["nss"] - tables[best]["nss"] for name, table in tables.items()}),
    )  # fmt: skip
    full = frame.loc[frame["name"] == best, "seconds"].iloc[0]
    named = "; ".join(
        f"{row.name} ({full / row.seconds:.1f} times as fast, {signed(row.gain, row.low, row.high, 3)})"
        for row in records(frame[frame["loses_nothing"]].sort_values("seconds")[:3])
    )
    chart.words |= {"objects": len(tables[best]), "best": best, "loss": LOSS, "named": named}
    return chart


def _line(name: str, table: pd.DataFrame, best: pd.DataFrame) -> dict:
    """A setting with its paired gain over the best, which is a loss; of the best itself nothing."""
    both = table.join(best[["nss", "auc", "seconds"]].add_prefix("best_")).dropna(subset=["nss", "best_nss"])
    gain, low, high = interval(both["nss"] - both["best_nss"])
    nothing = not (high < 0 or interval(both["auc"] - both["best_auc"])[2] < 0) and gain > -LOSS
    found = {"gain": gain, "low": low, "high": high, "nss": both["nss"].mean(), "auc": both["auc"].mean()}
    seconds = both["seconds"] / both["best_seconds"]  # one process timed all settings of an object
    found |= {"seconds": both["seconds"].median(), "objects": len(both), "loses_nothing": nothing}
    found["noise"] = np.log(seconds).std() / np.sqrt(len(both))
    return table[SETTING].iloc[0].to_dict() | {"name": name} | found
