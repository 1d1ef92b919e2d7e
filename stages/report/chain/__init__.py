"""All stages together, from a mesh to a named object: what each choice gains, and what it costs."""

from typing import Any

import pandas as pd
from matplotlib.axes import Axes

from haptic_glance.base.timing import CLOCK
from haptic_glance.know.split import Split
from stages.engine.statistics import interval
from stages.report.drawing import CYCLE, GREY, PALE, label, plain_logarithm, plt
from stages.report.items import Figure, Table
from stages.report.pareto import NOISE, ON, placed
from stages.report.results import Results, some
from stages.report.tables import everywhere, interval_columns, interval_text, number, percent, records, signed, within

PANELS = {"regions": "one of six shapes, by unseen regions", "objects": "the class of an unseen object"}
SIX = 6  # shapes of one question
SMALLEST, DEFAULT = "the smallest within two points", "the project's default"
IN_SEARCH = "the smallest within two points of the search's best"  # in the chart, which shows other objects, too


def front_table(results: Results) -> Table:
    """The confirmed choices, the quickest first, beside what the search found of them."""
    rows = front_rows(results)
    frame = of_rung(rows, CONFIRMED).sort_values("seconds", ignore_index=True)
    searched = of_rung(rows, SEARCH).set_index("number")
    for name in SPLITS.values():
        frame[f"{name}_searched"] = frame["number"].map(searched[name])
    confirmed = rows[rows["rung"] == CONFIRMED]
    usual = confirmed[confirmed["number"] == named(rows, "default")]
    for split, name in SPLITS.items():
        intervals = [effect(usual, confirmed[confirmed["number"] == choice], split) for choice in frame["number"]]
        frame[[f"{name}_over", f"{name}_over_low", f"{name}_over_high"]] = intervals
    frame["role"] = frame["number"].map({named(rows, "default"): DEFAULT, named(rows, "smallest"): SMALLEST}).fillna("")
    text_table = pd.DataFrame(
        {
            "choice": frame["words"],
            "seconds to know": frame["seconds"],
            "unseen regions, %": [interval_text(row, "regions", 100, 0) for row in records(frame)],
            "in the search": frame["regions_searched"].map(percent),
            "unseen objects, %": [interval_text(row, "objects", 100, 0) for row in records(frame)],
            "in the search ": frame["objects_searched"].map(percent),
            "looking, s": frame["looking"],
            "faces": frame["faces"].round(),
            "learning one object, s": frame["training"],
            "which": frame["role"],
        }
    )
    return Table(frame, text_table, _words(rows, frame))


def smallest_kept(frame: pd.DataFrame) -> pd.Series:
    """The choice that defaults follow: the quickest of a frame of `table` within the interval of the best.

    The best has the highest mean of both accuracies. A choice is within its interval where neither accuracy is below
    the lower end of the best one's.
    """
    accuracies = list(SPLITS.values())
    best = frame.iloc[int(frame[accuracies].mean(axis=1).argmax())]
    as_good = (frame[accuracies] >= [best[f"{name}_low"] for name in accuracies]).all(axis=1)
    return frame[as_good].sort_values(["seconds", "faces", "touches"]).iloc[0]


def _words(rows, frame):
    """The words of the notes: how many choices and objects, and the two choices that are named."""
    counts = {rung: choices["number"].nunique() for rung, choices in rows.groupby("rung")}
    small, usual = (frame[frame["role"] == role].iloc[0] for role in (SMALLEST, DEFAULT))
    items = rows[rows["rung"] == CONFIRMED].drop_duplicates(["split", "item"])
    shapes, objects = (int((items["split"] == split).sum()) for split in SPLITS)
    texts = {"wide": counts["wide"], "narrow": counts["narrow"], "last": counts["last"], "confirmed": len(frame)}
    texts |= {"shapes": shapes, "objects": objects, "guess": f"{100 / items['group'].nunique():.0f}"}
    for name, row in (("small", small), ("usual", usual)):
        accuracies = (f"{100 * row[split]:.0f}" for split in SPLITS.values())
        texts |= zip((name, f"{name}_regions", f"{name}_objects"), (row["words"], *accuracies), strict=True)
    return texts | {
        "small_ms": brief(1000 * small["seconds"]),
        "usual_ms": brief(1000 * usual["seconds"]),
        "kept": smallest_kept(frame)["words"],
    }


def chart(results: Results) -> Figure:
    """Accuracy against seconds to know one object, on unseen regions and on unseen objects."""
    rows = front_rows(results)
    searched, confirmed = of_rung(rows, SEARCH), of_rung(rows, CONFIRMED)
    marked = {named(rows, "default"): ("s", CYCLE[2], DEFAULT), named(rows, "smallest"): ("D", CYCLE[1], IN_SEARCH)}
    drawing, panels = plt.subplots(1, 2, figsize=(9.2, 4.1), sharex=True, sharey=True, layout="constrained")
    guesses = (1 / SIX, 1 / rows.loc[rows["rung"] == CONFIRMED, "group"].nunique())  # shapes have no group
    for axes, (name, title), guess in zip(panels, PANELS.items(), guesses, strict=True):
        _draw(axes, searched, confirmed, name, marked)
        axes.axhline(100 * guess, color=GREY, lw=0.8, ls=":", label="guessing")
        axes.set_title(title, fontsize=10)
        axes.set_xlabel("seconds of one core from mesh to name")
    panels[0].set_ylabel("right answers, %")
    handles, names = panels[0].get_legend_handles_labels()
    drawing.legend(handles, names, loc="outside lower center", ncol=3, fontsize=9)
    frame = pd.concat([searched.assign(rung=SEARCH), confirmed.assign(rung=CONFIRMED)], ignore_index=True)
    return Figure(drawing, _words(rows, front_table(results).frame), frame)


def _draw(axes: Axes, searched: pd.DataFrame, confirmed: pd.DataFrame, name: str, marked: dict) -> None:
    """One panel: what the search found and its front, and what was confirmed, with intervals."""
    axes.plot(
        searched["seconds"], 100 * searched[name], "o", color="none", mec=GREY, ms=4.5, label="on objects of the search"
    )
    rows = searched.assign(low=searched[f"{name}_low"], high=searched[f"{name}_high"])
    ranked = placed(rows, "seconds", name, noise=NOISE[CLOCK])
    front = ranked[ranked["on_front"] == ON].sort_values("seconds")
    text = "on their front in 95 % of resamples"
    axes.step(front["seconds"], 100 * front[name], where="post", color=GREY, lw=1, zorder=1, label=text)
    pairs = confirmed.merge(searched, on="number", suffixes=("", "_before"))
    for row in records(pairs):
        ends = [[getattr(row, f"{key}_before"), getattr(row, key)] for key in ("seconds", name)]
        axes.plot(ends[0], [100 * end for end in ends[1]], color=PALE, lw=1.2, zorder=0)
    unmarked = confirmed[~confirmed["number"].isin(marked)]
    for rows, (form, tint, text) in [
        (unmarked, ("o", CYCLE[0], "confirmed on unseen ones, 95 % interval")),
        *((confirmed[confirmed["number"] == key], look) for key, look in marked.items()),
    ]:
        ends = 100 * rows[[f"{name}_low", f"{name}_high"]].to_numpy()
        axes.vlines(rows["seconds"], *ends.T, color=tint, lw=1.2, alpha=0.6, zorder=2)
        axes.plot(rows["seconds"], 100 * rows[name], form, color=tint, mec="white", mew=0.8, ms=7, zorder=3, label=text)
    for row in records(pd.concat([searched, confirmed])):
        axes.plot(row.seconds, 100 * getattr(row, name), alpha=0, label=f"_{row.words}")
    axes.set(xscale="log", ylim=(0, 102))
    axes.grid()
    plain_logarithm(axes.xaxis, (1.0, 3.0))


STAGES = {
    "method": "who chooses the places", "viewpoints": "viewpoints", "image_rows": "rows of an image",
    "points": "places", "cells": "sensels a side", "level": "faces of the model", "touches": "touches of an answer",
    "classifier": "classifier",
}  # fmt: skip


def changed(results: Results) -> Table:
    """One row for each option: what changes, the effect on both accuracies with its interval, and the seconds."""
    rows = front_rows(results)
    base = rows[(rows["rung"] == CONFIRMED) & (rows["number"] == named(rows, "smallest"))]
    first, lines = base.iloc[0], []
    for _, part in rows[rows["rung"] == CHANGED].groupby("number"):
        stage = next(name for name in CHOICES if not _same(part.iloc[0][name], first[name]))
        line: dict[str, Any] = {"stage": stage, "option": part.iloc[0][stage], "from": first[stage]}
        for split, name in SPLITS.items():
            line |= interval_columns(name, effect(base, part, split))
        line["times"] = part["seconds"].mean() / base["seconds"].mean()
        lines.append(line | {"seconds": part["seconds"].mean(), "faces": part["faces"].mean()})
    frame = pd.DataFrame(lines).sort_values("stage", key=lambda part: part.map(CHOICES.index), kind="stable")
    return Table(frame, _shown(frame), {"words": words(first), "seconds": brief(1000 * base["seconds"].mean())})


def _same(first, second):
    return first == second or (pd.isna(first) and pd.isna(second))


def _shown(frame: pd.DataFrame) -> pd.DataFrame:
    effects = {
        words: [signed(row[name], row[f"{name}_low"], row[f"{name}_high"], 0) for _, row in frame.iterrows()]
        for name, words in (("regions", "unseen regions, points"), ("objects", "unseen objects, points"))
    }
    options = [f"{_option(row['option'])} instead of {_option(row['from'])}" for _, row in frame.iterrows()]
    times = [f"{brief(value)} times" for value in frame["times"]]
    return pd.DataFrame({"stage": frame["stage"].map(STAGES), "option": options, **effects, "seconds": times})


def _option(value):
    if value == WHOLE:
        return "all"
    return label(value) if isinstance(value, str) else f"{value:.0f}"


STAGE = "front"
SEARCH, CONFIRMED, CHANGED = "last", "confirmation", "one_choice"  # of the column `rung`
CHOICES = list(STAGES)
WHOLE = "100%"  # of the column `level`
SPLITS = {Split.REGIONS: "regions", Split.OBJECTS: "objects"}  # split -> its columns
PARTS = ("simplifying", "looking", "pressing", "asking")


def front_rows(results: Results) -> pd.DataFrame:
    """All rows of both splits; NotRun where nothing was searched."""
    return pd.concat(everywhere(results, STAGE, metric="accuracy").values(), ignore_index=True)


def of_rung(rows: pd.DataFrame, rung: str) -> pd.DataFrame:
    """One row a choice: its options, `words`, the accuracies with low and high, seconds with their parts, training."""
    lines = []
    for choice, group in some(rows[rows["rung"] == rung], f"no rows of {rung}", STAGE).groupby("number"):
        first = group.iloc[0]
        line: dict[str, Any] = {"number": choice, "words": words(first)} | {name: first[name] for name in CHOICES}
        for split, name in SPLITS.items():
            line |= interval_columns(name, within(group.loc[group["split"] == split, "value"]))
        lines.append(line | group[["seconds", *PARTS, "training", "faces"]].mean().to_dict())
    return pd.DataFrame(lines)


def words(row: pd.Series) -> str:
    """A choice in words: `blind touch, 40 places, 8 x 8, all faces, 3 touches, kNN`."""
    sight = f" ({row['viewpoints']} views of {row['image_rows']:.0f} rows)" if pd.notna(row["image_rows"]) else ""
    faces = "all faces" if row["level"] == WHOLE else f"{row['level']} faces"
    touches = "1 touch" if row["touches"] == 1 else f"{row['touches']} touches"
    parts = [f"{label(row['method'])}{sight}", f"{row['points']} places", f"{row['cells']} x {row['cells']} cells"]
    return ", ".join([*parts, faces, touches, label(row["classifier"])])


def effect(base: pd.DataFrame, variant: pd.DataFrame, split: str) -> tuple[float, float, float]:
    """(mean, low, high) over the objects: the points of accuracy by which the rows of a choice exceed those of base."""
    before, after = (frame[frame["split"] == split].set_index("item")["value"] for frame in (base, variant))
    return interval(100 * (after - before).dropna())


def brief(value: float) -> str:
    """A number to two digits: 19, 0.95, 110."""
    return number(float(f"{value:.2g}"), 2)


def named(rows: pd.DataFrame, role: str) -> int:
    """The number of the confirmed choice with a role, `smallest` or `default`."""
    return int(some(rows[rows["role"] == role], f"no {role} choice was confirmed", STAGE)["number"].iloc[0])


TABLES = {"front": front_table, "front_changed": changed}
FIGURES = {}
CHARTS = {"front": chart}
