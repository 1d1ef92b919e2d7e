"""Scenes along camera paths: faces and errors of each way to choose the levels of the objects (T3.1.3).

`random_table` is about scenes drawn at random, `scene_table` about one scene, `chart` about the random scenes or else
that scene, and `scenes` about all scenes of conf/scene. Each rival is compared with ours at an equal error,
displacement or limit of faces.
"""

from functools import partial
from typing import Any

import numpy as np
import pandas as pd

from stages.charts.drawing import GREY
from stages.charts.items import Figure, Table
from stages.charts.pareto import pareto_chart
from stages.charts.results import NotRun, Results, require_rows
from stages.charts.tables import grouped, interval_columns, number, percent, records, with_interval
from stages.engine.statistics import interval

# Two of the thirty random scenes share so much of their objects, in the mean: they count as repeated splits of the same
# objects with that share, as random sets of objects do (stages.report.touch.tables).
COMMON = 0.278
SHARED_OBJECTS = COMMON / (1 - COMMON)
over_scenes = partial(interval, shared=SHARED_OBJECTS)


NAMES = {
    "full": "full models",
    "uniform": "uniform levels by distance",
    "uniform_size": "uniform levels by size on the screen",
    "network": "the thesis's network",
    "ours_plain": "ours, salience left out",
    "ours": "ours",
    "equal": "ours, the limit shared equally",
    "online": "ours, no frame seen ahead",
    "online_unrendered": "the same, nothing rendered",
    "beforehand": "errors rendered beforehand",
    "every_level": "every level rendered in every frame",
}
COLOURS = {
    "full": "#222222", "uniform": "#E69F00", "uniform_size": "#D55E00", "network": "#CC79A7", "ours_plain": "#56B4E9",
    "ours": "#0072B2", "online": "#009E73", "beforehand": "#7A6A00", "every_level": "#882255",
}  # fmt: skip
UNITS = {"pixels": "pixels", "ssim": "1 − SSIM"}
OURS = "ours"
RANDOM = "household_scenes"  # the set with scenes drawn at random
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


Plan = tuple[str, str]  # a way to choose levels, and in what it was made equal to ours
PLANS = [
    ("full", ""), ("uniform", "displacement"), ("uniform_size", "displacement"), ("network", "displacement"),
    ("beforehand", "displacement"), ("every_level", "displacement"), (OURS, ""), ("online", ""),
    ("online_unrendered", ""), ("uniform", "error"), ("uniform_size", "error"),
]  # fmt: skip
OURS_PLAN, UNIFORM_LEVELS = (OURS, ""), ("uniform", "displacement")
EQUAL = {"": "", "displacement": "mean displacement", "error": "worst object's error"}
PLAN_COLUMNS = {"displacement_mean": ("displacement, px", 1, 2), "error": ("frame error, mean", 1, 2),
         "held": ("frames within, %", 100, 0), "switches_per_object": ("switches an object", 1, 1)}  # fmt: skip


def random_table(results: Results) -> Table:
    """A line for each plan: means over the scenes, with intervals over the scenes."""
    (wide, first), times = plans(results), _times(results)
    lines, frame = [], []
    for method, matched in (plan for plan in PLANS if plan in wide["faces"]):
        scenes = pd.DataFrame(wide.xs((method, matched), axis=1, level=["method", "matched"]))
        scenes = scenes.reindex(columns=["faces", *PLAN_COLUMNS, "step_worst", "planning_ms"]).dropna(subset=["faces"])
        comparable = matched == "displacement" or method == OURS
        ends = {
            "saved": over_scenes(saving(wide, OURS_PLAN, (method, matched))),
            "less": over_scenes(saving(wide, (method, matched), UNIFORM_LEVELS) if comparable else []),
            "drawing": times.get((method, matched), (np.nan,) * 3),
        }
        means = {name: scenes[name].mean() for name in PLAN_COLUMNS}
        medians = {name: scenes[name].median() for name in ("step_worst", "planning_ms")}
        entry = {"method": method, "matched": matched, "scenes": len(scenes), "faces": scenes["faces"].mean()}
        entry |= interval_columns("saved", ends["saved"]) | interval_columns("less", ends["less"]) | means | medians
        frame.append(entry | interval_columns("drawing", ends["drawing"]))
        saved, less = (with_interval(*ends[name], scale=100, places=0) for name in ("saved", "less"))
        lines.append({
            "levels chosen by": NAMES[method], "equal to ours in": EQUAL[matched],
            "faces a frame": entry["faces"].round(),
            "faces that ours saves, %": "–" if method == OURS else saved,
            "fewer than uniform levels by distance, %": less.replace("not run", "–"),
            **{head: f"{scale * entry[name]:.{places}f}" for name, (head, scale, places) in PLAN_COLUMNS.items()},
            "worst jump": entry["step_worst"], "planning, ms a frame": entry["planning_ms"],
            "drawing time / full": with_interval(*ends["drawing"], places=2).replace("not run", "–"),
        })  # fmt: skip
    words = {
        "scenes": len(wide),
        "tolerance": amount(first["tolerance"], UNITS[first["kind"]]), "foresight": _foresight(wide),
        "drawing": drawing(results), "planning": planning(results),
    }  # fmt: skip
    return Table(pd.DataFrame(frame), pd.DataFrame(lines), words)


def plans(results: Results) -> tuple[pd.DataFrame, pd.Series]:
    """(frame scenes x (metric, method, matched) over all frames, the first row) of the random scenes."""
    rows = results.measured("scene", RANDOM, frame="all", factor=1, item=None).fillna({"matched": ""})
    rows = require_rows(rows[rows["kind"].notna()], "no random scenes", "scene")
    columns = ["metric", "method", "matched"]
    return rows.pivot_table(index="group", columns=columns, values="value", sort=False), rows.iloc[0]


def saving(wide: pd.DataFrame, plan: Plan, rival: Plan) -> pd.Series:
    """The share of the faces of a rival that a plan saves, a value a scene; empty where either was not run."""
    if not {plan, rival} <= {*wide["faces"]}:
        return pd.Series(dtype=float)
    return (1 - wide["faces"][plan] / wide["faces"][rival]).dropna()


def _foresight(wide: pd.DataFrame) -> str:
    """The price of seeing no frame ahead, in faces, switches and jumps; empty where that was not planned."""
    if ("online", "") not in wide["faces"]:
        return ""
    ours, online = (wide.xs((name, ""), axis=1, level=["method", "matched"]) for name in (OURS, "online"))
    more = 100 * (online["faces"] / ours["faces"] - 1).dropna()
    switches, own_switches = (plan["switches_per_object"].mean() for plan in (online, ours))
    jumps, own_jumps = online["step_worst"], ours["step_worst"]
    return (
        f"Without a frame ahead: {with_interval(*over_scenes(more), places=1)} % more faces, {number(switches)} "
        f"switches an object instead of {number(own_switches)}, and a worst jump of {number(jumps.median())} instead "
        f"of {number(own_jumps.median())} (medians over the scenes; at most {number(jumps.max())} and "
        f"{number(own_jumps.max())})."
    )


def _times(results: Results) -> dict[Plan, tuple[float, float, float]]:
    """{plan: (mean, low, high) of the time of drawing over that of the full meshes}, over the scenes."""
    try:
        rows = results.bench("frame_times")
    except NotRun:
        return {}
    rows = rows[rows["method"] != "full"]
    ratios = {str(name): over_scenes(group["ratio"]) for name, group in rows.groupby("method", sort=False)}
    return {(name, "" if name in (OURS, "online") else "displacement"): ratio for name, ratio in ratios.items()}


def planning(results: Results) -> str:
    """The cost of planning a frame beside the drawing time that our levels save over uniform ones; empty if unknown."""
    try:
        wide, _ = plans(results)
        times = results.bench("frame_times").pivot(index="scene", columns="method", values="ms")
    except NotRun:
        return ""
    less = with_interval(*over_scenes(times["uniform"] - times[OURS]), places=1)
    costs = pd.DataFrame(wide["planning_ms"]).median().map(number)
    text = (
        f"Planning our levels costs {costs[OURS_PLAN]} ms a frame, and drawing them is {less} ms faster than drawing "
        "uniform ones."
    )
    looked_up, blind = ("beforehand", "displacement"), ("online_unrendered", "")
    if looked_up in costs and looked_up[0] in times:
        less = with_interval(*over_scenes(times["uniform"] - times[looked_up[0]]), places=1)
        text += (
            f" Looking up errors that were rendered beforehand costs {costs[looked_up]} ms, and drawing these levels "
            f"is {less} ms faster."
        )
    if blind in costs:
        saved = with_interval(*over_scenes(saving(wide, blind, UNIFORM_LEVELS)), 100, 0)
        text += (
            f" The plan that renders nothing costs {costs[blind]} ms and saves {saved} % of the faces of uniform "
            "levels by distance."
        )
    return text


def drawing(results: Results) -> str:
    """Processor milliseconds a frame of drawing each plan on a named renderer; empty where they were not measured."""
    try:
        rows = results.bench("frame_times")
    except NotRun:
        return ""
    ms = rows.groupby("method")[["faces", "ms"]].mean()
    texts = [f"{NAMES[row.Index]} {row.faces:,.0f} faces, {number(row.ms)} ms" for row in records(ms)]
    wide = rows.pivot(index="scene", columns="method", values="ms")
    device = rows["device"].iloc[0].partition(" (")[0]
    return (
        f"Drawing: processor milliseconds of pyrender on {device}, a software rasteriser, one thread, screens of "
        f"{rows['rows'].iloc[0]} rows, {len(wide)} scenes: {'; '.join(texts)}. Ours takes "
        f"{with_interval(*over_scenes(wide[OURS] / wide['uniform']), places=2)} of the time of uniform levels."
    )


EQUAL_IN = {"": "", "error": "mean frame error", "displacement": "mean displacement", "held": "every frame holds",
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
    parts = [f"{text[key]} % against {NAMES[key[0]]} ({EQUAL_IN[key[1]]})" for key in SHOWN if key in text]
    text_table = wide.reindex(columns=list(COLUMNS)).assign(faces=wide["faces"].round())
    text_table = text_table.assign(held=text_table["held"].map(percent)).map(number).rename(columns=COLUMNS)
    text_table["faces that ours saves, %"] = [text.get(key, "–") for key in wide.index]
    text_table = text_table.assign(seconds=wide["seconds"].map(number)).replace({"0.000": "0"})
    text_table = text_table.rename(SPOKEN, level="method").rename(EQUAL_IN, level="matched")
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
