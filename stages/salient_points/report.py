"""Models of attention against human gaze and marks (T3.1, T3.2)."""

from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from haptic_glance.base.files import read_arrays
from haptic_glance.look.camera import Viewpoint
from haptic_glance.look.channels import CHANNELS
from haptic_glance.look.points import COMBINATIONS, fuse
from haptic_glance.look.weights import read_learned_weights
from haptic_glance.look.weights.svm import SALIENT_LEVEL
from haptic_glance.mesh.mesh import Mesh
from stages.bench import has_seen
from stages.charts.drawing import MAP, VIEWPOINT, colour_bar, label, name_panels, picture, plt, show, square_grid, vivid
from stages.charts.items import Figure, Table, shared_notes
from stages.charts.pareto import attention_seconds, pareto_chart
from stages.charts.results import NotRun, Results, require_rows
from stages.charts.tables import Ranking, interval_columns, number, records, signed, with_interval
from stages.conspicuity.measure import read_maps
from stages.engine.statistics import interval
from stages.salient_points.measure import read_saliency
from stages.weights.ground_truth import gts_map, visible_points

COLOUR = ("color", "dkl")  # the thesis's RGB and DKL features
KEPT = 0.3  # of the object's pixels: the thesis retains 30 % of the highest values (T3.1.1)
FADED = 0.78  # of what lies outside of the regions
MACHINES = ("svm+object", "svm")  # the thesis's, one for the object itself; and one that has not seen it
MARGIN = 4  # pixels kept round the object
RED = "#D81B1B"


def maps_of(
    results: Results, name: str, channels: Sequence[str] | None = None
) -> tuple[np.ndarray, np.ndarray, list[Viewpoint], list[str]]:
    """(maps (v, channels, h, w) f4, mask (v, h, w) boolean, viewpoints, channels) of an object.

    channels: the channels, in this order; NotRun where one was not computed. None: those that were.
    """
    maps, mask, viewpoints, computed = read_maps(results.file("conspicuity", f"{name}.npz"))
    if channels is None:
        return maps, mask, viewpoints, computed
    missing = [channel for channel in channels if channel not in computed]
    if missing:
        raise NotRun(f"no maps of {', '.join(missing)}", "conspicuity", runnable=False)
    return maps[:, [computed.index(channel) for channel in channels]], mask, viewpoints, list(channels)


def objects_with_truth(results: Results, preferred: Sequence[str], count: int) -> list[str]:
    """Up to `count` objects that have ground truth and salient points: the preferred ones first."""
    truths = {path.stem for path in (results.folder("weights") / "ground_truth").glob("*.npz")}
    require_rows(truths, "no object has ground truth", "weights")
    names = [name for name in results.choose(preferred, len(results.objects)) if name in truths]
    return require_rows(names, "no object with ground truth has salient points", "salient_points")[:count]


def figure_3_3(results: Results) -> Figure:
    """Saliency and regions of interest, without and with the colour channels."""
    names = results.choose(results.settings.figure_objects, 4, stage="conspicuity")
    figure, grid = plt.subplots(len(names), 5, figsize=(9.2, 1.9 * len(names)), squeeze=False)
    for name, row in zip(names, grid, strict=True):
        _regions(results, name, row)
    name_panels(grid, ["", "without colour", "regions", "with colour", "regions"])
    for axes in grid.flat:
        axes.set(xticks=[], yticks=[])
        axes.spines[:].set_visible(False)
    figure.subplots_adjust(wspace=0.04, hspace=0.04)
    return Figure(figure)


def _regions(results: Results, name: str, row: Sequence[Axes]) -> None:
    """Draws one object."""
    maps, masks, viewpoints, channels = maps_of(results, name, COMBINATIONS["VisAttAll"])
    view = _nearest(viewpoints, masks, range(len(viewpoints)))
    mask, part = masks[view], _window(masks[view], square=True)
    render = _render(results.mesh(name), viewpoints[view], mask)[part]
    row[0].imshow(render)
    row[0].set_ylabel(name)
    for left, right, left_out in ((row[1], row[2], COLOUR), (row[3], row[4], ())):
        channel_maps = zip(channels, maps[view], strict=True)
        saliency = fuse({channel: values for channel, values in channel_maps if channel not in left_out})
        region = mask & (saliency > np.quantile(saliency[mask], 1 - KEPT))
        left.imshow(np.where(mask, saliency, np.nan)[part], cmap=MAP, vmin=0, vmax=saliency[mask].max())
        right.imshow(np.where(region[part][..., None], render, FADED + (1 - FADED) * render))
        right.contour(region[part], [0.5], colors=[RED], linewidths=0.9)


def figure_3_10(results: Results) -> Figure:
    """The nine conspicuity maps of one object beside its render, in the view in which most channels answer."""
    name = results.choose(results.settings.figure_objects, 1, stage="conspicuity")[0]
    maps, masks, viewpoints, map_channels = maps_of(results, name)
    channels = [channel for channel in CHANNELS if channel in map_channels]
    answers = (maps.max(axis=(2, 3)) > 0.02).sum(axis=1)  # below it a map shows nothing
    answers[~masks.any(axis=(1, 2))] = -1
    view = _nearest(viewpoints, masks, np.flatnonzero(answers == answers.max()))
    viewpoint, mask, part = viewpoints[view], masks[view], _window(masks[view])
    figure, grid = plt.subplots(2, 5, figsize=(9.6, 4.6))
    grid[0, 0].imshow(_render(results.mesh(name), viewpoint, mask)[part])
    grid[0, 0].set_title(name, fontsize=10, loc="center")
    for axes, channel in zip(grid.flat[1:], channels, strict=False):
        values = maps[view, map_channels.index(channel)]
        top = float(values[mask].max())
        axes.imshow(np.where(mask, values / (top or 1.0), np.nan)[part], cmap=MAP, vmin=0, vmax=1)
        peak = f"up to {top:.2f}" if top else "nothing: one colour" if channel in COLOUR else "nothing"
        axes.set_title(f"{label(channel)}\n{peak}", fontsize=9, fontweight="normal", loc="center")
    for axes in grid.flat:
        axes.set_axis_off()
    figure.subplots_adjust(wspace=0.04, hspace=0.12)
    bar = figure.colorbar(grid[0, 1].images[0], ax=grid, shrink=0.75, pad=0.02, aspect=30)
    bar.set_label("conspicuity, over the map's largest")
    return Figure(figure)


def figure_3_12(results: Results) -> Figure:
    """Saliency by the classical model, by equal and learned weights, and by our model, beside the truth."""
    names = objects_with_truth(results, results.settings.figure_objects, 4)
    methods = results.by_method("salient_points", read_saliency, names[0]).those_of(
        ["itti", "VisAttAll", "guided_ed", "guided_ssim", "glance"]
    )
    figure, grid = square_grid(len(names), len(methods) + 1, side=1.7, right=0.9)
    for row, name in zip(grid, names, strict=True):
        mesh, ground_truth, saliency = (
            results.mesh(name),
            read_arrays(results.file("weights", f"ground_truth/{name}.npz")),
            results.by_method("salient_points", read_saliency, name),
        )
        for axes, method in zip(row, methods, strict=False):
            show(axes, mesh, vivid(saliency[method]))
        show(row[-1], mesh, vivid(ground_truth["density"]), points=ground_truth["points"])
    name_panels(grid, [*map(label, methods), "ground truth"], names)
    colour_bar(figure, [0.945, 0.2, 0.012, 0.6], "over the 98 % quantile")
    return Figure(figure)


def figure_3_13(results: Results) -> Figure:
    """The binarised ground truth of a view, and what the SVM makes of its nine maps."""
    name = objects_with_truth(results, results.settings.figure_objects, 1)[0]
    mesh, ground_truth = results.mesh(name), read_arrays(results.file("weights", f"ground_truth/{name}.npz"))
    maps, masks, viewpoints, _ = maps_of(results, name, list(ground_truth["channels"]))
    svms = read_learned_weights(results.file("weights", "weights.csv").parent, name, mesh).svms
    machines = [machine for machine in MACHINES if machine in svms]
    require_rows(machines, f"no SVM was trained for {name}", "weights", runnable=False)
    spots = [visible_points(mesh, ground_truth["points"], viewpoint, masks.shape[1:])[:2] for viewpoint in viewpoints]
    counts = np.array([len(rows) for rows, _ in spots])
    view = _nearest(viewpoints, masks, np.flatnonzero(counts >= 0.6 * counts.max()))  # such views show points enough
    mask, part = masks[view], _window(masks[view])
    truth = gts_map(*spots[view], mask) > SALIENT_LEVEL
    figure, grid = plt.subplots(1, 2 + len(machines), figsize=(2.7 * (2 + len(machines)), 2.7))
    grid[0].imshow(_render(mesh, viewpoints[view], mask)[part])
    down, across = (places - window.start for places, window in zip(spots[view], part, strict=True))
    grid[0].plot(across, down, "o", color=RED, ms=4.2, mec="white", mew=0.8)
    binary = np.where(mask, np.where(truth, 0.1, 0.85), 1.0)  # greys: salient, the rest of the object, background
    grid[1].imshow(binary[part], cmap="gray", vmin=0, vmax=1)
    for axes, machine in zip(grid[2:], machines, strict=True):
        answer = np.full(mask.shape, np.nan)
        answer[mask] = next(iter(svms[machine].values())).predict(maps[view][:, mask].T)
        axes.imshow(answer[part], cmap=MAP, vmin=0, vmax=1)
        axes.contour(np.nan_to_num(answer)[part], [0.5], colors=[RED], linewidths=0.9)
    name_panels(grid[None], [f"{name}, {len(down)} points", "binarised ground truth", *map(label, machines)])
    for axes in grid:
        axes.set_axis_off()
    figure.colorbar(grid[2].images[0], ax=grid, shrink=0.8, pad=0.015, aspect=18).set_label("the SVM's answer")
    return Figure(figure)


def _nearest(viewpoints: Sequence[Viewpoint], masks: np.ndarray, among: Iterable[int]) -> int:
    """The view number of `among` that is nearest to the other figures' viewpoint.

    Views that show nothing, as of a sheet from its edge, are left out (masks (v, h, w) boolean).
    """
    filled_views = [view for view in among if masks[view].any()]
    return max(filled_views, key=lambda view: viewpoints[view].axes[2] @ VIEWPOINT.axes[2])


def _render(mesh: Mesh, viewpoint: Viewpoint, mask: np.ndarray) -> np.ndarray:
    """(h, w, 3) f8 in 0..1: the object as a map with the mask (h, w) shows it, on white."""
    height, width = mask.shape
    side = (width - height) // 2
    render = picture(mesh, viewpoint=viewpoint, rows=height)
    return np.pad(render, ((0, 0), (side, width - height - side), (0, 0)), constant_values=1.0)


def _window(mask: np.ndarray, square: bool = False) -> tuple[slice, slice]:
    """The rows and columns that hold the object (mask (h, w) boolean), square where the map is large enough."""
    places = [np.flatnonzero(mask.any(axis=axis)) for axis in (1, 0)]
    starts, stops = np.transpose([(max(ids[0] - MARGIN, 0), ids[-1] + MARGIN + 1) for ids in places])
    if square:
        side = (stops - starts).max()
        starts = np.clip((starts + stops - side) // 2, 0, np.maximum(np.array(mask.shape) - side, 0))
        stops = starts + side
    return slice(starts[0], stops[0]), slice(starts[1], stops[1])


def by_method(results: Results) -> Figure:
    """NSS on gaze against seconds, for every method."""
    rows = results.rows("salient_points", "gaze")
    frame = agreement(rows, ["nss"])
    frame = frame.loc[~frame["has_seen"] & (frame["method"] != HUMAN)]
    seconds = frame["method"].map(attention_seconds(results, "gaze"))
    frame = frame.assign(seconds=seconds, name=frame["method"].map(method_text)).dropna(subset=["seconds"])
    title, unit = "Predicting where people look", label(CLASSICAL)
    chart = pareto_chart(
        frame, "mean", title=title, reference=unit, quality_label="NSS on human gaze",
        clock=results.clock("salient_points", "gaze"), units=scores(rows, "nss").rename(columns=method_text),
    )  # fmt: skip
    chart.words["objects"] = frame["objects"].max()
    return chart


OURS, ANY_POSE, HUMAN = "glance", "glance_any_pose", "human"
CLASSICAL, THESIS = "itti", "VisAttAll"
NO_RIVALS = (OURS, ANY_POSE, HUMAN)  # our models, and the ceiling
SAME = ("VisAtt",)  # the classical model under the thesis's name
NAMES = {"random": "random points", "svm": "thesis, SVM"}  # elsewhere blind touch, and a classifier
ALONE = {"nss": "NSS", "auc": "AUC"}  # shown with their interval, and in which ours is compared with each other method
MEAN, GAIN = ["mean", "low", "high"], ["gain", "gain_low", "gain_high"]  # columns: of a method, and over another


def method_text(method: str) -> str:
    """A method's name as a person says it, with a star where it has seen the object."""
    name = NAMES.get(method) or label(method)
    return f"{name} *" if has_seen(method) else name


def scores(rows: pd.DataFrame, metric: str) -> pd.DataFrame:
    """Frame objects x methods of one metric; NotRun where it was not measured."""
    values = rows[rows["metric"] == metric].dropna(subset=["value"])
    require_rows(values, f"no {metric}: no object has ground truth", "salient_points", runnable=False)
    return values[~values["method"].isin(SAME)].pivot_table(index="item", columns="method", values="value", sort=False)


def difference(rows: pd.DataFrame, metric: str, first: str, second: str) -> pd.Series:
    """First minus second, an object; NotRun where either was not judged."""
    table = scores(rows, metric)
    missing = [method for method in (first, second) if method not in table]
    if missing:
        raise NotRun(f"{' and '.join(missing)} not judged on objects with ground truth", "salient_points", False)
    return pd.Series(table[first] - table[second])


def rivals(rows: pd.DataFrame, metric: str) -> list[str]:
    """The methods that ours are to beat, best first: all but these, the ceiling, and those that peeked."""
    means = scores(rows, metric).mean().sort_values(ascending=False)
    return [method for method in map(str, means.index) if method not in NO_RIVALS and not has_seen(method)]


def gain(table: pd.DataFrame, first: str, second: str) -> dict[str, float]:
    """GAIN of one method over another, paired over the objects of `scores`; {} where either is absent."""
    if first == second or first not in table or second not in table:
        return {}
    return interval_columns("gain", interval(table[first] - table[second]))


def agreement(rows: pd.DataFrame, metrics: Sequence[str]) -> pd.DataFrame:
    """Tidy frame: method, has_seen, metric, objects, MEAN and, for ALONE, GAIN: of ours over the method.

    95 % intervals over the objects. In order of NSS, the human ceiling first.
    """
    tables, lines = {metric: scores(rows, metric) for metric in metrics}, []
    order = map(str, tables["nss"].mean().sort_values(ascending=False).index)
    for method in sorted(order, key=lambda name: name != HUMAN):
        for metric, table in tables.items():
            if method in table:
                line = {"method": method, "has_seen": has_seen(method), "metric": metric}
                line["objects"] = table[method].count()
                line |= interval_columns("mean", interval(table[method]), prefix="")
                lines.append(line | (gain(table, OURS, method) if metric in ALONE and method != HUMAN else {}))
    return pd.DataFrame(lines)


COUNTED = "points_strong"
MARKED = "household"  # the data set whose marks come with the project


MEANS = {
    "cc": "CC", "sim": "SIM", "kl": "KL", COUNTED: "points", "fne@0.05": "FNE", "fpe@0.05": "FPE", "wme@0.05": "WME",
}  # fmt: skip
PEEKED = {"guided_ssim": "guided_ssim+seen", "guided_ed": "guided_ed+seen", "svm": "svm+object"}


def against_gaze(results: Results) -> Table:
    """The meshes with human gaze, each left out of the learning."""
    rows = results.rows("salient_points", "gaze")
    return _table(results, rows, list(MEANS), {"count": rows["item"].nunique()})


def against_clouds(results: Results) -> Table:
    """The point clouds with human gaze, each left out of the learning; how their surfaces are made costs apart."""
    rows = results.rows("salient_points", "gaze_clouds")
    return _table(results, rows, list(MEANS), {"count": rows["item"].nunique()})


def against_marks(results: Results) -> Table:
    """The marks on this run's own objects."""
    rows = results.measured("salient_points")
    dataset, count = rows["dataset"].iloc[0], rows.loc[rows["metric"] == "nss", "item"].nunique()
    default = f"The truth is what comes with the data set {dataset}."
    truth = shared_notes(__package__, "marks") if dataset == MARKED else default
    return _table(results, rows, [COUNTED, "fne@0.05", "fpe@0.05"], {"count": count, "truth": truth})


def _table(results: Results, rows: pd.DataFrame, beside: Sequence[str], words: dict) -> Table:
    """The judged rows, with those of MEANS that stand beside NSS and AUC; words: without those that the numbers say.

    The seconds are those from the pictures to the points; of a set without rows of pictures or maps there are none.
    """
    cost: dict[str, float] = {}
    with suppress(NotRun):
        cost = attention_seconds(results, rows["dataset"].iloc[0])
    frame = agreement(rows, [*ALONE, *beside])
    names, lines = list(ALONE.values()), {}
    columns = ["method", *names, *(f"glance minus it, {name}" for name in names), *map(MEANS.get, beside)]
    columns += ["seconds"] if cost else []
    for row in records(frame.reindex(columns=frame.columns.union(GAIN))):
        line = lines.setdefault(row.method, dict.fromkeys(columns, "–"))
        line |= {"method": method_text(row.method), "seconds": number(cost[row.method]) if row.method in cost else "–"}
        if row.metric in ALONE:
            line[ALONE[row.metric]] = with_interval(row.mean, row.low, row.high, places=2)
        elif row.mean == row.mean:
            line[MEANS[row.metric]] = f"{row.mean:.{1 if row.metric == COUNTED else 2}f}"
        if row.gain == row.gain:
            line[f"glance minus it, {ALONE[row.metric]}"] = signed(row.gain, row.gain_low, row.gain_high)
    findings = "\n".join([*_ours_and_rivals(rows), *_peeking(rows)])
    words = words | {"findings": findings, "reading": shared_notes(__package__, "reading")}
    cells = pd.DataFrame(lines.values())
    truth_and_peeking = [method_text(name) for name in lines if name == HUMAN or has_seen(name)]
    answer = [name for name in columns if name not in MEANS.values() or name == MEANS[COUNTED]]
    return Table(
        frame, cells, words, Ranking(names, exempt=truth_and_peeking, aside="the truth and starred rows aside"), answer
    )


def _ours_and_rivals(rows: pd.DataFrame) -> Iterator[str]:
    """How many rivals ours beats beyond chance, by each of ALONE."""
    for metric, name in ALONE.items():
        table = scores(rows, metric)
        methods = rivals(rows, metric) if OURS in table else []
        beaten = sum(interval(table[OURS] - table[rival])[1] > 0 for rival in methods)
        if methods:
            yield f"By {name} the glance beats {beaten} of {len(methods)} methods that have not seen the object."


def _peeking(rows: pd.DataFrame) -> Iterator[str]:
    """The gain of the same method from having seen the object: the leak of the thesis's way of testing."""
    gains = []
    for clean, peeked in PEEKED.items():
        with suppress(NotRun):
            gains.append(f"{label(clean)} {interval(difference(rows, 'nss', peeked, clean))[0]:+.2f}")
    if gains:
        yield f"A star: the method has learned from this object, too. That adds, in NSS: {'; '.join(gains)}."


PAGE = "look"
TABLES = {
    "attention_gaze": against_gaze,
    "attention_clouds": against_clouds,
    "attention_marks": against_marks,
}
FIGURES = {
    "figure_3_3": figure_3_3,
    "figure_3_10": figure_3_10,
    "figure_3_12": figure_3_12,
    "figure_3_13": figure_3_13,
}
CHARTS = {
    "attention": by_method,
}
