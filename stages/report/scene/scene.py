"""A scene along a camera path: faces and errors of every way to choose the levels of its objects."""

import pandas as pd

from stages.kit.stats import interval
from stages.report.grid import grouped, percent, records
from stages.report.items import Figure, Table
from stages.report.markdown import number
from stages.report.pareto import pareto_chart
from stages.report.results import Results
from stages.report.style import GREY

from .random import EQUAL, drawing, planning
from .rows import COLOURS, NAMES, OURS, RANDOM, UNITS, amount, left_of, savings, scene_rows

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
    """The error of the rendered frames against the faces that they take, by every way to choose the levels.

    Means over the scenes drawn at random; without these, of the one scene that was measured.
    """
    rows = results.measured("scene", results.printed(RANDOM, "scene"), frame="all", metric=["faces", "error"])
    rows = rows.fillna({"matched": ""})
    rows = rows[rows["matched"].isin(EQUAL) & rows["method"].isin(NAMES)].dropna(subset=["tolerance"])
    unit, scenes = UNITS[rows["kind"].iloc[0]], list(dict.fromkeys(rows["group"]))
    lines, errors = [], {}
    for (tolerance, method, matched), own in grouped(rows, ["tolerance", "method", "matched"]):
        way = NAMES[method]
        name = way if method == REFERENCE else ", ".join(filter(None, (way, amount(tolerance, unit), EQUAL[matched])))
        wide = own.pivot(index="group", columns="metric", values="value")
        errors[name], ends = wide["error"], dict(zip(("error", "low", "high"), interval(wide["error"]), strict=True))
        lines.append({"method": method, "way": way, "name": name, "tolerance": tolerance, "matched": EQUAL[matched],
                      "faces": wide["faces"].mean(), **ends})  # fmt: skip
    frame = pd.DataFrame(lines).sort_values("tolerance", kind="stable").drop_duplicates("name")
    marker = "tolerance" if frame["tolerance"].nunique() > 1 else "matched"
    frame["tolerance"] = [amount(value, unit) for value in frame["tolerance"]]
    frame["matched"] = frame["matched"].replace("", "nothing: as planned")
    what = f"{len(scenes)} random scenes" if len(scenes) > 1 else f"Scene {scenes[0]}"
    figure = pareto_chart(
        frame, "error", title=f"{what}: faces against what shows", reference=NAMES[REFERENCE],
        quality_label=f"error of the rendered frames, mean, {unit}", cost="faces", better="low", colour="way",
        marker=marker, clock="", units=pd.DataFrame(errors),
        legends={"matched": "equal to ours in", "faces": "faces a frame"},
        tints={name: COLOURS.get(method, GREY) for method, name in NAMES.items() if method in set(frame["method"])},
    )  # fmt: skip
    figure.words |= {"drawing": drawing(results), "planning": planning(results) if len(scenes) > 1 else ""}
    return figure
