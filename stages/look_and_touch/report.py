"""What a look and planned touches tell of known objects, what that costs a robot, and where it breaks."""

from dataclasses import replace

import numpy as np
import pandas as pd

from haptic_glance.base.files import read_json, read_mesh
from haptic_glance.look.camera import project
from haptic_glance.look.views import render
from stages.charts.breaking import broken
from stages.charts.datasets import dataset_text
from stages.charts.drawing import CYCLE, GREY, MARKERS, label, plt
from stages.charts.items import Figure, Table
from stages.charts.results import Results, require_rows
from stages.charts.tables import Ranking, everywhere, grouped, interval_columns, interval_text, percent, records, within
from stages.engine.statistics import breaking_point

from .measure import CLEAN, DISTURBED, PERTURBATIONS, library_of
from .protocol import CAMERA, POLICIES, SIGHTS, Case, Disturbance

STAGE = "look_and_touch"
SHOWN = (0, 1, 2, 3)  # touches, in the table
LINES = {  # (sight, policy): how a person says it
    ("blind", "spread"): "touch alone, evenly spread",
    ("blind", "planned"): "touch alone, planned",
    ("look", "spread"): "a look, then touches evenly spread",
    ("look", "planned"): "a look, then planned touches",
}
UNHARMED = {name: entry.unharmed for name, entry in PERTURBATIONS.items()}
TOUCHED = 1  # touches, of the breaking points


def first_set(results: Results) -> str:
    """The first set with rows of the stage; NotRun where there is none."""
    return require_rows(results.datasets(STAGE), f"no measurements of {STAGE}", STAGE)[0]


def by_class(rows: pd.DataFrame) -> np.ndarray:
    """Means of the objects' values within each class, over which intervals run."""
    return rows.groupby("group")["value"].mean().to_numpy()


def table(results: Results) -> Table:
    """A row a set, sight and way to choose touches: right answers after some touches, and touches until sure."""
    lines = []
    for dataset, rows in everywhere(results, STAGE, perturbation=CLEAN).items():
        rows = rows[rows["split"].isna() & rows["metric"].ne("reliable")]
        for sight in SIGHTS:
            for policy in POLICIES:
                some = rows[(rows["sight"] == sight) & (rows["method"] == policy)]
                if len(some):
                    lines.append({"dataset": dataset, "sight": sight, "method": policy, **_line(some)})
    frame = pd.DataFrame(lines)
    text_table = pd.DataFrame([
        {
            "objects": dataset_text(row.dataset), "seen before": SIGHTS[row.sight], "touched": POLICIES[row.method],
            **{f"right after {count}, %": interval_text(row, f"right_{count}", 100, 0) for count in SHOWN},
            "touches until sure": interval_text(row, "touches_to_sure", places=2),
            "sure, %": percent(row.sure), "right when sure, %": percent(row.right_when_sure),
        }
        for row in records(frame)
    ])  # fmt: skip
    counts = results_of_sets(results)
    words = {"sets": counts, "reliable": _reliable(results), "unseen": _unseen(results)}
    rights = [f"right after {count}, %" for count in SHOWN]
    answer = ["seen before", "touched", *rights[:3], "touches until sure", "sure, %", "right when sure, %"]
    return Table(frame, text_table, words, Ranking(rights), answer, split="objects", keys=answer[:2])


def _line(rows):
    """The numbers of one row of the table."""
    numbers = {}
    for count in SHOWN:
        right = rows[(rows["metric"] == "right") & (rows["touches"] == count)]
        numbers |= interval_columns(f"right_{count}", within(by_class(right)))
    touches = rows[rows["metric"] == "touches_to_sure"]
    most = rows["touches"].max()
    numbers |= interval_columns("touches_to_sure", within(by_class(touches), top=most))
    sure, ends = (rows.loc[rows["metric"] == metric, "value"].mean() for metric in ("sure", "sure_right"))
    return numbers | {"sure": sure, "right_when_sure": ends / sure if sure else np.nan}


def results_of_sets(results: Results) -> str:
    """The number of objects and classes of each set, in words."""
    texts = []
    for dataset, rows in everywhere(results, STAGE, metric="right", perturbation=CLEAN).items():
        objects, classes = rows["item"].nunique(), rows["group"].nunique()
        kinds = f" of {classes} classes" if classes < objects else ""
        texts.append(f"{dataset_text(dataset)}: {objects} objects{kinds}")
    return "; ".join(texts)


def _reliable(results):
    """The largest gap between what is stated and the share of right answers, of each set."""
    texts = []
    for dataset, rows in everywhere(results, STAGE, metric="reliable").items():
        rows = rows[rows["method"].isin(["planned", "spread"]) & rows["sight"].isin(DISTURBED)]
        gaps = 100 * (rows["stated"] - rows["value"]).abs()
        texts.append(f"{dataset_text(dataset)} {gaps.mean():.0f} points on average, {gaps.max():.0f} at most")
    return "; ".join(texts)


def _unseen(results):
    """How often the class of an unseen object is right, by each sense and by both, of each set with classes."""
    texts = []
    for dataset in results.datasets(STAGE):
        rows = results.rows(STAGE, dataset)
        rows = rows[(rows["metric"] == "class_right") & rows["value"].notna()]
        if rows.empty:
            continue
        most = rows["touches"].max()
        look, blind, both = (
            rows[(rows["sight"] == sight) & (rows["touches"] == count)].set_index("item")[["group", "value"]]
            for sight, count in (("look", 0), ("blind", most), ("look", most))
        )
        better = look if look["value"].mean() >= blind["value"].mean() else blind
        name = "the look" if better is look else "the touches"
        gain = both.assign(value=both["value"] - better["value"])
        mean = 100 * by_class(gain).mean()
        texts.append(
            f"{dataset_text(dataset)}: a look {100 * by_class(look).mean():.0f} %, {most:.0f} touches "
            f"{100 * by_class(blind).mean():.0f} %, both {100 * by_class(both).mean():.0f} %, which is "
            f"{mean:+.0f} points beside {name} alone"
        )
    return "; ".join(texts) if texts else "no set with classes of three objects or more was measured"


def curves(results: Results, dataset: str) -> pd.DataFrame:
    """Frame: sight, method, touches, right with its interval, and the seconds that a robot needs."""
    rows = results.measured(STAGE, dataset, metric="right", perturbation=CLEAN)
    settings = results.workspace.params.get(dataset, {}).get(STAGE, {})
    picture, touch = float(settings.get("picture_seconds", 0.1)), float(settings.get("touch_seconds", 5.0))
    lines = []
    for sight, method in LINES:
        some = rows[(rows["sight"] == sight) & (rows["method"] == method)]
        for count in sorted(some["touches"].unique()):
            ends = within(by_class(some[some["touches"] == count]))
            seconds = (0.0 if sight == "blind" else picture) + count * touch
            line = {"dataset": dataset, "sight": sight, "method": method, "touches": int(count), "seconds": seconds}
            lines.append(line | interval_columns("right", ends))
    return require_rows(pd.DataFrame(lines), "no right answers", STAGE)


def chart(results: Results) -> Figure:
    """Right answers against touches, and against the seconds of a robot."""
    sets = list(everywhere(results, STAGE, metric="right", perturbation=CLEAN))
    frames = [curves(results, dataset) for dataset in sets]
    drawing, grid = plt.subplots(
        len(sets), 2, figsize=(9.2, 2.9 * len(sets) + 0.7), squeeze=False, sharey=True, layout="constrained"
    )
    for (first, second), frame, dataset in zip(grid, frames, sets, strict=True):
        for (key, words), tint, mark in zip(LINES.items(), CYCLE, MARKERS, strict=False):
            points = frame[(frame[["sight", "method"]] == list(key)).all(axis=1)]
            for axes, column in ((first, "touches"), (second, "seconds")):
                axes.vlines(
                    points[column], 100 * points["right_low"], 100 * points["right_high"], color=tint, alpha=0.3
                )
                axes.plot(points[column], 100 * points["right"], marker=mark, ms=4, lw=1.4, color=tint, label=words)
        first.set(ylabel=f"right, %\n{dataset_text(dataset)}", ylim=(0, 102), xlabel="touches")
        second.set(xlabel="seconds of a robot")
        for axes in (first, second):
            axes.grid()
    handles, names = grid[0, 0].get_legend_handles_labels()
    drawing.legend(handles, names, loc="outside lower center", ncol=2)
    best = frames[0]
    both = best[(best["sight"] == "look") & (best["method"] == "planned") & (best["touches"] == 1)]["right"].iloc[0]
    title = f"A look and one planned touch name {100 * both:.0f} %: {dataset_text(sets[0])}"
    drawing.suptitle(title, x=0.01, ha="left", fontweight="bold", fontsize=11)
    return Figure(drawing, {"sets": results_of_sets(results)}, frame=pd.concat(frames))


def disturbed(results: Results, dataset: str) -> pd.DataFrame:
    """Frame: perturbation, sight, severity, accuracy with its interval, after TOUCHED planned touches; CLEAN first."""
    rows = results.measured(STAGE, dataset, metric="right", touches=TOUCHED, method="planned")
    lines = []
    for name, entry in PERTURBATIONS.items():
        for sight in DISTURBED:
            seen = rows[rows["sight"] == sight]
            here = [(entry.unharmed, seen[seen["perturbation"] == CLEAN])]
            harsh = seen[seen["perturbation"] == name]
            severities = sorted(harsh["severity"].unique(), key=lambda severity: abs(severity - entry.unharmed))
            here += [(severity, harsh[harsh["severity"] == severity]) for severity in severities]
            for severity, some in here:
                line = {"perturbation": name, "sight": sight, "severity": severity}
                lines.append(line | interval_columns("accuracy", within(by_class(some))))
    return pd.DataFrame(lines)


def breaking(frame: pd.DataFrame, objects: int) -> pd.DataFrame:
    """Frame: perturbation, unit, sight, the severity at which half of the lead over guessing is lost, its interval."""
    lines = []
    for (name, sight), part in grouped(frame, ["perturbation", "sight"]):
        clean, harsh = part["accuracy"].iloc[0], part.iloc[1:]
        ends = {
            key: breaking_point(
                harsh["severity"].tolist(),
                ((harsh[column] - 1 / objects) / (clean - 1 / objects)).tolist(),
                UNHARMED[name],
            )
            for key, column in (("breaking_point", "accuracy"), ("low", "accuracy_low"), ("high", "accuracy_high"))
        }
        lines.append({"perturbation": name, "unit": PERTURBATIONS[name].unit, "sight": sight, **ends,
                      "harshest": harsh["severity"].iloc[-1]})  # fmt: skip
    return pd.DataFrame(lines)


def breaking_table(results: Results) -> Table:
    """Breaking points of one planned touch, blind and after a look, of the first set."""
    dataset = first_set(results)
    frame = breaking(disturbed(results, dataset), _objects(results, dataset))
    heads = frame["sight"].map({"blind": "touch alone breaks at", "look": "look and touch break at"})
    return Table(frame, broken(frame, heads, UNHARMED), {"set": dataset_text(dataset), "touched": TOUCHED})


def _objects(results, dataset):
    return results.measured(STAGE, dataset, metric="right", perturbation=CLEAN)["item"].nunique()


def breaking_figure(results: Results) -> Figure:
    """Right answers after one planned touch against severity: a panel a perturbation."""
    dataset = first_set(results)
    frame, names = disturbed(results, dataset), list(PERTURBATIONS)
    drawing, grid = plt.subplots(2, 3, figsize=(9.6, 5.4), sharey=True, layout="constrained")
    words = {"blind": "one planned touch", "look": "a look and one planned touch"}
    for axes, name in zip(grid.flat, names, strict=True):
        for sight, tint, mark in zip(DISTURBED, CYCLE, MARKERS, strict=False):
            part = frame[(frame["perturbation"] == name) & (frame["sight"] == sight)]
            places = np.arange(len(part))
            axes.vlines(places, 100 * part["accuracy_low"], 100 * part["accuracy_high"], color=tint, alpha=0.35)
            axes.plot(places, 100 * part["accuracy"], marker=mark, ms=4, lw=1.4, color=tint, label=words[sight])
            ticks = ["as it is", *(f"{severity:,g}" for severity in part["severity"].iloc[1:])]
            axes.set_xticks(places, ticks, fontsize=8)
        axes.axhline(100 / _objects(results, dataset), color=GREY, ls=":", lw=1)
        axes.set_title(label(name), fontsize=10)
        axes.set_xlabel(PERTURBATIONS[name].unit, fontsize=8)
        axes.set_ylim(0, 102)
        axes.grid(axis="y")
    for axes in grid[:, 0]:
        axes.set_ylabel("right, %")
    handles, legend = grid[0, 0].get_legend_handles_labels()
    drawing.legend(handles, legend, loc="outside lower center", ncol=2)
    return Figure(drawing, {"set": dataset_text(dataset)})


def story(results: Results) -> Figure:
    """One object that a look leaves open and one planned touch decides: picture, belief, touch, belief."""
    dataset = first_set(results)
    folder = results.folder("meshes", dataset)
    library = library_of(folder, tuple(read_json(results.folder(STAGE, dataset) / "names.json")))
    for name in _undecided(results, dataset):
        case = Case(library, name, read_mesh(folder / f"{name}.npz"), 0, seed=results.workspace.seed)
        before = case.look("look")
        approach = before.next_touch()
        travel, imprint = case.feel(approach.line)
        after = before.after(approach, travel, imprint)
        if np.isfinite(travel) and after.known == name:
            break
    picture, _ = case.picture(Disturbance().hidden)
    drawing, panels = plt.subplots(1, 4, figsize=(11.0, 2.9), width_ratios=[1, 1, 1.15, 1], layout="constrained")
    panels[0].imshow(picture, cmap="gray", vmin=0, vmax=255)
    panels[0].set_title("one look, 60 % hidden", fontsize=11)
    _bars(panels[1], before, name, "believed after the look")
    _hand(panels[2], case, approach, travel)
    panels[2].set_title("one touch where they differ", fontsize=11)
    inset = panels[2].inset_axes((0.66, 0.66, 0.34, 0.34))
    inset.imshow(imprint, cmap="viridis_r")
    _bars(panels[3], after, name, "believed after the touch")
    for axes in (panels[0], panels[2], inset):
        axes.set(xticks=[], yticks=[])
    return Figure(drawing)


def _undecided(results, dataset):
    """The objects, first those that a look names wrongly and one planned touch rightly."""
    rows = results.measured(STAGE, dataset, metric="right", perturbation=CLEAN, sight="look", method="planned")
    right = rows.pivot(index="item", columns="touches", values="value")
    return (right[TOUCHED] - right[0]).sort_values(ascending=False, kind="stable").index.tolist()


def _bars(axes, belief, name, title):
    """The five likeliest names as bars, the right one in colour."""
    likely = list(belief.probabilities.items())[:5][::-1]
    tints = [CYCLE[0] if key == name else GREY for key, _ in likely]
    axes.barh(range(len(likely)), [100 * share for _, share in likely], color=tints)
    axes.set_yticks(range(len(likely)), [label(key) for key, _ in likely], fontsize=9)
    axes.set(xlim=(0, 100), xlabel="%")
    axes.set_title(title, fontsize=11)


def _hand(axes, case, approach, travel):
    """The whole object as the camera would see it, with the line along which the hand came."""
    small = replace(case.there, vertices=case.there.vertices / (1.5 * case.library.diameter))
    view = render(small, CAMERA, size=(300, 300), background="white")
    axes.imshow(view.rgb)
    ends = np.stack(
        [approach.contact(travel), approach.contact(travel) - 0.45 * case.library.diameter * approach.direction]
    )
    rows, columns, _ = project(ends / (1.5 * case.library.diameter), CAMERA, (300, 300))
    arrow = {"color": CYCLE[1], "arrowstyle": "-|>", "lw": 2, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", (columns[0], rows[0]), (columns[1], rows[1]), arrowprops=arrow)


PAGE = "know"
TABLES = {"look_and_touch": table, "look_and_touch_breaking": breaking_table}
FIGURES = {"look_and_touch_story": story, "look_and_touch_stability": breaking_figure}
CHARTS = {"look_and_touch": chart}
