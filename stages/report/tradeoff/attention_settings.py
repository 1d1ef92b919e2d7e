"""How little looking our model needs: NSS on gaze against cost over views, image size and channels."""

import numpy as np
import pandas as pd

from stages.report.judged import signed
from stages.report.pareto import pareto_chart
from stages.report.results import NotRun
from stages.weights.agreement import paired

SETTING = ["views", "rows", "channels"]
FULL = ("twelve", 900, "nine")
MODEL = "fixations"
LOSS = 0.02  # of NSS: a mean loss under this is nothing, if it is not beyond chance
NAMED = 3  # smallest settings that the caption names


def build(results):
    rows = results.attention("settings")
    rows = rows[rows["method"] == MODEL]
    tables = {key: group.set_index("object") for key, group in rows.groupby(SETTING, sort=False)}
    if FULL not in tables:
        raise NotRun(f"the full setting ({_named(*FULL)}) is not among those measured", "settings", runnable=False)
    frame = pd.DataFrame([_line(key, table, tables[FULL]) for key, table in tables.items()])
    chart = pareto_chart(
        frame, "seconds", "gain", "name", name="attention_settings", title="How little looking the model of gaze needs",
        reference=_named(*FULL), quality_label="NSS on gaze, minus that of the full setting",
        folder=results.reports / "tradeoff",
        colour="views", marker="rows",
    )  # fmt: skip
    chart.caption += " " + _said(frame, len(tables[FULL]))
    return chart


def _line(key, table, full):
    both = table.join(full["nss"].rename("full")).dropna(subset=["nss", "full"])
    gain, low, high = (0.0, np.nan, np.nan) if key == FULL else paired(both["nss"], both["full"])
    found = {"gain": gain, "low": low, "high": high, "nss": both["nss"].mean(), "auc": both["auc"].mean()}
    found |= {"seconds": both["seconds"].median(), "objects": len(both)}
    nothing = not high < 0 and gain > -LOSS
    return dict(zip(SETTING, key, strict=True)) | {"name": _named(*key)} | found | {"loses_nothing": nothing}


def _said(frame, objects):
    """The smallest settings that lose nothing measurable, in words."""
    full = frame.loc[frame["name"] == _named(*FULL)].iloc[0]
    enough = frame[frame["loses_nothing"]].sort_values("seconds")[:NAMED]
    named = "; ".join(
        f"{row.name} ({full['seconds'] / row.seconds:.1f} times as fast, {signed(row.gain, row.low, row.high, 3)})"
        for row in enough.itertuples()
    )
    return (
        f"One core, {objects} meshes, each left out of the learning. Smallest settings that lose nothing measurable "
        f"against the full one ({_named(*FULL)}; mean loss under {LOSS} NSS, and not beyond chance): {named}."
    )


def _named(views, rows, channels):
    return f"{views}, {rows} rows, {channels}"
