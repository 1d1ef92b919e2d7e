"""The one schema of all measurements: a table of rows per stage and data set, checked when it is written.

Every row has the columns of COMMON; a stage declares the others, with a word on each, as COLUMNS in its __init__.py. A
unit counts once in an interval: an object with its copies, a class with its objects, an object with its draws.
"""

from __future__ import annotations

import contextlib
import csv
import gzip
import io
import numbers
import re
import sys
from collections.abc import Collection, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from haptic_glance.base.files import read_table, whole_file
from haptic_glance.base.lazy import pandas as pd
from haptic_glance.base.timing import clock

COMMON = {
    "dataset": "the data set",
    "item": "the object that the row is about; empty where it is about several",
    "group": "the set, class or scene that the item belongs to, or that the row as a whole is about",
    "method": "what was measured: a detector, channel, network, backend or strategy",
    "split": "how training and test parts were drawn: a name of haptic_glance.know.split.Split",
    "metric": "the name of the number",
    "value": "the number; empty where there is none, and `note` says why",
    "seconds": "how long it took on one core",
    "clock": "of the seconds: processor, and its model; absent in older rows, which have wall time",
    "seed": "of all random numbers",
    "note": "why there is no value, or what a reader must know of it",
}
FIRST, LAST = tuple(COMMON)[:5], tuple(COMMON)[5:]  # before and after the columns of a stage
NEEDED = ("dataset", "value")  # without one of the others, what compares by it is not run, and says so
SUFFIX = ".csv.gz"


def write_rows(
    path: Path, rows: Iterable[Mapping[str, Any]], columns: Mapping[str, str], dataset: str, seed: int
) -> None:
    """Writes rows as a compressed CSV: the common columns, and between them those that the stage declares.

    A row is written before the next one is asked for. Keys that begin with _ are for the stage alone and not written.
    Raises ValueError that names a column which is not declared, a row without a metric, or a split which is unknown.
    """
    names = [*FIRST, *columns, *LAST]
    with contextlib.ExitStack() as stack:
        file = stack.enter_context(open(stack.enter_context(whole_file(path)), "wb"))
        gzip_file = stack.enter_context(gzip.GzipFile("", "wb", fileobj=file, mtime=0))  # equal rows give equal bytes
        table = csv.writer(stack.enter_context(io.TextIOWrapper(gzip_file, newline="")), lineterminator="\n")
        table.writerow(names)
        for number, row in enumerate(rows):
            _check(path, number, row, names)
            clock_text = None if _empty(row.get("seconds")) else clock()
            cells = {**row, "dataset": dataset, "clock": clock_text, "seed": seed}
            table.writerow([_cell(name, cells.get(name)) for name in names])


def _check(path, number, row, names):
    unknown = sorted(name for name in row.keys() - names if not name.startswith("_"))
    if unknown:
        raise ValueError(f"{path.name}: columns {', '.join(unknown)} are not declared in the COLUMNS that StageRun got")
    if _empty(row.get("metric")):
        raise ValueError(f"{path.name}: row {number} has no metric")
    from haptic_glance.know.split import Split  # its package is large, and readers of rows do without

    split = row.get("split")
    if not _empty(split) and split not in ("", *Split):
        raise ValueError(f"{path.name}: split {split} is not one of {', '.join(Split)}")


def _cell(name, value):
    """A cell as text: six significant digits, like write_table."""
    if _empty(value):
        return ""
    if name in ("value", "seconds"):
        return f"{float(value):.6g}"  # raises for a text
    is_float = isinstance(value, numbers.Real) and not isinstance(value, numbers.Integral)
    return f"{value:.6g}" if is_float else str(value)


def _empty(value):
    return value is None or value != value  # NaN alone differs from itself


def read_rows(path: Path) -> pd.DataFrame:
    """Reads what write_rows wrote; names stay texts even where they look like numbers.

    Raises ValueError that names a column of NEEDED which the file lacks.
    """
    names = ("dataset", "item", "group", "method", "split", "target", "note")
    rows = read_table(path, dtype=dict.fromkeys(names, str))
    for column in NEEDED:
        if column not in rows:
            raise ValueError(f"{path} has no column {column}: `git checkout {path}` brings it back, or measure it anew")
    return rows


def some_rows(rows: Iterable[Mapping[str, Any]], columns: Sequence[str], metrics: Collection[str]) -> pd.DataFrame:
    """Some columns of the rows of some metrics; no other is held in memory, and equal texts are one."""
    selected = (row for row in rows if row["metric"] in metrics)
    values = ([row.get(name) for name in columns] for row in selected)
    cells = (tuple(sys.intern(value) if isinstance(value, str) else value for value in row) for row in values)
    return pd.DataFrame(cells, columns=list(columns))


def named_means(values: Iterable[tuple[str, float]]) -> dict[str, float]:
    """{name: the mean of its values}, for the gate; six digits."""
    by_name: dict[str, list[float]] = {}
    for name, value in values:
        by_name.setdefault(name, []).append(value)
    return {name: round(float(np.mean(group)), 6) for name, group in by_name.items()}


# Objects of the household set whose three sizes normalisation makes equal: 50 objects are 40 shapes.
COPIES = re.compile(r"(cube|cylinder|pyramid|sphere|torus)(?:small|medium|large)")
BENCHMARK = re.compile(r"([A-Z][A-Za-z]+)_\d+")  # CLASS_ID: a mesh of the Princeton segmentation benchmark


def unit(item: str) -> str:
    """The unit of an object: its shape if other objects are copies of it, its class if its name says it."""
    match = COPIES.fullmatch(item) or BENCHMARK.fullmatch(item)
    return match[1] if match else item


def by_unit(values: pd.Series) -> pd.Series:
    """The means of the outermost units of values whose index runs from the outermost level to the innermost.

    A level `item` counts by `unit`. Means are taken level by level, from the innermost: a unit with many draws weighs
    as much as one with few. The bootstrap over these means is the hierarchical one: outermost units are drawn with
    replacement, and what is inside of one comes along whole. The spread of the means holds the spread inside. Drawing
    inside again would count that twice (Davison and Hinkley, Bootstrap Methods and their Application, 1997, section
    3.8; Ren et al., Nonparametric bootstrapping for hierarchical data, 2010). NaN is left out.
    """
    values = values.dropna()
    if values.index.nlevels == 1 and values.index.name == "item":
        units = [unit(str(label)) for label in values.index]
        distinct = len(set(units)) == len(units)
        return values.set_axis(units) if distinct else values.groupby(units, sort=False).mean()
    if "item" in values.index.names:
        levels = [values.index.get_level_values(depth) for depth in range(values.index.nlevels)]
        merged = [[unit(str(label)) for label in level] if level.name == "item" else level for level in levels]
        values = values.groupby(merged, sort=False).mean()
    for depth in range(values.index.nlevels - 1, 0, -1):
        values = values.groupby(level=list(range(depth)), sort=False).mean()
    return values
