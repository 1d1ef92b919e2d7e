"""A scene along a camera path: faces and errors of every way to choose the levels of its objects."""

import pandas as pd

from stages.report.items import Table
from stages.report.markdown import number, with_interval
from stages.report.results import Results

from .rows import NAMES, OURS, amount, limits_of, of_scene, scene_rows

MATCHED = {"": "", "error": "mean frame error", "displacement": "mean displacement", "held": "every frame holds",
           "asked": "nothing: as it answers", "limit": "limit of half our faces"}  # fmt: skip
COLUMNS = {
    "faces": "faces a frame", "error": "frame error, mean", "error_worst": "worst frame", "held": "frames within, %",
    "displacement_mean": "displacement, mean px", "displacement_99.9": "99.9 %, px",
    "salient_displacement": "where one looks, px", "ssim_error": "1 − SSIM of the frames", "step_worst": "worst jump",
}  # fmt: skip
UNRENDERED = "unrendered_"
MEASURES = {"rms": "root mean square", "q95": "95 % quantile", "q99": "99 % quantile", "max": "maximum"}
NOTES = [
    "Frame error: the largest over the objects of the 99 % quantile of the displacement on the screen, over the pixels "
    "in which the object is seen in the rendered full frame or in the rendered simplified one. Displacement: distance "
    "to the other surface in pixels at that depth.",
    "The others have one factor, tuned until the column `equal to ours in` is at least ours in the rendered frames: "
    "the faces are then theirs at no smaller an error. `Every frame holds`: tuned until none breaks the tolerance.",
    "All choose from the same levels, two a halving of the faces. Uniform levels: the share of an object's own faces "
    "is halved with each doubling of the distance. The network learned from objects that are not in the scene; its "
    "counts are tuned by one factor.",
    "Limit: half of the faces of our fullest frame. Frames above it are coarsened where the error stays the smallest, "
    "or all objects of such a frame get the same count.",
    "Planned by the levels' own surfaces: the same search without rendering, from one measure of each level's distance "
    "to the full mesh. A measure will do where all frames hold.",
    "Intervals: bootstrap over the different objects of this one scene.",
]


def build(results: Results) -> Table:
    rows = scene_rows(results, frame="all")
    scene, tolerance, unit = of_scene(rows)
    rows = rows[(rows["factor"] == 1) & rows["item"].isna()]
    wide = rows.pivot_table(index=["method", "matched"], columns="metric", values="value", sort=False)
    wide["seconds"] = rows.groupby(["method", "matched"])["seconds"].max()
    saved = {(row.metric.removeprefix("saved_"), row.matched): (row.value, row.low, row.high)
             for row in rows[rows["metric"].str.startswith("saved_")].itertuples()}  # fmt: skip
    wide = wide[wide["faces"].notna()].reset_index()
    title = f"Scene {scene}: the faces it takes to stay within {amount(tolerance, unit)}"
    limits = limits_of({key: [value] for key, (value, *_) in saved.items()})
    return Table(title, wide, [*_said(saved), *limits, *NOTES, *_why(results)], _shown(wide, saved))


def _why(results):
    """What the rows say beside their values, or instead of them."""
    rows = results.rows("scene", frame="all", factor=1)
    rows = rows[rows["note"].notna()].drop_duplicates(["method", "note"])
    return [f"{NAMES.get(row.method, row.method)}: {row.note}." for row in rows.itertuples()]


def _shown(wide, saved):
    lines = []
    for _, row in wide.iterrows():
        key = row["method"], row["matched"]
        line = {"levels chosen by": _spoken(row["method"]), "equal to ours in": MATCHED[row["matched"]]}
        for metric, head in COLUMNS.items():
            value = row.get(metric, float("nan"))
            value = round(value) if metric == "faces" else value
            line[head] = f"{100 * value:.0f}" if metric == "held" else number(value)
        line["faces that ours saves, %"] = with_interval(*saved[key], scale=100, places=0) if key in saved else "–"
        lines.append(line | {"seconds": number(row["seconds"])})
    return pd.DataFrame(lines).replace({"0.000": "0"})


def _spoken(method):
    if method.startswith(UNRENDERED):
        return f"the levels' own surfaces, {MEASURES[method.removeprefix(UNRENDERED)]}"
    return NAMES.get(method, method)


def _said(saved):
    """What ours saves, in a sentence."""
    wanted = [("uniform", "error"), ("uniform_size", "error"), ("uniform", "displacement"),
              ("uniform_size", "displacement"), ("uniform", "held")]  # fmt: skip
    found = [f"{with_interval(*saved[key], scale=100, places=0)} % against {NAMES[key[0]]} ({MATCHED[key[1]]})"
             for key in wanted if key in saved]  # fmt: skip
    return [f"{NAMES[OURS].capitalize()} saves {'; '.join(found)}."] if found else []
