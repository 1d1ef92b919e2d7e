"""Tables that are made of reports/ when the pages are built.

```{claims} key_one, key_two          claims with their verdict, effect and interval
```

```{thesis}                           the conclusions of the thesis, printed beside measured
```

```{rows} tables/scene                rows of a table
:where: matched=error
:columns: method; faces .0f; 100*held .0f
:titles: way; faces per frame; frames within the tolerance, %
```

```{artifact}                         every claim, by the command that tests it again, with its minutes
```
"""

import re
from collections.abc import Iterable
from types import SimpleNamespace

import pandas as pd
from docutils import nodes
from docutils.parsers.rst import directives
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from stages.charts.cells import parts_of, rows_of, text_of
from stages.charts.drawing import label
from stages.report.claims_page import effect
from stages.report.verdict import WORDS

from .commands import Command, commands
from .measured import REPORTS

KINDS = {"claims": "claim", "thesis": "conclusion"}  # kind of a table -> the column that marks it
SIGNED_ZERO = re.compile(r"-(0(?:\.0+)?)(?![\d.])")


def setup(app: Sphinx) -> dict[str, bool]:
    """Adds the directives."""
    for name, directive in {
        "claims": Claims,
        "thesis": Thesis,
        "rows": Rows,
        "artifact": Artifact,
    }.items():
        app.add_directive(name, directive)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


class Claims(SphinxDirective):
    """Claims by their keys, in this order."""

    required_arguments, final_argument_whitespace = 1, True

    def run(self) -> list[nodes.Node]:
        """A table."""
        lines = []
        for key in self.arguments[0].replace(",", " ").split():
            (row,) = rows_of(REPORTS / "claims.csv", f"key={key}").to_dict("records")
            cells = (verdict(row["verdict"]), measured(row), row["printed"], row["size"])
            lines.append((row["section"], row["claim"], *cells))
        head = ("section", "claim", "verdict", "effect [95 %]", "printed", "size")
        return [made_table(head, lines, (8, 34, 13, 20, 15, 10))]


class Thesis(SphinxDirective):
    """What became of the thesis."""

    def run(self) -> list[nodes.Node]:
        """A table, as on the front page of the site."""
        lines = []
        for row in rows_of(REPORTS / "thesis.csv").to_dict("records"):
            conclusion = f"{row['conclusion']} ({row['section']})"
            cells = (row["printed"], row["measured"], verdict(row["verdict"]), row["size"], row["why"])
            lines.append((conclusion, *cells))
        head = ("conclusion", "printed", "measured", "verdict", "size", "why")
        return [made_table(head, lines, (26, 11, 19, 11, 8, 25))]


class Rows(SphinxDirective):
    """Columns of the rows of a table that agree with `where`."""

    required_arguments = 1
    option_spec = dict.fromkeys(("where", "columns", "titles", "names"), directives.unchanged)

    def run(self) -> list[nodes.Node]:
        """A table; `names` replaces values of the first column: `ours=our levels; uniform=uniform levels`."""
        file, where = self.arguments[0], self.options.get("where", "")
        names = dict(pair.strip().split("=") for pair in self.options.get("names", "").split(";") if pair)
        columns = [column.strip() for column in self.options["columns"].split(";")]
        lines = []
        rows = rows_of(REPORTS / f"{file}.csv", where)
        for place, name in enumerate(rows[columns[0]]):
            if not names or name in names:
                row = rows.iloc[place : place + 1]
                lines.append([names.get(name, label(name)), *(shown(row, text) for text in columns[1:])])
        if not lines:
            raise self.error(f"{file} has no row with {where or 'these names'}")
        return [made_table([text.strip() for text in self.options["titles"].split(";")], lines)]


class Artifact(SphinxDirective):
    """For each command the claims that it tests, and how long it computed."""

    def run(self) -> list[nodes.Node]:
        """A table of the commands, then a section for each."""
        listed = commands()
        lines = [(code(command.text), str(len(command.claims)), tally(command), minutes(command)) for command in listed]
        head = ("command", "claims", "verdicts", "minutes")
        return [made_table(head, lines, (46, 8, 36, 10)), *(self.section(command) for command in listed)]

    def section(self, command: Command) -> nodes.section:
        """The claims of one command."""
        lines = [
            (claim["section"], claim["claim"], verdict(claim["verdict"]), code(claim["key"]))
            for claim in command.claims
        ]
        title = nodes.title(command.name, command.name)
        meaning = [nodes.paragraph("", command.meaning)] if command.meaning else []
        body = made_table(("section", "claim", "verdict", "key"), lines, (10, 50, 16, 24))
        return nodes.section("", title, *meaning, body, ids=[nodes.make_id(f"claims of {command.name}")])


def measured(row: dict[str, str]) -> str:
    """The effect of a claim with its interval and unit."""
    numbers = {name: float(row[name] or "nan") for name in ("effect", "low", "high")}
    return effect(SimpleNamespace(unit=row["unit"], **numbers))


def shown(row: pd.DataFrame, column: str) -> str:
    """One cell: as it is, or a number with its interval where the column has a format; a dash without a number."""
    if not parts_of(column)[2]:
        return row[column].iloc[0]
    try:
        text = SIGNED_ZERO.sub(r"\1", text_of(row, column))
        return text.replace(", ", ",\u00a0")  # a line ends before an interval, not in it
    except LookupError:
        return "–"


def verdict(word: str) -> nodes.Node:
    """The word in its colour."""
    return nodes.inline(word, word, classes=[f"verdict-{word.replace(' ', '-')}"])


def code(text: str) -> nodes.Node:
    """A text as code."""
    return nodes.literal(text, text)


def tally(command: Command) -> str:
    """The number of claims with each verdict, without zeros."""
    numbers = {word: sum(claim["verdict"] == word for claim in command.claims) for word in WORDS}
    return ", ".join(f"{number} {word}" for word, number in numbers.items() if number)


def minutes(command: Command) -> str:
    """The minutes of a command; a plus stands for the stages whose rows have no seconds."""
    return f"{max(command.minutes, 1):.0f}{'' if command.is_timed else '+'}"


def made_table(head: Iterable[str], lines: Iterable[Iterable[str | nodes.Node]], widths=None) -> nodes.table:
    """A table of texts or nodes."""
    head = list(head)
    group = nodes.tgroup("", *(nodes.colspec("", colwidth=w) for w in widths or [1] * len(head)), cols=len(head))
    group += [nodes.thead("", made_row(head)), nodes.tbody("", *(made_row(line) for line in lines))]
    kinds = ["measured-table", *(f"{kind}-table" for kind, column in KINDS.items() if column in head)]
    return nodes.table("", group, classes=kinds)


def made_row(cells: Iterable[str | nodes.Node]) -> nodes.row:
    """A row of texts or nodes."""
    inner = ((nodes.Text(cell) if isinstance(cell, str) else cell) for cell in cells)
    return nodes.row("", *(nodes.entry("", nodes.paragraph("", "", node)) for node in inner))
