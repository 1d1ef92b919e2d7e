"""Random scenes, the faces that tasks need, and the claims on both; the unit is the scene, or the object."""

from functools import partial
from typing import Any

import numpy as np
import pandas as pd

from stages.engine.statistics import interval
from stages.report.claims import Claim, reading
from stages.report.drawing import CYCLE, INK, plain_logarithm, plt
from stages.report.effects import side, statistic
from stages.report.items import Figure, Table
from stages.report.results import NotRun, Results, some
from stages.report.tables import interval_columns, number, records, with_interval

STAGE = "face_needs"
TASKS = {  # words, what the condition is multiplied by in them, colour
    "seen": ("seen from {:g} m", 1, CYCLE[0]), "felt": ("felt, within {:g} % of full scale", 100, CYCLE[1]),
    "recognised": ("recognised by touch, within {:g} points", 100, CYCLE[2]),
}  # fmt: skip
# Two of the thirty random scenes share so much of their objects, in the mean: they count as repeated splits of the same
# objects with that share, as random sets of objects do (stages.report.touch.rows).
COMMON = 0.278
SHARED_OBJECTS = COMMON / (1 - COMMON)
over_scenes = partial(interval, shared=SHARED_OBJECTS)


def needs(results: Results) -> Table:
    """A line for each task: the median over the objects with its interval, and the range of nine in ten."""
    rows, lines, frame = _rows(results), [], []
    full = rows[rows["task"] == "full"].set_index("item")["value"]
    for (task, condition), group in _tasks(rows):
        faces = group.set_index("item")["value"]
        share = 100 * faces / full[faces.index]
        median, (least, most) = interval(faces, statistic=np.median), np.quantile(faces, [0.05, 0.95])
        frame.append({"task": task, "condition": condition, "objects": len(faces),
                      **interval_columns("median", median, prefix=""), "q05": least, "q95": most,
                      "share": share.median()})  # fmt: skip
        lines.append({
            "task": words_of(task, condition), "faces, median": with_interval(*median, places=0),
            "nine in ten objects": f"{least:,.0f} to {most:,.0f}",
            "of the full mesh, %": with_interval(*interval(share, statistic=np.median), places=1),
        })  # fmt: skip
    accuracy = 100 * _rows(results, "accuracy")["value"]
    together = _rows(results, "faces_together")["value"].iloc[0]
    words = {"objects": len(full), "full": f"{full.median():,.0f}", "together": f"{together:,.0f}",
             "accuracy": with_interval(*interval(accuracy), places=0)}  # fmt: skip
    return Table(pd.DataFrame(frame), pd.DataFrame(lines), words)


def needs_figure(results: Results) -> Figure:
    """A dot an object and task, sorted by the faces that it needs, with the median and its interval."""
    rows = _rows(results)
    tasks = [(("full", np.nan), rows[rows["task"] == "full"]), *_tasks(rows)]
    drawing, axes = plt.subplots(figsize=(7.4, 0.42 * len(tasks) + 1.2))
    for place, ((task, _), group) in enumerate(reversed(tasks)):
        faces = np.sort(group["value"])
        tint = TASKS[task][-1] if task in TASKS else INK
        axes.plot(
            faces, place + 0.5 * (np.arange(len(faces)) / len(faces) - 0.5), "o", ms=3.5, mew=0, color=tint, alpha=0.6
        )
        median, low, high = interval(faces, statistic=np.median)
        axes.plot([low, high], [place] * 2, color=INK, lw=1.6)
        axes.plot(median, place, "|", color=INK, ms=11, mew=2)
    axes.set_yticks(range(len(tasks)), [words_of(*key) for key, _ in reversed(tasks)])
    axes.set(xscale="log", xlabel="faces")
    plain_logarithm(axes.xaxis)
    axes.tick_params(axis="y", length=0)
    axes.grid(axis="x")
    drawing.tight_layout()
    return Figure(drawing, {"objects": rows["item"].nunique()})


def words_of(task: str, condition: float) -> str:
    """A task in words: seen from 1 m."""
    if task not in TASKS:
        return "the full mesh"
    words, scale, _ = TASKS[task]
    return words.format(scale * condition)


def _rows(results: Results, metric: str = "faces") -> pd.DataFrame:
    return results.measured(STAGE, metric=metric)


def _tasks(rows: pd.DataFrame) -> list[tuple[tuple[str, float], pd.DataFrame]]:
    """[((task, condition), rows)] in the order of TASKS, from few faces to many."""
    rows, order = rows.dropna(subset=["condition"]), list(TASKS)
    keys = sorted({*zip(rows["task"], rows["condition"], strict=True)}, key=lambda key: (order.index(key[0]), -key[1]))
    return [(key, rows[(rows["task"] == key[0]) & (rows["condition"] == key[1])]) for key in keys]


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
SHOWN = {"displacement_mean": ("displacement, px", 1, 2), "error": ("frame error, mean", 1, 2),
         "held": ("frames within, %", 100, 0), "switches_per_object": ("switches an object", 1, 1)}  # fmt: skip


def random_table(results: Results) -> Table:
    """A line for each plan: means over the scenes, with intervals over the scenes."""
    (wide, first), times = plans(results), _times(results)
    lines, frame = [], []
    for method, matched in (plan for plan in PLANS if plan in wide["faces"]):
        scenes = pd.DataFrame(wide.xs((method, matched), axis=1, level=["method", "matched"]))
        scenes = scenes.reindex(columns=["faces", *SHOWN, "step_worst", "planning_ms"]).dropna(subset=["faces"])
        comparable = matched == "displacement" or method == OURS
        ends = {
            "saved": over_scenes(saving(wide, OURS_PLAN, (method, matched))),
            "less": over_scenes(saving(wide, (method, matched), UNIFORM_LEVELS) if comparable else []),
            "drawing": times.get((method, matched), (np.nan,) * 3),
        }
        means = {name: scenes[name].mean() for name in SHOWN}
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
            **{head: f"{scale * entry[name]:.{places}f}" for name, (head, scale, places) in SHOWN.items()},
            "worst jump": entry["step_worst"], "planning, ms a frame": entry["planning_ms"],
            "drawing time / full": with_interval(*ends["drawing"], places=2).replace("not run", "–"),
        })  # fmt: skip
    words = {
        "scenes": len(wide),
        "tolerance": amount(first["tolerance"], UNITS[first["kind"]]), "foresight": _foresight(wide),
        "drawing": drawing(results), "planning": planning(results),
    }  # fmt: skip
    return Table(pd.DataFrame(frame), pd.DataFrame(lines), words)


ALLOWED = 5.0  # per cent more faces that an online planner may need


def plans(results: Results) -> tuple[pd.DataFrame, pd.Series]:
    """(frame scenes x (metric, method, matched) over all frames, the first row) of the random scenes."""
    rows = results.measured("scene", RANDOM, frame="all", factor=1, item=None).fillna({"matched": ""})
    rows = some(rows[rows["kind"].notna()], "no random scenes", "scene")
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


FACES = "% of the faces"
MATCHED = {"displacement": "at an equal mean displacement", "error": "at an equal error of each frame's worst object"}
PHRASES = {
    ("over", "group"): "scenes", ("metric", "faces"): "faces", ("frame", "all"): "",
    **{("method", name): words for name, words in NAMES.items()},
    **{("matched", name): words for name, words in MATCHED.items()},
    **{("task", name): "" for name in TASKS},
    **{("condition", metres): f"seen from {metres:g} m" for metres in (0.5, 1.0, 2.0)},
    ("condition", 0.05): "felt within 5 % of full scale", ("condition", 0.02): "recognised within 2 points",
}  # fmt: skip


@statistic("faces_saved")
def faces_saved(results: Results, claim: Claim) -> pd.Series:
    """The share of the second side's faces that the first side does without."""
    return 1 - side(results, claim, claim.first, claim.second) / side(results, claim, claim.other, claim.first)


claim = partial(Claim, section="ours", statistic="faces_saved", unit=FACES, phrases=PHRASES)
planned = partial(claim, stage="scene", dataset=RANDOM, over=("group",), shared=SHARED_OBJECTS,
                  where={"metric": "faces", "frame": "all"})  # fmt: skip
needed = partial(claim, stage=STAGE, over=("item",), where={"metric": "faces"}, statistic="difference", relative=True,
                 unit="% of the mean of both")  # fmt: skip
SEEN = {"task": "seen", "condition": 1.0}
FELT = {"task": "felt", "condition": 0.05}
KNOWN = {"task": "recognised", "condition": 0.02}
CLAIMS = [
    *(
        planned(key=f"saves_{rival}_{matched}", first={"method": OURS}, second={"method": rival, "matched": matched},
                sentence=f"Ours needs fewer faces than {NAMES[rival]} {words}.")
        for matched, words in MATCHED.items()
        for rival in ("uniform", "uniform_size")
    ),
    *(
        planned(key=f"{method}_saves", first={"method": method, "matched": "displacement"},
                second={"method": "uniform", "matched": "displacement"},
                sentence=f"{words} needs fewer faces than uniform levels by distance at an equal mean displacement.")
        for method, words in (("beforehand", "A look-up of errors rendered beforehand"),
                              ("every_level", "Knowing the error of every level in every frame"))
    ),
    planned(key="online_faces", first={"method": "online"}, second={"method": OURS}, margin=ALLOWED,
            sentence=f"A planner that sees no frame ahead needs no more than {ALLOWED:g} % more faces."),
    needed(key="felt_over_seen", first=FELT, second=SEEN,
           sentence="To be felt as the full mesh is, an object needs more faces than to be seen from one metre."),
    needed(key="recognised_under_felt", first=FELT, second=KNOWN,
           sentence="To be recognised by touch, an object needs fewer faces than to be felt within 5 %.",
           readings=tuple(reading(f"felt within {share:.0%}", first={"condition": share}) for share in (0.02, 0.1))),
]  # fmt: skip
