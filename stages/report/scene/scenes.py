"""All scenes of conf/scene: do the fewest faces hold in each, beside the other ways to choose levels?"""

import pandas as pd

from stages.report.grid import records
from stages.report.items import Table
from stages.report.markdown import number
from stages.report.results import Results

from .random import planning
from .rows import NAMES, OURS, UNIFORM, UNITS, amount, left_of, savings

WAYS = [("full", ""), ("uniform", "error"), ("uniform_size", "error"), ("network", "error"), (OURS, ""),
        ("online", ""), (OURS, "limit"), ("equal", "limit")]  # fmt: skip
SCENE, WAY = ["scene", "kind", "tolerance"], ["method", "matched"]
VALUES = ["faces", "error", "error_worst", "held", "step_worst"]
SAVED = {"value": "saved", "low": "saved_low", "high": "saved_high"}


def build(results: Results) -> Table:
    """A line for each scene and way to choose levels; what there is in each scene."""
    rows = results.bench("scenes").fillna({"matched": ""})
    scenes = dict(list(rows.groupby(SCENE, sort=False)))
    lines = pd.MultiIndex.from_tuples([(*scene, *way) for scene in scenes for way in WAYS], names=[*SCENE, *WAY])
    wide = rows.dropna(subset=["value"]).pivot(index=lines.names, columns="metric", values="value")
    saved = savings(rows).rename(columns={"method": "ours", "rival": "method", **SAVED}).set_index(lines.names)
    frame = wide.reindex(lines).reindex(columns=VALUES).dropna(subset=["faces"]).join(saved[[*SAVED.values(), "text"]])
    frame = frame.reset_index()
    limited = (frame["matched"] == "limit") & (frame["method"] == OURS)
    shown = {
        "scene": frame["scene"],
        "tolerance": [amount(row.tolerance, UNITS[row.kind]) for row in records(frame)],
        "levels chosen by": frame["method"].map(NAMES) + limited.map({True: ", limited", False: ""}),
        "faces a frame": frame["faces"].round(),
        "frame error, mean": frame["error"],
        "worst frame": frame["error_worst"],
        "frames within, %": [number(100 * share, 2) for share in frame["held"]],
        "worst jump": frame["step_worst"],
        "faces that ours saves, %": frame["text"].fillna("–"),
    }
    words = {
        "scenes": "\n".join(map(_said, scenes.values())),
        "left": left_of(savings(rows)),
        "planning": planning(results),
    }
    return Table(frame.drop(columns="text"), pd.DataFrame(shown), words)


def _said(rows: pd.DataFrame) -> str:
    """What there is in a scene, what ours saves there, and the notes but for those on limits."""
    there = next(iter(records(rows.dropna(subset=["value"]))))
    text = f"Scene {there.scene}, tolerance {amount(there.tolerance, UNITS[there.kind])}: "
    text += f"{there.objects:.0f} objects ({there.shapes:.0f} different), {there.frames:.0f} frames."
    saved = {(row.rival, row.matched): row for row in records(savings(rows))}
    for rival in UNIFORM:
        if own := saved.get((rival, "error")):
            text += f" Against {NAMES[rival]} ours saves {own.text} % at an equal mean error."
        if own := saved.get((rival, "displacement")):
            text += f" At an equal mean displacement of all pixels it saves {own.text} %."
    noted = rows[rows["matched"] != "limit"].dropna(subset=["note"]).drop_duplicates(["method", "note"])
    return text + "".join(f" {NAMES[row.method].capitalize()}: {row.note}." for row in records(noted))
