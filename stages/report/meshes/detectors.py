"""Every detector and combination of channels by the errors of the mesh that keeps its points (T3.1.5)."""

from contextlib import suppress

import numpy as np
import pandas as pd

from stages.kit.stats import interval
from stages.report.grid import means
from stages.report.items import Table
from stages.report.markdown import number
from stages.report.results import NotRun, Results
from stages.report.words import dataset_text
from stages.salient_points import METHODS

from .methods import COMBINATIONS, PLAIN, ordered, short
from .rows import ERRORS, METRICS, STAGE, UNITS, data_sets, marked, paired_cells, wide

MAIN = (*METRICS, "gaze_error")  # shown for the data sets after the first


def combinations(results: Results) -> Table:
    """The combinations of channels, in the thesis's order, and the mean errors that each led to."""
    found = []
    with suppress(NotRun):  # the list is worth having without the errors
        found = means(paired_cells(results, methods=COMBINATIONS), ["method", "metric"])
    found = pd.DataFrame(found, columns=["method", "metric", "mean"])
    errors = found.pivot(index="method", columns="metric", values="mean")
    metrics = [metric for metric in ERRORS if metric != "gaze_error" or metric in errors]
    channels = {short(method): ", ".join(METHODS[method].channels) for method in COMBINATIONS}
    frame = pd.DataFrame({"combination": channels.keys(), "channels": channels.values()})
    frame[metrics] = errors.reindex(COMBINATIONS, columns=metrics).to_numpy(dtype=float)
    shown = frame[["combination", "channels"]].copy()
    for metric in metrics:
        shown[ERRORS[metric]] = (UNITS[metric] * frame[metric]).map(number).replace("–", "not run")
    return Table(frame, shown)


def every_detector(results: Results) -> Table:
    """Errors and numbers of points of every method, on every data set."""
    found = {dataset_text(name): _per_object(results, name) for name in data_sets(results)}
    found = {data: table for data, table in found.items() if PLAIN in table.index.unique("method")}
    if not found:
        raise NotRun("no face count that plain QEM and all other methods reach on one object", STAGE, runnable=False)
    frame = pd.concat([_means(table).assign(data=data) for data, table in found.items()], ignore_index=True)
    counts = ", ".join(f"{len(table.index.unique('item'))} {data}" for data, table in found.items())
    return Table(frame[["data", *frame.columns[:-1]]], _wide(frame), {"counts": counts})


def _per_object(results: Results, dataset: str) -> pd.DataFrame:
    """Frame (object, method) x (errors, points, kept): means over the targets that all methods reach."""
    rows, key = paired_cells(results, dataset=dataset), ["item", "method"]
    errors = rows.pivot_table(index=key, columns="metric", values="value", sort=False)
    return errors.join(rows.groupby(key, sort=False)[[name for name in ("points", "kept") if name in rows]].mean())


def _means(table: pd.DataFrame) -> pd.DataFrame:
    """A row a method and metric: the mean over the objects, of an error beside that of plain QEM."""
    lines, plain = [], table.xs(PLAIN, level="method")
    for method in ordered(table.index.unique("method")):
        mine = table.xs(method, level="method")
        for metric in table.columns:
            gain = interval(mine[metric] - plain[metric].reindex(mine.index)) if metric in ERRORS else [np.nan] * 3
            lines.append([method, metric, mine[metric].count(), *interval(mine[metric]), *gain])
    over = [f"over_plain{end}" for end in ("", "_low", "_high")]
    return pd.DataFrame(lines, columns=["method", "metric", "objects", "mean", "low", "high", *over])


def _wide(frame: pd.DataFrame) -> pd.DataFrame:
    own, texts, heads = frame["data"].iloc[0], [], []
    cells = frame[(frame["data"] == own) | frame["metric"].isin(MAIN)]
    for row in cells.itertuples():
        name = ERRORS.get(row.metric, row.metric)
        heads.append(name if row.data == own else f"{name}, {row.data}")
        texts.append(marked(row) if row.metric in ERRORS else f"{row.mean:.1f}")
    found = wide(cells.assign(text=texts, head=heads), "method", "head")
    first = [name for name in ("points", "kept") if name in found]
    found = found.loc[ordered(found.index), [*first, *found.columns.drop(first)]]
    return found.rename(short).reset_index(names="kept points")
