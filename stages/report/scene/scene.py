"""A scene along a camera path: faces and errors of every way to choose the levels of its objects."""

from collections.abc import Mapping
from typing import Any

import pandas as pd

from stages.report.grid import percent, records
from stages.report.items import Figure, Table
from stages.report.markdown import number
from stages.report.pareto import pareto_chart
from stages.report.results import NotRun, Results
from stages.report.style import GREY

from .rows import COLOURS, NAMES, OURS, amount, left_of, of_scene, savings, scene_rows

MATCHED = {"": "", "error": "mean frame error", "displacement": "mean displacement", "held": "every frame holds",
           "asked": "nothing: as it answers", "limit": "limit of half our faces"}  # fmt: skip
COLUMNS = {
    "faces": "faces a frame", "error": "frame error, mean", "error_worst": "worst frame", "held": "frames within, %",
    "displacement_mean": "displacement, mean px", "displacement_99.9": "99.9 %, px",
    "salient_displacement": "where one looks, px", "ssim_error": "1 − SSIM of the frames", "step_worst": "worst jump",
}  # fmt: skip
SAID = [("uniform", "error"), ("uniform_size", "error"), ("uniform", "displacement"), ("uniform_size", "displacement"),
        ("uniform", "held")]  # fmt: skip
MEASURES = {"rms": "root mean square", "q95": "95 % quantile", "q99": "99 % quantile", "max": "maximum"}
SPOKEN = NAMES | {f"unrendered_{name}": f"the levels' own surfaces, {words}" for name, words in MEASURES.items()}
REFERENCE = "full"


def build(results: Results) -> Table:
    """A line for each way to choose levels and what was made equal to ours."""
    rows = scene_rows(results, frame="all")
    scene, tolerance, unit = of_scene(rows)
    rows = rows[(rows["factor"] == 1) & rows["item"].isna()]
    wide = rows.pivot_table(index=["method", "matched"], columns="metric", values="value", sort=False)
    wide["seconds"] = rows.groupby(["method", "matched"])["seconds"].max()
    wide, saved = wide[wide["faces"].notna()].reset_index(), savings(rows)
    text = {(row.rival, row.matched): row.text for row in records(saved)}
    found = [f"{text[key]} % against {NAMES[key[0]]} ({MATCHED[key[1]]})" for key in SAID if key in text]
    words = {
        "scene": scene,
        "tolerance": amount(tolerance, unit),
        "saved": f"{NAMES[OURS].capitalize()} saves {'; '.join(found)}." if found else "",
        "left": left_of(saved),
        "noted": _noted(results),
    }
    return Table(wide, _shown(wide, text), words)


def _noted(results: Results) -> str:
    """What the rows say beside their values, or instead of them."""
    rows = results.rows("scene", frame="all", factor=1).dropna(subset=["note"]).drop_duplicates(["method", "note"])
    return "\n".join(f"{NAMES.get(row.method, row.method)}: {row.note}." for row in records(rows))


def _shown(wide: pd.DataFrame, saved: Mapping[Any, str]) -> pd.DataFrame:
    shown = wide.reindex(columns=list(COLUMNS)).assign(faces=wide["faces"].round())
    shown = shown.assign(held=shown["held"].map(percent)).map(number).rename(columns=COLUMNS)
    shown.insert(0, "levels chosen by", wide["method"].replace(SPOKEN))
    shown.insert(1, "equal to ours in", wide["matched"].map(MATCHED))
    keys = zip(wide["method"], wide["matched"], strict=True)
    shown["faces that ours saves, %"] = [saved.get(key, "–") for key in keys]
    return shown.assign(seconds=wide["seconds"].map(number)).replace({"0.000": "0"})


def chart(results: Results) -> Figure:
    """The error of the rendered frames against the faces that they take, by every way to choose the levels."""
    rows = scene_rows(results, frame="all", metric=["faces", "error"])
    scene, _, unit = of_scene(rows)
    rows = rows[rows["matched"].isin(["", "error"]) & rows["method"].isin(NAMES)]
    wide = rows.pivot_table(index=["method", "tolerance"], columns="metric", values="value", sort=False).reset_index()
    full = wide.loc[wide["method"] == REFERENCE, "faces"]
    if full.empty:
        raise NotRun("the full models are not measured", "scene")
    wide = wide.sort_values("tolerance", kind="stable")  # the legend's order
    wide["tolerance"] = [amount(value, unit) for value in wide["tolerance"]]
    wide["way"] = wide["method"].map(NAMES)
    wide.insert(4, "name", (wide["way"] + ", " + wide["tolerance"]).where(wide["method"] != REFERENCE, wide["way"]))
    figure = pareto_chart(
        wide, "error", title=f"Scene {scene}: faces against what shows", reference=NAMES[REFERENCE],
        quality_label=f"error of the rendered frames, mean, {unit}", cost="faces", better="low", colour="way",
        marker="tolerance",
        tints={name: COLOURS.get(method, GREY) for method, name in NAMES.items() if method in set(wide["method"])},
    )  # fmt: skip
    figure.words["full"] = full.iloc[0]
    return figure
