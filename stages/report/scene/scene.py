"""A scene along a camera path: faces and errors of every way to choose the levels of its objects."""

from stages.report.grid import percent, records
from stages.report.items import Figure, Table
from stages.report.markdown import number
from stages.report.pareto import pareto_chart
from stages.report.results import Results
from stages.report.style import GREY

from .rows import COLOURS, NAMES, OURS, amount, left_of, savings, scene_rows

MATCHED = {"": "", "error": "mean frame error", "displacement": "mean displacement", "held": "every frame holds",
           "asked": "nothing: as it answers", "limit": "limit of half our faces"}  # fmt: skip
COLUMNS = {
    "faces": "faces a frame", "error": "frame error, mean", "error_worst": "worst frame", "held": "frames within, %",
    "displacement_mean": "displacement, mean px", "displacement_99.9": "99.9 %, px",
    "salient_displacement": "where one looks, px", "ssim_error": "1 − SSIM of the frames", "step_worst": "worst jump",
    "planning_ms": "planning, ms a frame",
}  # fmt: skip
SAID = [("uniform", "error"), ("uniform_size", "error"), ("uniform", "displacement"), ("uniform_size", "displacement"),
        ("uniform", "held")]  # fmt: skip
MEASURES = {"rms": "root mean square", "q95": "95 % quantile", "q99": "99 % quantile", "max": "maximum"}
SPOKEN = NAMES | {f"unrendered_{name}": f"the levels' own surfaces, {words}" for name, words in MEASURES.items()}
REFERENCE = "full"


def build(results: Results) -> Table:
    """A line for each way to choose levels and what was made equal to ours."""
    rows, scene, tolerance, unit = scene_rows(results, frame="all", factor=1, item=None)
    wide = rows.pivot_table(index=["method", "matched"], columns="metric", values="value", sort=False)
    wide["seconds"] = rows.groupby(["method", "matched"])["seconds"].max()
    wide, saved = wide[wide["faces"].notna()], savings(rows)
    text = {(row.rival, row.matched): row.text for row in records(saved)}
    found = [f"{text[key]} % against {NAMES[key[0]]} ({MATCHED[key[1]]})" for key in SAID if key in text]
    shown = wide.reindex(columns=list(COLUMNS)).assign(faces=wide["faces"].round())
    shown = shown.assign(held=shown["held"].map(percent)).map(number).rename(columns=COLUMNS)
    shown["faces that ours saves, %"] = [text.get(key, "–") for key in wide.index]
    shown = shown.assign(seconds=wide["seconds"].map(number)).replace({"0.000": "0"})
    shown = shown.rename(SPOKEN, level="method").rename(MATCHED, level="matched")
    shown = shown.rename_axis(["levels chosen by", "equal to ours in"]).reset_index()
    notes = results.rows("scene", frame="all", factor=1).dropna(subset=["note"]).drop_duplicates(["method", "note"])
    words = {
        "scene": scene,
        "tolerance": amount(tolerance, unit),
        "saved": f"{NAMES[OURS].capitalize()} saves {'; '.join(found)}." if found else "",
        "left": left_of(saved),
        "noted": "\n".join(f"{NAMES.get(row.method, row.method)}: {row.note}." for row in records(notes)),
    }
    return Table(wide.reset_index(), shown, words)


def chart(results: Results) -> Figure:
    """The error of the rendered frames against the faces that they take, by every way to choose the levels."""
    rows, scene, _, unit = scene_rows(results, frame="all", metric=["faces", "error"])
    rows = rows[rows["matched"].isin(["", "error"]) & rows["method"].isin(NAMES)]
    wide = rows.pivot_table(index=["method", "tolerance"], columns="metric", values="value", sort=False).reset_index()
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
    figure.words["full"] = wide.loc[wide["method"] == REFERENCE, "faces"].iloc[0]
    return figure
