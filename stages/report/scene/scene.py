"""Scenes along camera paths: faces and errors of each way to choose the levels of the objects (T3.1.3).

`scene_table` is about one scene, `chart` about the random scenes or else that scene, and `scenes` about all scenes of
conf/scene. Each rival is compared with ours at an equal error, displacement or limit of faces.
"""

import pandas as pd

from stages.engine.statistics import interval
from stages.report.drawing import GREY
from stages.report.items import Figure, Table
from stages.report.pareto import pareto_chart
from stages.report.results import Results
from stages.report.tables import grouped, interval_columns, number, percent, records

from .random import (
    COLOURS,
    EQUAL,
    NAMES,
    OURS,
    RANDOM,
    UNIFORM,
    UNITS,
    amount,
    drawing,
    left_of,
    planning,
    savings,
    scene_rows,
)

MATCHED = {"": "", "error": "mean frame error", "displacement": "mean displacement", "held": "every frame holds",
           "asked": "nothing: as it answers", "limit": "limit of half our faces"}  # fmt: skip
COLUMNS = {
    "faces": "faces a frame", "error": "frame error, mean", "error_worst": "worst frame", "held": "frames within, %",
    "displacement_mean": "displacement, mean px", "displacement_99.9": "99.9 %, px",
    "salient_displacement": "where one looks, px", "ssim_error": "1 − SSIM of the frames", "step_worst": "worst jump",
    "planning_ms": "planning, ms a frame",
}  # fmt: skip
SHOWN = [("uniform", "error"), ("uniform_size", "error"), ("uniform", "displacement"), ("uniform_size", "displacement"),
        ("uniform", "held")]  # fmt: skip
MEASURES = {"rms": "root mean square", "q95": "95 % quantile", "q99": "99 % quantile", "max": "maximum"}
SPOKEN = NAMES | {f"unrendered_{name}": f"the levels' own surfaces, {words}" for name, words in MEASURES.items()}
REFERENCE = "full"


def scene_table(results: Results) -> Table:
    """A line for each way to choose levels and what was made equal to ours."""
    rows, scene, tolerance, unit = scene_rows(results, frame="all", factor=1, item=None)
    wide = rows.pivot_table(index=["method", "matched"], columns="metric", values="value", sort=False)
    wide["seconds"] = rows.groupby(["method", "matched"])["seconds"].max()
    wide, saved = wide[wide["faces"].notna()], savings(rows)
    text = {(row.rival, row.matched): row.text for row in records(saved)}
    parts = [f"{text[key]} % against {NAMES[key[0]]} ({MATCHED[key[1]]})" for key in SHOWN if key in text]
    text_table = wide.reindex(columns=list(COLUMNS)).assign(faces=wide["faces"].round())
    text_table = text_table.assign(held=text_table["held"].map(percent)).map(number).rename(columns=COLUMNS)
    text_table["faces that ours saves, %"] = [text.get(key, "–") for key in wide.index]
    text_table = text_table.assign(seconds=wide["seconds"].map(number)).replace({"0.000": "0"})
    text_table = text_table.rename(SPOKEN, level="method").rename(MATCHED, level="matched")
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
    """The error of the rendered frames against the faces that they take, by every way to choose the levels.

    Means over the scenes drawn at random; without these, of the one scene that was measured.
    """
    rows = results.measured("scene", results.printed(RANDOM, "scene"), frame="all", metric=["faces", "error"])
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
    figure = pareto_chart(
        frame, "error", title=f"{subject}: faces against what shows", reference=NAMES[REFERENCE],
        quality_label=f"error of the rendered frames, mean, {unit}", cost="faces", better="low", colour="way",
        marker=marker, clock="", units=pd.DataFrame(errors),
        legends={"matched": "equal to ours in", "faces": "faces a frame"},
        tints={name: COLOURS.get(method, GREY) for method, name in NAMES.items() if method in set(frame["method"])},
    )  # fmt: skip
    figure.words |= {"drawing": drawing(results), "planning": planning(results) if len(scenes) > 1 else ""}
    return figure


WAYS = [("full", ""), ("uniform", "error"), ("uniform_size", "error"), ("network", "error"), (OURS, ""),
        ("online", ""), (OURS, "limit"), ("equal", "limit")]  # fmt: skip
SCENE, WAY = ["scene", "kind", "tolerance"], ["method", "matched"]
VALUES = ["faces", "error", "error_worst", "held", "step_worst"]
SAVED = {"value": "saved", "low": "saved_low", "high": "saved_high"}


def scenes(results: Results) -> Table:
    """A line for each scene and way to choose levels; what there is in each scene."""
    rows = results.bench("scenes").fillna({"matched": ""})
    scenes = dict(list(rows.groupby(SCENE, sort=False)))
    lines = pd.MultiIndex.from_tuples([(*scene, *way) for scene in scenes for way in WAYS], names=[*SCENE, *WAY])
    wide = rows.dropna(subset=["value"]).pivot(index=lines.names, columns="metric", values="value")
    saved = savings(rows).rename(columns={"method": "ours", "rival": "method", **SAVED}).set_index(lines.names)
    frame = wide.reindex(lines).reindex(columns=VALUES).dropna(subset=["faces"]).join(saved[[*SAVED.values(), "text"]])
    frame = frame.reset_index()
    limited = (frame["matched"] == "limit") & (frame["method"] == OURS)
    text_columns = {
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
        "scenes": "\n".join(map(_sentence, scenes.values())),
        "left": left_of(savings(rows)),
        "planning": planning(results),
    }
    return Table(frame.drop(columns="text"), pd.DataFrame(text_columns), words)


def _sentence(rows: pd.DataFrame) -> str:
    """The objects of a scene, the savings of ours there, and the notes but for those on limits."""
    first = next(iter(records(rows.dropna(subset=["value"]))))
    text = f"Scene {first.scene}, tolerance {amount(first.tolerance, UNITS[first.kind])}: "
    text += f"{first.objects:.0f} objects ({first.shapes:.0f} different), {first.frames:.0f} frames."
    saved = {(row.rival, row.matched): row for row in records(savings(rows))}
    for rival in UNIFORM:
        if saving := saved.get((rival, "error")):
            text += f" Against {NAMES[rival]} ours saves {saving.text} % at an equal mean error."
        if saving := saved.get((rival, "displacement")):
            text += f" At an equal mean displacement of all pixels it saves {saving.text} %."
    noted = rows[rows["matched"] != "limit"].dropna(subset=["note"]).drop_duplicates(["method", "note"])
    return text + "".join(f" {NAMES[row.method].capitalize()}: {row.note}." for row in records(noted))
