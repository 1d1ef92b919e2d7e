"""Figures in sentences: `{tables/scenes scene=shelf method=uniform: 100*saved .0f}` becomes what that cell holds."""

import re
from collections.abc import Callable
from fnmatch import fnmatchcase
from pathlib import Path

import pandas as pd

from .markdown import number
from .style import label

PLACE = re.compile(r"\{(\S+) ((?:[^:{}]|:(?! ))*): ([^{}]+)\}")
PAIR = re.compile(r"(\w+)(!?=)(.*?)(?=\s+\w+!?=|\s*$)")
CLAIMS = "claims"  # reports/claims.csv; all others are KIND/NAME
QUALIFIED = ("depends on the reading", "not testable")  # verdicts without which a figure of a claim would mislead
ROWS = "rows"  # in place of columns: how many rows there are
ENDS = {"highest": pd.Series.idxmax, "lowest": pd.Series.idxmin}  # in place of a column: picks a row by the one named
PREFIXES: dict[str, Callable[[float], float]] = {  # before a column's name -> what is shown of its number
    "": lambda number: number,
    "-": lambda number: -number,
    "1-": lambda number: 1 - number,
    "1/": lambda number: 1 / number,
    "100*": lambda number: 100 * number,
    "-100*": lambda number: -100 * number,
    # of a difference in % of the mean of both sides: how many times the second the first has, and % less of it
    "times:": lambda number: (200 - number) / (200 + number),
    "less:": lambda number: 200 * number / (200 + number),
}


def filled(text: str, reports: Path) -> tuple[str, list[tuple[str, str]]]:
    """(the text with its figures, [(KIND/NAME or claims, which row)] of each); LookupError where one is missing.

    Which row: `column=value column!=value`, with `*` for any part of a value; of those left, `highest=column` or
    `lowest=column` picks one. What: `rows` for their number; one column, a number or a name; or three: a mean and the
    ends of its interval. Then, where wanted, `higher|lower`: the words for a difference above and below zero; and the
    places, `.0f`.
    """
    sources = [(name, where) for name, where, _ in PLACE.findall(text)]
    return PLACE.sub(lambda found: _figure(reports, *found.groups()), text), sources


def _figure(reports: Path, name: str, where: str, what: str) -> str:
    """`1.64 [1.41, 1.88]`, `0.4 [0.2, 0.6] higher`, one number, or a name."""
    columns, words, places = parts_of(what)
    found = _rows(reports / f"{name}.csv", where)
    if columns == [ROWS]:
        return f"{len(found):,}"
    if len(found) != 1:
        raise LookupError(f"{name} has {len(found)} rows with {where}")
    row = found.iloc[0]
    try:
        mean, *ends = (_cell(row, column) for column in columns)
    except ValueError:  # no number
        return label(row[columns[0]])
    known = ends and all(end == end for end in ends)
    low, high = sorted(ends) if known else (float("nan"),) * 2
    word = f" ({row['verdict']})" if name == CLAIMS and row.get("verdict") in QUALIFIED else ""
    if mean != mean or (words and not known):
        raise LookupError(f"{name} {where} has no {'interval' if mean == mean else 'value'}")
    show = (lambda value: f"{value:,.{places}f}") if places else _shown
    if words:
        return _difference(mean, low, high, words, show) + word
    return (show(mean) if low != low else f"{show(mean)} [{show(low)}, {show(high)}]") + word


def parts_of(what: str) -> tuple[list[str], list[str], str]:
    """(columns, the two words for a difference or none, places) of `mean low high NSS higher|NSS lower .2f`."""
    text, _, places = what.strip().partition(" .")
    found = re.fullmatch(r"(\S+ \S+ \S+) ([^|]+)\|([^|]+)", text)
    columns, *words = found.groups() if found else (text,)
    return columns.split(), words, places.removesuffix("f")


def _difference(mean: float, low: float, high: float, words: list[str], show: Callable[[float], str]) -> str:
    """`0.4 [0.2, 0.6] higher`; `neither higher nor lower beyond chance (0.1 [-0.2, 0.4])`."""
    if low > 0:
        return f"{show(mean)} [{show(low)}, {show(high)}] {words[0]}"
    if high < 0:
        return f"{show(-mean)} [{show(-high)}, {show(-low)}] {words[1]}"
    return f"neither {words[0]} nor {words[1]} beyond chance ({show(mean)} [{show(low)}, {show(high)}])"


def _shown(value: float) -> str:
    return f"{value:,.0f}" if abs(value) >= 1000 else number(value)


def _rows(path: Path, where: str) -> pd.DataFrame:
    """The rows that agree with `where`, empty cells included; strings."""
    if not path.exists():
        raise LookupError(f"no {path.name}")
    frame = pd.read_csv(path, dtype=str, keep_default_na=False)
    for column, sign, value in PAIR.findall(where):
        wanted = value if column in ENDS else column
        if wanted not in frame:
            raise LookupError(f"{path.name} has no column {wanted}")
        if column in ENDS:
            numbers = pd.to_numeric(frame[value]).dropna()
            frame = frame.loc[[ENDS[column](numbers)]] if len(numbers) else frame[:0]
        else:
            frame = frame[[fnmatchcase(cell, value) == (sign == "=") for cell in frame[column]]]
    return frame


def _cell(row: pd.Series, wanted: str) -> float:
    """A number of a row; ValueError where the cell holds a word."""
    prefixes = "|".join(map(re.escape, sorted(PREFIXES, key=len, reverse=True)))
    ((prefix, column),) = re.findall(rf"^({prefixes})(\S+)$", wanted)
    if column not in row:
        raise LookupError(f"no column {column}")
    return PREFIXES[prefix](float(row[column] or "nan"))
