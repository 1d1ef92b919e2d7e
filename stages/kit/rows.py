"""The one schema of all measurements: a table of rows per stage and data set, checked when it is written.

Every row has the columns of COMMON; a stage declares the others, with a word on each, as COLUMNS in its schema.py.
"""

import contextlib
import csv
import gzip
import io
import numbers
import sys
from collections.abc import Collection, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from haptic_glance.base.files import read_table, whole_file
from haptic_glance.base.timing import clock
from haptic_glance.know.split import Split

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
FIRST, LAST = ("dataset", "item", "group", "method", "split"), ("metric", "value", "seconds", "clock", "seed", "note")
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
        packed = stack.enter_context(gzip.GzipFile("", "wb", fileobj=file, mtime=0))  # equal rows give equal bytes
        table = csv.writer(stack.enter_context(io.TextIOWrapper(packed, newline="")), lineterminator="\n")
        table.writerow(names)
        for number, row in enumerate(rows):
            _check(path, number, row, names)
            measured = None if _empty(row.get("seconds")) else clock()
            known = {**row, "dataset": dataset, "clock": measured, "seed": seed}
            table.writerow([_cell(name, known.get(name)) for name in names])


def _check(path, number, row, names):
    unknown = sorted(name for name in row.keys() - names if not name.startswith("_"))
    if unknown:
        raise ValueError(f"{path.name}: columns {', '.join(unknown)} are not declared in the stage's schema.py")
    if _empty(row.get("metric")):
        raise ValueError(f"{path.name}: row {number} has no metric")
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
    """Reads what write_rows wrote; names stay texts even where they look like numbers."""
    names = ("dataset", "item", "group", "method", "split", "target", "note")
    return read_table(path, dtype=dict.fromkeys(names, str))


def some_rows(rows: Iterable[Mapping[str, Any]], columns: Sequence[str], metrics: Collection[str]) -> pd.DataFrame:
    """Some columns of the rows of some metrics; no other is held in memory, and equal texts are one."""
    found = (row for row in rows if row["metric"] in metrics)
    cells = (tuple(_shared(row.get(name)) for name in columns) for row in found)
    return pd.DataFrame(cells, columns=list(columns))


def _shared(value):
    return sys.intern(value) if isinstance(value, str) else value
