"""A scene along a camera path: faces and errors of each way to choose the levels of the objects (T3.1.3).

Each rival is compared with ours at an equal error or displacement.
"""

from typing import Any

import numpy as np
import pandas as pd

from stages.charts.drawing import GREY
from stages.charts.items import Figure, Table
from stages.charts.pareto import pareto_chart
from stages.charts.results import Results
from stages.charts.tables import grouped, interval_columns, number, percent, records, with_interval
from stages.engine.statistics import interval

NAMES = {
    "full": "full models",
    "uniform": "uniform levels by distance",
    "uniform_size": "uniform levels by size on the screen",
    "network": "the thesis's network",
    "ours_plain": "ours, salience left out",
    "ours": "ours",
}
COLOURS = {
    "full": "#222222", "uniform": "#E69F00", "uniform_size": "#D55E00", "network": "#CC79A7", "ours_plain": "#56B4E9",
    "ours": "#0072B2",
}  # fmt: skip
UNITS = {"pixels": "pixels", "ssim": "1 − SSIM"}
OURS = "ours"
UNIFORM = ("uniform", "uniform_size")


def scene_rows(results: Results, **where: Any) -> tuple[pd.DataFrame, str, float, str]:
    """(rows of the stage with a value and no gaps in `matched`, the scene, the first tolerance, its unit in words)."""
    rows = results.measured("scene", **where).fillna({"matched": ""})
    first = rows.dropna(subset=["tolerance"]).iloc[0]
    return rows, first["group"], float(first["tolerance"]), UNITS[first["kind"]]


def amount(value: float, unit: str) -> str:
    """A tolerance in words: 1 pixel, 0.5 pixels."""
    return f"{value:g} {unit.removesuffix('s') if value == 1 else unit}"


def savings(rows: pd.DataFrame) -> pd.DataFrame:
    """The rows on the share of the faces that ours saves: value, low, high, the `rival`, and in per cent as `text`."""
    saved = rows[rows["metric"].str.startswith("saved_")].dropna(subset=["kind", "value"])
    text = [with_interval(row.value, row.low, row.high, 100, 0) for row in records(saved)]
    return saved.assign(rival=saved["metric"].str.removeprefix("saved_"), text=text)


def left_of(saved: pd.DataFrame) -> str:
    """How much of `savings` at an equal error is left at an equal displacement; empty where that is not measured."""
    shares = {key: list(values) for key, values in saved.groupby(["rival", "matched"])["value"]}
    pairs = {name: (shares[name, "error"], shares[name, "displacement"]) for name in UNIFORM
             if {(name, "error"), (name, "displacement")} <= set(shares)}  # fmt: skip
    if not pairs:
        return ""
    equal, spread = (np.mean(np.concatenate(amounts)) for amounts in zip(*pairs.values(), strict=True))
    part = "most" if spread < equal / 2 else "part"
    outcome = "the saving is no smaller" if spread >= equal else f"{part} of the saving vanishes"
    texts = [
        f"{_range(amounts)} instead of {_range(base)} against {NAMES[name]}" for name, (base, amounts) in pairs.items()
    ]
    return f" At an equal mean displacement of all pixels {outcome}: {'; '.join(texts)}."


def _range(shares: list[float]) -> str:
    """Shares as percent: 12 %, or 3 to 40 %."""
    return " to ".join(dict.fromkeys(f"{round(100 * share):d}" for share in (min(shares), max(shares)))) + " %"


EQUAL_IN = {"": "", "error": "mean frame error", "displacement": "mean displacement", "held": "every frame holds",
           "asked": "nothing: as it answers"}  # fmt: skip
COLUMNS = {
    "faces": "faces a frame", "error": "frame error, mean", "error_worst": "worst frame", "held": "frames within, %",
    "displacement_mean": "displacement, mean px", "displacement_99.9": "99.9 %, px",
    "salient_displacement": "where one looks, px", "ssim_error": "1 − SSIM of the frames", "step_worst": "worst jump",
    "planning_ms": "planning, ms a frame",
}  # fmt: skip
SHOWN = [("uniform", "error"), ("uniform_size", "error"), ("uniform", "displacement"), ("uniform_size", "displacement"),
        ("uniform", "held")]  # fmt: skip
EQUAL = {"": "", "displacement": "mean displacement", "error": "worst object's error"}  # of the chart
REFERENCE = "full"


def scene_table(results: Results) -> Table:
    """A line for each way to choose levels and what was made equal to ours."""
    rows, scene, tolerance, unit = scene_rows(results, frame="all", factor=1, item=None)
    wide = rows.pivot_table(index=["method", "matched"], columns="metric", values="value", sort=False)
    wide["seconds"] = rows.groupby(["method", "matched"])["seconds"].max()
    wide, saved = wide[wide["faces"].notna()], savings(rows)
    text = {(row.rival, row.matched): row.text for row in records(saved)}
    parts = [f"{text[key]} % against {NAMES[key[0]]} ({EQUAL_IN[key[1]]})" for key in SHOWN if key in text]
    text_table = wide.reindex(columns=list(COLUMNS)).assign(faces=wide["faces"].round())
    text_table = text_table.assign(held=text_table["held"].map(percent)).map(number).rename(columns=COLUMNS)
    text_table["faces that ours saves, %"] = [text.get(key, "–") for key in wide.index]
    text_table = text_table.assign(seconds=wide["seconds"].map(number)).replace({"0.000": "0"})
    text_table = text_table.rename(NAMES, level="method").rename(EQUAL_IN, level="matched")
    text_table = text_table.rename_axis(["levels chosen by", "equal to ours in"]).reset_index()
    notes = results.rows("scene", frame="all", factor=1).dropna(subset=["note"]).drop_duplicates(["method", "note"])
    words = {
        "scene": scene,
        "tolerance": amount(tolerance, unit),
        "saved": f"{NAMES[OURS].capitalize()} saves {'; '.join(parts)}." if parts else "",
        "left": left_of(saved),
        "noted": "\n".join(f"{NAMES.get(row.method, row.method)}: {row.note}." for row in records(notes)),
    }
    return Table(wide.reset_index(), text_table, words)


def chart(results: Results) -> Figure:
    """The error of the rendered frames against the faces that they take, by every way to choose the levels."""
    rows = results.measured("scene", frame="all", metric=["faces", "error"])
    rows = rows.fillna({"matched": ""})
    rows = rows[rows["matched"].isin(EQUAL) & rows["method"].isin(NAMES)].dropna(subset=["tolerance"])
    unit, scenes = UNITS[rows["kind"].iloc[0]], list(dict.fromkeys(rows["group"]))
    lines, errors = [], {}
    for (tolerance, method, matched), group in grouped(rows, ["tolerance", "method", "matched"]):
        way = NAMES[method]
        name = way if method == REFERENCE else ", ".join(filter(None, (way, amount(tolerance, unit), EQUAL[matched])))
        wide = group.pivot(index="group", columns="metric", values="value")
        errors[name], ends = wide["error"], interval_columns("error", interval(wide["error"]), prefix="")
        lines.append({"method": method, "way": way, "name": name, "tolerance": tolerance, "matched": EQUAL[matched],
                      "faces": wide["faces"].mean(), **ends})  # fmt: skip
    frame = pd.DataFrame(lines).sort_values("tolerance", kind="stable").drop_duplicates("name")
    marker = "tolerance" if frame["tolerance"].nunique() > 1 else "matched"
    frame["tolerance"] = [amount(value, unit) for value in frame["tolerance"]]
    frame["matched"] = frame["matched"].replace("", "nothing: as planned")
    subject = f"{len(scenes)} random scenes" if len(scenes) > 1 else f"Scene {scenes[0]}"
    return pareto_chart(
        frame, "error", title=f"{subject}: faces against what shows", reference=NAMES[REFERENCE],
        quality_label=f"error of the rendered frames, mean, {unit}", cost="faces", better="low", colour="way",
        marker=marker, clock="", units=pd.DataFrame(errors),
        legends={"matched": "equal to ours in", "faces": "faces a frame"},
        tints={name: COLOURS.get(method, GREY) for method, name in NAMES.items() if method in set(frame["method"])},
    )  # fmt: skip
