"""Frames as text: numbers rounded for a reader, and Markdown tables."""

import math
import numbers
import re
from collections.abc import Iterable
from typing import Any

import pandas as pd

WORDS = ("not run", "infeasible", "")  # that stand in columns of numbers


def number(value: Any, digits: int = 3) -> str:
    """A number to `digits` significant digits without exponent clutter; a dash for NaN; other things as they are."""
    if value is None or value != value:
        return "–"
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        return str(value)
    value = float(value)
    if value.is_integer() and abs(value) < 1e7:
        return f"{int(value):,}"
    if 0 < abs(value) < 1e-4:
        return f"{value:.{digits - 1}e}"
    places = max(0, digits - 1 - math.floor(math.log10(abs(value))))
    return f"{value:.{places}f}"


def with_interval(mean: float, low: float, high: float, scale: float = 1, places: int | None = None) -> str:
    """`mean [low, high]`, or the mean alone where the interval is unknown; "not run" without a mean."""
    if mean != mean:
        return "not run"
    show = (lambda v: f"{v * scale:.{places}f}") if places is not None else (lambda v: number(v * scale))
    return show(mean) if low != low else f"{show(mean)} [{show(low)}, {show(high)}]"


def signed(mean: float, low: float, high: float, places: int = 2) -> str:
    """`+0.83 [0.61, 1.05]`."""
    mean, low, high = (round(value, places) + 0.0 for value in (mean, low, high))  # no minus before a zero
    span = f" [{low:.{places}f}, {high:.{places}f}]" if low == low else ""
    return f"{mean:+.{places}f}{span}"


def as_text(frame: pd.DataFrame) -> pd.DataFrame:
    """A frame of strings, numbers rounded to three significant digits."""
    return frame.map(number)


def markdown_table(frame: pd.DataFrame, bold: Iterable[bool] = ()) -> str:
    """A GitHub table of a frame of strings; columns of numbers stand to the right. bold: of each row whether it is."""
    marks = ["**" if row else "" for row in bold] or [""] * len(frame)
    rows = [
        [f"{mark}{text}{mark}" if (text := str(cell).replace("|", r"\|")) else "" for cell in row]
        for mark, row in zip(marks, frame.itertuples(index=False), strict=True)
    ]
    rules = ["---:" if is_numeric(frame[column]) else "---" for column in frame.columns]
    lines = [[str(column) for column in frame.columns], rules, *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def is_numeric(column: pd.Series) -> bool:
    """True for a column of strings that hold numbers alone: signs, intervals, a dash or a few words are let through."""
    return all(cell in WORDS or re.fullmatch(r"[-+–±\d.,:e\[\]· ]*", str(cell)) for cell in column)
