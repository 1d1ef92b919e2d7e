"""Numbers in the text that are read from the tables in reports/ when the pages are built, never typed.

    {measured}`claims key=glance_over_best_gaze: effect low high | +.2f`      +0.96 [0.75, 1.19]
    {measured}`tables/scenes scene=shelf, method=uniform: faces | ,.0f`       2,803

The file below reports/ without .csv, the row that the pairs name, its columns (one, or three with an interval), and
the format. `100*faces` multiplies, `minutes:value` divides by 60, `less:effect` turns a difference in % of the mean
of both sides into % less of the second one, `times:effect` into how many times it, and `median:seconds` is over all
rows that the pairs name.
"""

import csv
import re
import statistics
from functools import cache
from pathlib import Path

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxRole

REPORTS = Path(__file__).resolve().parents[2] / "reports"
ASKED = re.compile(r"(?P<file>\S+)(?: (?P<where>.*?))?: (?P<columns>[^|]+?)(?: \| (?P<format>\S+))?$", re.S)
OPERATIONS = {
    "": lambda number: number,
    "-": lambda number: -number,
    "100*": lambda number: 100 * number,
    "1000*": lambda number: 1000 * number,
    "minutes:": lambda number: number / 60,
    "times:": lambda number: (200 - number) / (200 + number),
    "less:": lambda number: 200 * number / (200 + number),
}
OVER_ROWS = {"median:": statistics.median, "least:": min, "most:": max, "sum:": sum, "count:": len}
COLUMN = re.compile(rf"(-|100\*|1000\*|minutes:|times:|less:)?({'|'.join(OVER_ROWS)})?(.+)")


def setup(app: Sphinx) -> dict[str, bool]:
    """Adds the role."""
    app.add_role("measured", Measured())
    return {"parallel_read_safe": True, "parallel_write_safe": True}


class Measured(SphinxRole):
    """The number, with the cell that it is from as what a pointer over it shows."""

    def run(self) -> tuple[list[nodes.Node], list]:
        """The number, or a problem that ends the build."""
        asked = " ".join(self.text.split())
        try:
            shown = measured(asked)
        except (ValueError, KeyError, OSError) as error:
            message = self.inliner.reporter.error(f"{asked}: {error}", line=self.lineno)
            return [self.inliner.problematic(self.rawtext, self.rawtext, message)], [message]
        return [nodes.abbreviation(self.rawtext, shown, explanation=f"reports/{asked}", classes=["measured"])], []


def measured(asked: str) -> str:
    """The text of what a role asks for; ValueError where it is not one row, or has no number."""
    match = ASKED.match(asked)
    if match is None:
        raise ValueError("write FILE KEY=VALUE, KEY=VALUE: COLUMN [LOW HIGH] | FORMAT")
    rows = rows_of(match["file"], match["where"] or "")
    return interval_text([number(rows, column) for column in match["columns"].split()], match["format"] or "g")


def interval_text(numbers: list[float], style: str) -> str:
    """`5.8`, or `5.8 [2.9, 8.5]` of three numbers, whose last two are the ends in any order."""
    if len(numbers) not in (1, 3):
        raise ValueError(f"{len(numbers)} numbers: give one, or one with the ends of its interval")
    middle, *ends = (plain(format(value, style)) for value in (numbers[0], *sorted(numbers[1:])))
    return f"{middle} [{', '.join(end.lstrip('+') for end in ends)}]" if ends else middle


def number(rows: list[dict[str, str]], column: str) -> float:
    """What a column of the only row, or a function of a column of all rows, amounts to."""
    match = COLUMN.fullmatch(column)
    if match is None:
        raise ValueError(f"{column} is no column of numbers")
    operation, over, name = match.groups()
    if over is None and len(rows) != 1:
        raise ValueError(f"{len(rows)} rows, where one is wanted")
    values = [float(row[name]) for row in rows if row[name]]
    if not values:
        raise ValueError(f"no number in {name}")
    return OPERATIONS[operation or ""](OVER_ROWS[over](values) if over else values[0])


def rows_of(file: str, where: str = "") -> list[dict[str, str]]:
    """The rows of a file below reports/ that agree with `column=value, column=value`; a value may be empty."""
    pairs = [pair.split("=", 1) for pair in re.split(r", (?=\w+=)", where) if pair]
    return [row for row in table(file) if all(row[column] == value for column, value in pairs)]


@cache
def table(file: str) -> list[dict[str, str]]:
    """All rows of a CSV below reports/."""
    with (REPORTS / f"{file}.csv").open(encoding="utf-8", newline="") as lines:
        return list(csv.DictReader(lines))


def plain(text: str) -> str:
    """A number without the sign of a zero."""
    return text.lstrip("-+") if not re.search("[1-9]", text) else text
