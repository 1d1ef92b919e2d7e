"""The one schema of all measurements: a table of rows per stage and data set, checked when it is written.

Every row has the columns of COMMON; a stage declares the others, with a word on each, as COLUMNS in its schema.py.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from .files import read_table, write_table
from .split import Split

COMMON = {
    "dataset": "the data set",
    "item": "the object that the row is about; empty where it is about several",
    "group": "the set, class or scene that the item belongs to, or that the row as a whole is about",
    "method": "what was measured: a detector, channel, network, backend or strategy",
    "split": "how training and test parts were drawn: a name of stages.kit.split.Split",
    "metric": "the name of the number",
    "value": "the number; empty where there is none, and `note` says why",
    "seconds": "wall time of one core that it took",
    "seed": "of all random numbers",
    "note": "why there is no value, or what a reader must know of it",
}
FIRST, LAST = ("dataset", "item", "group", "method", "split"), ("metric", "value", "seconds", "seed", "note")
SUFFIX = ".csv.gz"


def write_rows(
    path: Path, rows: Sequence[Mapping[str, Any]], columns: Mapping[str, str], dataset: str, seed: int
) -> None:
    """Writes rows as a compressed CSV: the common columns, and between them those that the stage declares.

    Raises ValueError that names a column which is not declared, a row without a metric, or a split which is unknown.
    """
    frame = pd.DataFrame([dict(row) for row in rows])
    frame["dataset"], frame["seed"] = dataset, seed
    unknown = sorted(set(frame) - set(COMMON) - set(columns))  # type: ignore[type-var]  # of texts
    if unknown:
        raise ValueError(f"{path.name}: columns {', '.join(unknown)} are not declared in the stage's schema.py")
    frame = frame.reindex(columns=[*FIRST, *columns, *LAST])
    unnamed = np.flatnonzero(frame["metric"].isna())
    if len(unnamed):
        raise ValueError(f"{path.name}: row {unnamed[0]} has no metric")
    strange = sorted(set(frame["split"].dropna()) - set(Split) - {""})
    if strange:
        raise ValueError(f"{path.name}: split {', '.join(strange)} is not one of {', '.join(Split)}")
    frame["value"] = pd.to_numeric(frame["value"])  # raises for a text
    write_table(path, frame)


def read_rows(path: Path) -> pd.DataFrame:
    """Reads what write_rows wrote; names stay texts even where they look like numbers."""
    return read_table(path, dtype=dict.fromkeys(("dataset", "item", "group", "method", "split", "note"), str))
