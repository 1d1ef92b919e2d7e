"""Rows in reports/measurements by stage and data set, as pandas frames; what is missing is Missing, never a crash."""

from collections.abc import Callable, Hashable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from .rows import SUFFIX, read_rows

RECENT = 128  # answers that are kept: the two sides of a claim are asked for again and again


class Missing(Exception):
    """Rows that are absent; the message says which."""


class Measurements:
    """The rows below a folder of reports, read once a file.

    folder: that of reports.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder / "measurements"
        self._cache: dict[Hashable, Any] = {}
        self._recent: dict[Hashable, Any] = {}

    def path(self, stage: str, dataset: str) -> Path:
        """The file of a stage's rows on one set."""
        return self.folder / dataset / f"{stage}{SUFFIX}"

    def rows(self, stage: str, dataset: str, **where: Any) -> pd.DataFrame:
        """Rows of a stage on one set whose columns have one of the wanted values, or no value for None.

        Raises Missing where the file or a column is absent, or no row is left, with the rows' own note on why.
        """
        frame = self._frame(stage, dataset)
        chosen = np.ones(len(frame), dtype=bool)
        for column, value in where.items():
            if column not in frame:
                raise Missing(f"no column {column} in the rows of {stage} on {dataset}")
            chosen &= self._equal(stage, dataset, column, value)
            if not chosen.any():
                words = f"{column} {either(value)} is not among those that {stage} measured on {dataset}"
                raise Missing(self._note(stage, dataset, where) or words)
        return frame[chosen] if where else frame.copy(deep=False)

    def measured(self, stage: str, dataset: str, **where: Any) -> pd.DataFrame:
        """As `rows`, only those that have a value; Missing where there is none."""
        frame = self.rows(stage, dataset, **where)
        frame = frame[frame["value"].notna()]
        if frame.empty:
            raise Missing(self._note(stage, dataset, where) or f"{stage} has rows of this on {dataset}, but no value")
        return frame

    def cached(self, key: Hashable, work: Callable[[], Any]) -> Any:
        """The result of some work on the rows, computed at the first call."""
        if key not in self._cache:
            self._cache[key] = work()
        return self._cache[key]

    def cached_recently(self, key: Hashable, work: Callable[[], Any]) -> Any:
        """The result of some work on the rows, computed anew once RECENT others were asked for."""
        if key not in self._recent:
            self._recent[key] = work()
            if len(self._recent) > RECENT:
                del self._recent[next(iter(self._recent))]
        return self._recent[key]

    def _frame(self, stage: str, dataset: str) -> pd.DataFrame:
        path = self.path(stage, dataset)
        if not path.exists():
            raise Missing(f"no measurements of {stage} on {dataset}")
        return self.cached(path, lambda: read_rows(path))

    def _equal(self, stage: str, dataset: str, column: str, value: Any) -> np.ndarray:
        """(n,) bool: which rows have a wanted value in a column; compares each value once."""
        key = stage, dataset, column
        codes, values = self.cached(key, lambda: pd.factorize(self._frame(stage, dataset)[column]))
        wanted = np.zeros(len(values), dtype=bool) if value is None else values.isin(listed(value))
        return np.append(wanted, value is None)[codes]  # the code of an empty cell is -1

    def notes(self, stage: str, dataset: str, where: Mapping[str, Any]) -> list[str]:
        """The rows' own notes on why they have no value, each once; an empty cell of a row stands for any value."""
        frame = self._frame(stage, dataset)
        if "note" not in frame or "value" not in frame:
            return []
        chosen = (frame["value"].isna() & frame["note"].notna()).to_numpy()
        for column in where.keys() & frame.columns:
            equal, empty = (self._equal(stage, dataset, column, value) for value in (where[column], None))
            chosen = chosen & (equal | empty)
        return list(dict.fromkeys(frame.loc[chosen, "note"]))

    def _note(self, stage: str, dataset: str, where: Mapping[str, Any]) -> str:
        """The first two notes."""
        return "; ".join(self.notes(stage, dataset, where)[:2])


def listed(value: Any) -> list:
    """One value or several, as a list."""
    return list(value) if isinstance(value, list | tuple | set | frozenset) else [value]


def either(value: Any) -> str:
    """One value or several, in words: `knn or svm`."""
    return " or ".join(map(str, listed(value)))
