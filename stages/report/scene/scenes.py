"""All scenes of conf/scene: do the fewest faces hold in each, beside the other ways to choose levels?"""

import pandas as pd

from stages.report.items import Table
from stages.report.markdown import number, with_interval
from stages.report.results import Results
from stages.report.target import on_target

from .rows import NAMES, OURS, UNIFORM, UNITS, amount, limits_of

WAYS = [("full", ""), ("uniform", "error"), ("uniform_size", "error"), ("network", "error"), (OURS, ""),
        (OURS, "limit"), ("equal", "limit")]  # fmt: skip
VALUES = ["faces", "error", "error_worst", "held", "step_worst"]
TARGET = 0.30  # of the faces of uniform levels are to be saved at an equal error
WANTED = f"{100 * TARGET:.0f} %, with every frame within the tolerance"
NOTES = [
    "Uniform levels and the thesis's network are chosen from the same meshes as ours, tuned by one factor until the "
    "mean over the path of their rendered frames' error is at least ours. Intervals: 95 %, bootstrap over the "
    "different objects of the scene; copies of one are drawn together.",
    "Frames within: share of the rendered frames in which every object holds the tolerance; a frame's error is that of "
    "its worst object, for an object the 99 % quantile of the displacement over its pixels, or with 1 − SSIM the mean "
    "over them. Worst jump: the same error between the two levels of a switch, both rendered.",
    "Limited: no frame may have more than half of the faces of our fullest frame. `Ours, limited` coarsens the objects "
    "whose error stays the smallest; shared equally, all objects of a frame over the limit get the same count.",
]


def build(results: Results) -> Table:
    rows = results.bench("scenes")
    rows = rows.assign(matched=rows["matched"].fillna(""))
    lines, notes = [], []
    for (scene, kind, tolerance), group in rows.groupby(["scene", "kind", "tolerance"], sort=False):
        cells = group.dropna(subset=["value"]).set_index(["method", "matched", "metric"])
        first = {"scene": scene, "kind": kind, "tolerance": tolerance}
        lines += [first | _line(cells, *way) for way in WAYS if (*way, "faces") in cells.index]
        notes.append(_said(first, cells) + _noted(group))
    frame = pd.DataFrame(lines)
    notes += [*limits_of(_shares(rows)), *NOTES]
    return Table("Scenes: the faces it takes to stay within the tolerance", frame, notes, _shown(frame))


def _shares(rows):
    """dict (rival, matched) -> shares of the faces that ours saves, one a scene and tolerance."""
    saved = rows[rows["metric"].str.startswith("saved_") & rows["kind"].notna()].dropna(subset=["value"])
    groups = saved.groupby(["metric", "matched"])["value"]
    return {(metric.removeprefix("saved_"), matched): list(shares) for (metric, matched), shares in groups}


def _line(cells, method, matched):
    line = {"method": method, "matched": matched}
    line |= {name: cells["value"].get((method, matched, name), float("nan")) for name in VALUES}
    saved = (OURS, matched, f"saved_{method}")
    for name in ("value", "low", "high"):
        line["saved" if name == "value" else f"saved_{name}"] = cells[name].get(saved, float("nan"))
    return line


def _said(first, cells):
    """What there is in a scene, and whether ours meets the target there."""
    there = cells.iloc[0]
    text = f"Scene {first['scene']}, tolerance {amount(first['tolerance'], UNITS[first['kind']])}: "
    text += f"{there['objects']:.0f} objects ({there['shapes']:.0f} different), {there['frames']:.0f} frames."
    held = cells["value"].get((OURS, "", "held")) == 1
    for rival in UNIFORM:
        saved, spread = (_saved(cells, rival, matched) for matched in ("error", "displacement"))
        if saved is not None:
            word = (
                on_target(*saved, at_least=TARGET, show=lambda share: f"{number(100 * share)} %") if held else "missed"
            )
            text += f" Against {NAMES[rival]} ours saves {_percent(saved)}; {WANTED}, is {word}."
        if spread is not None:
            text += f" At an equal mean displacement of all pixels it saves {_percent(spread)}."
    return text


def _noted(group):
    """What the rows say beside their values, such as why there are none; the limits are said by the table's lines."""
    noted = group[group["note"].notna() & (group["matched"] != "limit")] if "note" in group else group[:0]
    return "".join(f" {NAMES[row.method].capitalize()}: {row.note}."
                   for row in noted.drop_duplicates(["method", "note"]).itertuples())  # fmt: skip


def _saved(cells, rival, matched):
    """value, low and high of what ours saves at an equal `matched`, or None."""
    key = OURS, matched, f"saved_{rival}"
    return cells.loc[key, ["value", "low", "high"]].astype(float) if key in cells.index else None


def _percent(saved):
    return with_interval(*saved, scale=100, places=0) + " %"


def _shown(frame):
    shown = pd.DataFrame({"scene": frame["scene"]})
    shown["tolerance"] = [amount(row.tolerance, UNITS[row.kind]) for row in frame.itertuples()]
    limited = frame["matched"] == "limit"
    shown["levels chosen by"] = [NAMES[method] + (", limited" if limit and method == OURS else "")
                                 for method, limit in zip(frame["method"], limited, strict=True)]  # fmt: skip
    heads = {"faces": "faces a frame", "error": "frame error, mean", "error_worst": "worst frame"}
    for name, head in heads.items():
        shown[head] = frame[name].round() if name == "faces" else frame[name]
    shown["frames within, %"] = [number(100 * share, 2) for share in frame["held"]]
    shown["worst jump"] = frame["step_worst"]
    saved = frame[["saved", "saved_low", "saved_high"]].itertuples(index=False)
    shown["faces that ours saves, %"] = ["–" if row[0] != row[0] else with_interval(*row, scale=100, places=0)
                                         for row in saved]  # fmt: skip
    return shown
