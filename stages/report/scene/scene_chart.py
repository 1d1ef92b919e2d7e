"""A scene: the error of the rendered frames against the faces that they take, by every way to choose the levels."""

from stages.report.items import Figure
from stages.report.pareto import pareto_chart
from stages.report.results import NotRun, Results
from stages.report.style import GREY

from .rows import COLOURS, NAMES, amount, of_scene, scene_rows

REFERENCE = "full"


def build(results: Results) -> Figure:
    rows = scene_rows(results, frame="all", metric=["faces", "error"])
    scene, _, unit = of_scene(rows)
    rows = rows[rows["matched"].isin(["", "error"]) & rows["method"].isin(NAMES)]
    wide = rows.pivot_table(index=["method", "tolerance"], columns="metric", values="value", sort=False).reset_index()
    if REFERENCE not in set(wide["method"]):
        raise NotRun("the full models are not measured", "scene")
    wide = wide.sort_values("tolerance", kind="stable")  # the legend's order
    wide["tolerance"] = [amount(value, unit) for value in wide["tolerance"]]
    wide["name"] = [_name(row) for row in wide.itertuples()]
    wide["way"] = wide["method"].map(NAMES)
    chart = pareto_chart(
        wide, "faces", "error", "name", name="scene", title=f"Scene {scene}: faces against what shows",
        reference=NAMES[REFERENCE], quality_label=f"error of the rendered frames, mean, {unit}", better="low",
        folder=results.reports / "tradeoff", colour="way", marker="tolerance",
        tints={name: COLOURS.get(method, GREY) for method, name in NAMES.items() if method in set(wide["method"])},
    )  # fmt: skip
    full = wide.loc[wide["method"] == REFERENCE, "faces"].iloc[0]
    chart.caption = (
        f"Down and left is better; cost is the faces of a frame, 1 is the full models' {full:,.0f}. At each tolerance "
        "ours is planned, and the others are tuned to the same mean error of the rendered frames, where they can."
    )
    return chart


def _name(row):
    return NAMES[row.method] if row.method == REFERENCE else f"{NAMES[row.method]}, {row.tolerance}"
