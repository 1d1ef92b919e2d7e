"""What became of the thesis: a row a conclusion, printed beside measured, for the front page, the file and the docs."""

import re
from collections.abc import Callable
from html import escape
from importlib import resources
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pandas as pd
import yaml

from stages.charts.cells import filled, rows_of
from stages.charts.html import prose
from stages.charts.tables import markdown_table

from .claims_page import CLASSES, effect

TITLE = "What became of the thesis"
COLUMNS = ("conclusion", "printed", "measured", "verdict", "why", "see")
LEAD = """The thesis of G. Rouhafzay (University of Ottawa, 2021) draws {total} main conclusions. Measured again on
other objects, {supported} are supported and {contradicted} contradicted; the others stay open."""

NOTE = """Brackets are 95 % intervals; *open* means that the interval covers zero. NSS: how far a map is above chance
where people look. PCC: correlation. SSIM: similarity of two pictures."""


def thesis_frame(reports: Path) -> pd.DataFrame:
    """COLUMNS, section, key and size of each conclusion that was measured; reports: with claims.csv and the tables."""
    rows = []
    for entry in yaml.safe_load((resources.files(__package__ or "") / "page/thesis.yaml").read_text("utf-8")):
        try:
            (claim,) = rows_of(reports / "claims.csv", f"key={entry['claim']}").to_dict("records")
            texts = {name: filled(entry[name], reports)[0] for name in ("measured", "why") if name in entry}
        except (LookupError, ValueError):
            continue
        numbers = {name: float(claim[name] or "nan") for name in ("effect", "low", "high")}
        rows.append({
            "conclusion": entry["conclusion"], "key": entry["claim"],
            "section": re.sub(r"(?<![\d.])(\d)", r"T\1", str(entry["section"])),
            "printed": entry.get("printed") or f"+{claim['printed'].partition(',')[0]}".replace("+-", "-"),
            "measured": texts.get("measured") or effect(SimpleNamespace(**numbers, unit=claim["unit"])),
            "verdict": claim["verdict"], "size": claim["size"],
            "why": texts["why"], "see": entry["see"],
        })  # fmt: skip
    return pd.DataFrame(rows, columns=[*COLUMNS, "section", "key", "size"])


def lead(frame: pd.DataFrame) -> str:
    """The sentence above the table."""
    words = frame["verdict"].value_counts()
    counts = {word: words.get(word, 0) for word in ("supported", "contradicted")}
    return " ".join(LEAD.format(total=len(frame), **counts).split())


def thesis_text(frame: pd.DataFrame) -> str:
    """The file thesis.md; links are relative to reports/."""
    shown = frame[list(COLUMNS)].copy()
    shown["conclusion"] += " (" + frame["section"] + ")"
    shown["verdict"] = [_word(row) for row in frame.itertuples()]
    shown["see"] = [f"[{_name(see)}]({see}.md)" for see in frame["see"]]
    note = f"{NOTE} The verdicts follow from [claims.csv](claims.csv); [claims](claims.md) has all."
    return "\n\n".join((f"# {TITLE}", lead(frame), markdown_table(shown), note))


def thesis_html(frame: pd.DataFrame, address: Callable[[str], str]) -> str:
    """The table for a page. address: from KIND/NAME to where it is shown, if it is."""
    head = "".join(f'<th scope="col">{name}</th>' for name in COLUMNS)
    rows = "".join(_row_html(row, address) for row in frame.itertuples())
    table = f'<table class="fate"><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>'
    note = f'<p class="help">{escape(NOTE.replace("*", ""))}</p>'
    return f'<section id="thesis"><p class="summary">{escape(lead(frame))}</p>{table}{note}</section>\n'


def _word(row: Any) -> str:
    """`supported, smaller than printed`."""
    words = {"smaller": "smaller than printed", "larger": "larger than printed", "opposite": "opposite sign"}
    return f"{row.verdict}, {words.get(row.size, row.size)}" if row.size else row.verdict


def _name(see: str) -> str:
    """`table 3.2` of tables/table_3_2."""
    return re.sub(r"(?<=\d)_(?=\d)", ".", Path(see).name).replace("_", " ")


def _row_html(row: Any, address: Callable[[str], str]) -> str:
    claim = f'<a href="site/claims.html#{row.key}" title="the claim">{escape(_word(row))}</a>'
    cells = {
        "conclusion": f"{escape(row.conclusion)} <small>{escape(row.section)}</small>",
        "printed": escape(row.printed), "measured": escape(row.measured),
        "verdict": f'<span class="word {CLASSES[row.verdict]}">{claim}</span>', "why": prose(row.why),
        "see": f'<a href="{link}">{escape(_name(row.see))}</a>' if (link := address(row.see)) else "",
    }  # fmt: skip
    body = "".join(f'<td data-label="{name}">{cells[name]}</td>' for name in COLUMNS[1:])
    return f'<tr><th scope="row">{cells["conclusion"]}</th>{body}</tr>'
