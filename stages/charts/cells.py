"""Cells of the tables in reports/, quoted in prose by one query language.

    {tables/stability perturbation=tilt method=glance: breaking_point low high .0f}      14 [10, 30]

A query names a CSV file below reports/ without its suffix, selects rows, and lists the columns with a format. The
topics' prose, the README, the documentation and the headlines use the same language; `filled` explains the syntax.
"""

import re
import statistics
from collections.abc import Callable, Sequence
from fnmatch import fnmatchcase
from functools import lru_cache
from pathlib import Path

import pandas as pd

from .drawing import label
from .tables import number

PLACE = re.compile(r"\{(\S+) ((?:[^:{}]|:(?! ))*): ([^{}]+)\}")
PAIR = re.compile(r"(\w+)(!?=)(.*?)(?=\s+\w+!?=|\s*$)")
REQUEST = re.compile(r"(.+?)(?: ([+,]*\.\d+[fg]))?")  # columns and words, format
CLAIMS = "claims"  # reports/claims.csv; all others are KIND/NAME
QUALIFIED = ("not testable",)  # verdicts without which a figure of a claim would mislead
ROWS = "rows"  # in place of columns: how many rows there are
ENDS = {"highest": pd.Series.idxmax, "lowest": pd.Series.idxmin}  # in place of a column: picks a row by the one named
PREFIXES: dict[str, Callable[[float], float]] = {  # before a column's name -> what is shown of its number
    "": lambda number: number,
    "-": lambda number: -number,
    "1-": lambda number: 1 - number,
    "1/": lambda number: 1 / number,
    "100*": lambda number: 100 * number,
    "1000*": lambda number: 1000 * number,
    "-100*": lambda number: -100 * number,
    "minutes:": lambda number: number / 60,
    # of a difference in % of the mean of both sides: how many times the second the first has, and % less of it
    "times:": lambda number: (200 - number) / (200 + number),
    "less:": lambda number: 200 * number / (200 + number),
}
OVER_ROWS = {"median:": statistics.median, "most:": max, "count:": len}  # before a column: of all rows, not of one
COLUMN = re.compile(
    rf"({'|'.join(map(re.escape, sorted(PREFIXES, key=len, reverse=True)))})({'|'.join(OVER_ROWS)})?(\S+)"
)


def filled(text: str, reports: Path) -> tuple[str, list[tuple[str, str]]]:
    """(the text with its figures, [(KIND/NAME or claims, which row)] of each); LookupError where one is missing.

    `{KIND/NAME WHICH ROW: COLUMNS WORDS FORMAT}` asks for a figure. The row is chosen by `column=value column!=value`,
    with `*` for any part of a value; `highest=column` or `lowest=column` picks one of the remaining rows. The columns
    are `rows` (their number), one column (a number or a name), or three (a mean and the ends of its interval).
    `higher|lower` are optional words for a difference above and below zero. The format is `.0f`, or `+.0f` with the
    sign of the mean.
    """
    sources = [(name, where) for name, where, _ in PLACE.findall(text)]
    return PLACE.sub(lambda match: _figure(reports, *match.groups()), text), sources


def _figure(reports: Path, name: str, where: str, request: str) -> str:
    """`1.64 [1.41, 1.88]`, `0.4 [0.2, 0.6] higher`, one number, or a name."""
    rows = rows_of(reports / f"{name}.csv", where)
    if request == ROWS:
        return f"{len(rows):,}"
    text = text_of(rows, request)
    word = rows["verdict"].iloc[0] if name == CLAIMS and "verdict" in rows else ""
    return f"{text} ({word})" if word in QUALIFIED else text


def text_of(rows: pd.DataFrame, request: str) -> str:
    """The text of the requested columns for the only row, or for all rows; LookupError if it is missing."""
    columns, words, style = parts_of(request)
    try:
        mean, *ends = (number_of(rows, column) for column in columns)
    except ValueError:  # no number
        return label(rows[columns[0]].iloc[0])
    has_ends = ends and all(end == end for end in ends)
    low, high = sorted(ends) if has_ends else (float("nan"),) * 2
    if mean != mean or (words and not has_ends):
        raise LookupError(f"no {'interval' if mean == mean else 'value'} in {request}")
    if words:
        return _difference(mean, low, high, words, style)
    return _shown(mean, style) if low != low else _spanned(mean, low, high, style)


def parts_of(request: str) -> tuple[list[str], list[str], str]:
    """(columns, the two words for a difference or none, format) of `mean low high NSS higher|NSS lower .2f`."""
    text, style = REQUEST.fullmatch(request.strip()).groups()  # pyright: ignore[reportOptionalMemberAccess]
    match = re.fullmatch(r"(\S+ \S+ \S+) ([^|]+)\|([^|]+)", text)
    columns, *words = match.groups() if match else (text,)
    return columns.split(), words, style or ""


def rows_of(path: Path, where: str = "") -> pd.DataFrame:
    """The rows of a CSV that agree with `where`, empty cells included; strings."""
    if not path.exists():
        raise LookupError(f"no {path.name}")
    frame = _cells(path, path.stat().st_mtime_ns)
    for column, sign, value in PAIR.findall(where):
        name = value if column in ENDS else column
        if name not in frame:
            raise LookupError(f"{path.name} has no column {name}")
        if column in ENDS:
            numbers = pd.to_numeric(frame[value]).dropna()
            frame = frame.loc[[ENDS[column](numbers)]] if len(numbers) else frame[:0]
        else:
            matches = [cell for cell in frame[column].unique() if fnmatchcase(cell, value)]
            frame = frame[frame[column].isin(matches) == (sign == "=")]
    return frame


@lru_cache(maxsize=32)  # prose asks for many cells of one table in turn
def _cells(path: Path, _changed: int) -> pd.DataFrame:
    """The cells of a CSV as strings; _changed: when the file changed."""
    return pd.read_csv(path, dtype=str, keep_default_na=False)


def number_of(rows: pd.DataFrame, term: str) -> float:
    """A number of the only row, or of all rows, such as `median:seconds`; ValueError where a cell holds a word."""
    prefix, statistic, column = COLUMN.fullmatch(term).groups()  # pyright: ignore[reportOptionalMemberAccess]
    if column not in rows:
        raise LookupError(f"no column {column}")
    if not statistic and len(rows) != 1:
        raise LookupError(f"{len(rows)} rows, where one is wanted")
    values = [float(cell) for cell in rows[column] if cell]
    value = OVER_ROWS[statistic](values) if statistic and values else next(iter(values), float("nan"))
    return PREFIXES[prefix](value)


def _difference(mean: float, low: float, high: float, words: Sequence[str], style: str) -> str:
    """`0.4 [0.2, 0.6] higher`; `neither higher nor lower beyond chance (0.1 [-0.2, 0.4])`."""
    if low > 0:
        return f"{_spanned(mean, low, high, style)} {words[0]}"
    if high < 0:
        return f"{_spanned(-mean, -high, -low, style)} {words[1]}"
    return f"neither {words[0]} nor {words[1]} beyond chance ({_spanned(mean, low, high, style)})"


def _spanned(mean: float, low: float, high: float, style: str) -> str:
    ends = (_shown(end, style.removeprefix("+")) for end in (low, high))
    return f"{_shown(mean, style)} [{', '.join(ends)}]"


def _shown(value: float, style: str) -> str:
    """A number in a format, with commas between thousands and no sign before a zero; else to three digits."""
    if not style:
        return f"{value:,.0f}" if abs(value) >= 1000 else number(value)
    text = format(value, style.replace(",", "").replace(".", ",."))
    return text if re.search("[1-9]", text) else text.lstrip("+-")
