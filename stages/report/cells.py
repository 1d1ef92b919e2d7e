"""Figures in sentences: `{tables/scenes scene=shelf method=uniform: 100*saved .0f}` becomes what that cell holds."""

import re
from collections.abc import Callable
from pathlib import Path

import pandas as pd

from .markdown import number

PLACE = re.compile(r"\{(\S+) ([^:{}]*): ([^{}]+)\}")
CLAIMS = "claims"  # reports/claims.csv; all others are KIND/NAME
PREFIXES: dict[str, Callable[[float], float]] = {  # before a column's name -> what is shown of its number
    "": lambda number: number,
    "-": lambda number: -number,
    "1-": lambda number: 1 - number,
    "1/": lambda number: 1 / number,
    "100*": lambda number: 100 * number,
    # of a difference in % of the mean of both sides: how many times the second the first has, and % less of it
    "times:": lambda number: (200 - number) / (200 + number),
    "less:": lambda number: 200 * number / (200 + number),
}


def filled(text: str, reports: Path) -> tuple[str, list[tuple[str, str]]]:
    """(the text with its figures, [(KIND/NAME or claims, which row)] of each); LookupError where one is missing."""
    sources = [(name, where) for name, where, _ in PLACE.findall(text)]
    return PLACE.sub(lambda found: _figure(reports, *found.groups()), text), sources


def _figure(reports: Path, name: str, where: str, columns: str) -> str:
    """`1.64 [1.41, 1.88]`, or one number; columns: one or three, and how many places, as `.0f`."""
    *wanted, last = columns.split()
    places = re.fullmatch(r"\.(\d)f", last)
    row = _row(reports / f"{name}.csv", where)
    values = [_cell(row, column) for column in (wanted if places else [*wanted, last])]
    mean, *ends = values
    low, high = sorted(ends) if ends else (float("nan"),) * 2
    if mean != mean:
        raise LookupError(f"{name} {where} has no value")
    show = (lambda value: f"{value:,.{places[1]}f}") if places else _shown
    return show(mean) if low != low else f"{show(mean)} [{show(low)}, {show(high)}]"


def _shown(value: float) -> str:
    return f"{value:,.0f}" if abs(value) >= 1000 else number(value)


def _row(path: Path, where: str) -> pd.Series:
    """The only row that agrees with `column=value column=value`, empty cells included."""
    if not path.exists():
        raise LookupError(f"no {path.name}")
    frame = pd.read_csv(path, dtype=str, keep_default_na=False)
    for pair in where.split():
        column, _, value = pair.partition("=")
        frame = frame[frame[column] == value] if column in frame else frame[:0]
    if len(frame) != 1:
        raise LookupError(f"{path.name} has {len(frame)} rows with {where}")
    return frame.iloc[0]


def _cell(row: pd.Series, wanted: str) -> float:
    ((prefix, column),) = re.findall(r"^(-|1-|1/|100\*|times:|less:)?(\w+)$", wanted)
    return PREFIXES[prefix](float(row[column] or "nan"))
