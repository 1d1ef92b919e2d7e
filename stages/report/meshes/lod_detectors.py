"""Every detector and combination of channels by the errors of the mesh that keeps its points (T3.1.5, figure 3.5)."""

import pandas as pd

from stages.kit.stats import interval
from stages.report.items import Table
from stages.report.results import NotRun, Results
from stages.report.style import WAYS, label
from stages.report.words import dataset_text

from .figure_3_6 import NAMES as SHORT
from .rows import ERRORS, PLAIN, cells, data_sets, marked, paired_cells

LAST = ("svm", "enhanced", "random")
NAMES = {name: SHORT[name] for name in SHORT if name not in LAST}
NAMES |= {"thesis_ed": "ED, table 3.1", **{name: SHORT[name] for name in LAST}}
MAIN = ["metro_mean", "ssim_error", "gaze_error"]  # shown for the data sets after the first
NOTES = [
    "Errors: each object's mean over the face counts that all methods of the table reach on it, then the mean over the "
    "objects [95 % interval over the objects]; so every row is over the same meshes ({counts}). A mean over the "
    "counts of this run: other counts, other figures. Metro and the errors where one looks in % of the diagonal.",
    "+ and – behind a figure: higher or lower than plain QEM beyond chance (95 % interval of the paired difference). "
    "Where our model looks: the distance weighted by the saliency of our gaze model, which also chose the points and "
    "weights of `ours`: no independent judge of those. Where people look: the same weighted by recorded human gaze, on "
    "the meshes that have it, which the model has not seen when it chose there.",
    "Points: those that pass the method's own threshold; kept: those whose neighbourhood was still kept at all when "
    "the target left too few faces for all, mean over the same meshes.",
    "Errors by single face count: figures 3.4, 3.5 and 3.23, and table 3.2; all intervals, also of the other data "
    "sets: the CSV.",
]


def build(results: Results) -> Table:
    tables = {dataset_text(name): per_object(results, name) for name in data_sets(results)}
    tables = {data: table for data, table in tables.items() if PLAIN in table.index.unique("method")}
    if not tables:
        raise NotRun("no face count that plain QEM and all other methods reach on one object", "lod", runnable=False)
    frame = pd.concat([_means(table, data) for data, table in tables.items()], ignore_index=True)
    counts = ", ".join(f"{len(table.index.unique('item'))} {data}" for data, table in tables.items())
    notes = [note.replace("{counts}", f"objects: {counts}") for note in NOTES]
    return Table("Every detector: errors and points", frame, notes, _wide(frame))


def ordered(methods):
    """The methods in the thesis's order (figure 3.6), then those with a way behind their name, plain QEM last."""
    base = list(NAMES)
    order = [*base, *(f"{name}-{way}" for name in base for way in WAYS)]
    known = sorted((name for name in methods if name in order), key=order.index)
    return known + sorted(set(methods) - set(known) - {PLAIN}) + [PLAIN] * (PLAIN in methods)


def short(method):
    """The thesis's short name of a method."""
    base, _, way = method.rpartition("-")
    return f"{short(base)}, {way}" if way in WAYS else NAMES.get(method, label(method))


def per_object(results, dataset=None):
    """Frame (object, method) x (errors, points, kept, plain errors): means over the targets that all methods reach."""
    metrics = list(ERRORS)
    every = cells(results, metrics, dataset)
    rows = paired_cells(results, metrics, set(every["method"]), dataset)
    key = ["item", "method"]
    errors = rows.pivot_table(index=key, columns="metric", values="value", sort=False)
    counts = rows.groupby(key, sort=False)[[name for name in ("points", "kept") if name in rows]].mean()
    return errors.join(counts)


def _means(table, data):
    lines = []
    for method in ordered(set(table.index.get_level_values("method"))):
        mine, plain = table.xs(method, level="method"), table.xs(PLAIN, level="method")
        for metric in table:
            mean, low, high = interval(mine[metric])
            line = {"data": data, "method": method, "metric": metric, "objects": mine[metric].count()}
            line |= {"mean": mean, "low": low, "high": high}
            if metric in ERRORS:
                gain = interval(mine[metric] - plain[metric].reindex(mine.index))
                line |= dict(zip(("over_plain", "over_plain_low", "over_plain_high"), gain, strict=True))
            lines.append(line)
    return pd.DataFrame(lines)


def _wide(frame):
    own, lines = frame["data"].iloc[0], []
    for method in ordered(set(frame["method"])):
        line = {"kept points": short(method)}
        for row in frame[frame["method"] == method].itertuples():
            if row.metric in ERRORS and (row.data == own or row.metric in MAIN):
                name, factor = ERRORS[row.metric]
                line[name if row.data == own else f"{name}, {row.data}"] = marked(row, factor)
            elif row.data == own:
                line[row.metric] = f"{row.mean:.1f}"
        lines.append(line)
    shown = pd.DataFrame(lines).fillna("–")
    first = [name for name in ("kept points", "points", "kept") if name in shown]
    return shown[[*first, *(name for name in shown if name not in first)]]
