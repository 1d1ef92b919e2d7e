"""The front page: what the project is, five findings with their intervals, and what people ask."""

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.figure import Figure as Drawing

from .cells import CLAIMS, PREFIXES, filled
from .drawing import CYCLE, INK, SETTINGS, plt
from .marks import vector
from .page import box, part, prose
from .tables import with_interval
from .verdict import DEPENDS, UNTESTABLE, counts, sentences

ROWS = 5  # heights of the dots of a chart: pairs of like values lie beside each other


@dataclass(frozen=True)
class Finding:
    """A claim that the front page shows with its chart.

    verdict: with which the title is right; under any other the claim's own sentence stands. shown: a key of PREFIXES,
    what is shown of its differences. unit: of what is shown, with its direction.
    """

    key: str
    verdict: str
    title: str
    unit: str
    topic: str
    shown: str = ""
    places: int = 0

    def of(self, value: float) -> float:
        """The text of a difference."""
        return PREFIXES[self.shown](value)


FINDINGS = (
    Finding("glance_over_best_gaze", "supported", "Our glance predicts where people look better than any rival",
            "NSS more than the best other", "attention", places=2),
    Finding("glance_soft_gaze", "supported", "Saliency as a weight keeps meshes closer where people looked",
            "% less error where people looked", "meshes", "less:", 1),
    Finding("touch_over_best_touch_apart", "supported", "One touch where imprints recur tells more on new regions",
            "points of accuracy more than at the best rival's places", "touch"),
    Finding("keep_metro", "contradicted", "Fails: neighbourhoods kept unchanged raise the error",
            "times the error of plain simplification", "meshes", "times:", 2),
    Finding("simulation_helps_5", "contradicted", "Fails: simulated imprints make real touches harder to recognise",
            "points of accuracy more than without them", "recorded"),
)  # fmt: skip
UNCLEAR = """<li><h3>Most sentences of the thesis are not that clear</h3><p>Of {count} sentences of the thesis,
<strong>{supported}</strong> are supported and <strong>{contradicted}</strong> contradicted. {untestable} cannot be
tested or depend on how the protocol is read; the others are open,
mixed or show no difference. Each opens to its pairs, data and command.</p>
<p><a href="site/claims.html">All claims</a></p></li>"""
ANSWER = '<li><h3>{asked}</h3><p>{answer} <a href="{address}">{kind}</a></p></li>'


def findings_html(claims: pd.DataFrame, differences: pd.DataFrame) -> str:
    """The cards of those FINDINGS that were measured."""
    rows = {str(row.key): row for row in claims.dropna(subset=["low"]).itertuples()}
    cards = [_card(one, rows[one.key], differences) for one in FINDINGS if one.key in rows]
    if not cards:
        return ""
    thesis = sentences(claims[claims["section"] != "ours"])
    found = counts(thesis)
    rest = UNCLEAR.format(count=len(thesis), untestable=found[UNTESTABLE] + found[DEPENDS], **found)
    return f'<section id="findings"><h2>Five findings</h2><ul class="cards">{"".join(cards)}{rest}</ul></section>\n'


def _card(one: Finding, row, differences: pd.DataFrame) -> str:
    title = one.title if row.verdict == one.verdict else f"{row.claim} ({row.verdict})"
    mean, *ends = (one.of(value) for value in (row.effect, row.low, row.high))
    low, high = sorted(ends)
    figure = with_interval(mean, low, high, places=one.places)
    signed = "+" if mean > 0 and one.shown == "" else ""
    found = differences[(differences["key"] == one.key) & differences["judged"]]
    alt = f"{title}: {figure} {one.unit}; a dot for each of {len(found)} {row.over}"
    values = dict(zip(found["pair"].astype(str), map(one.of, found["difference"]), strict=True))
    drawing = strip(values, (mean, low, high), one.of(0.0), one.unit)
    chart = box("wide", f"{title}, chart", vector(drawing, one.key, alt)[0])
    links = f'<a href="site/claims.html#{one.key}">The claim</a> '
    links += f'<a href="site/{one.topic}.html">{one.topic.capitalize()}</a>'
    return (
        f'<li><h3>{escape(title)}</h3><p class="figure"><strong>{signed}{figure}</strong> {escape(one.unit)}</p>{chart}'
        f'<p class="help">{row.pairs} {escape(row.over)}, 95 % interval. {links}</p></li>'
    )


def strip(values: Mapping[str, float], interval: tuple[float, float, float], zero: float, unit: str) -> Drawing:
    """A chart of paired differences, a dot each, above their mean with its interval; zero: where there is no effect."""
    mean, low, high = interval
    with plt.rc_context(SETTINGS):
        drawing, axes = plt.subplots(figsize=(4.2, 1.15))
        axes.axvline(zero, color=INK, lw=1)
        for rank, (name, value) in enumerate(sorted(values.items(), key=lambda item: item[1])):
            axes.plot(value, 1 + rank % ROWS, "o", color=CYCLE[5], ms=5, mec="white", mew=0.5, label=f"_{name}")
        axes.plot([low, high], [-0.6, -0.6], color=CYCLE[0], lw=4, solid_capstyle="butt")
        axes.plot(mean, -0.6, "D", color=CYCLE[0], ms=7, mec="white", label="_mean")
        axes.set(xlabel=unit, ylim=(-1.8, ROWS + 1), xlim=_room([zero, low, high, *values.values()]))
        axes.yaxis.set_visible(False)
        axes.spines["left"].set_visible(False)
        plt.close(drawing)
    return drawing


def _room(values: Sequence[float]) -> tuple[float, float]:
    """Limits of an axis that holds all of the values."""
    low, high = np.min(values), np.max(values)
    return low - 0.06 * (high - low or 1), high + 0.06 * (high - low or 1)


def questions(reports: Path, link: Callable[[str, str], str]) -> list[tuple[str, str, str]]:
    """[(question, HTML of its answer, address)] of those whose figures were measured.

    link: from the first source of an answer, (KIND/NAME or claims, which row), to the address of its table.
    """
    found = []
    for asked, answer in re.findall(r"^# (.+)\n\n((?:.+\n?)+)", part("questions.md"), flags=re.MULTILINE):
        try:
            text, sources = filled(" ".join(answer.split()), reports)
        except LookupError:
            continue
        found.append((asked, prose(text), link(*sources[0])))
    return found


def questions_html(found: Sequence[tuple[str, str, str]]) -> str:
    """The section of questions, each answered in a sentence with a link to its table."""
    kinds = ("Claim" if CLAIMS in address else "Table" for _, _, address in found)
    items = (
        ANSWER.format(asked=escape(asked), answer=answer, address=address, kind=kind)
        for (asked, answer, address), kind in zip(found, kinds, strict=True)
    )
    section = f'<section id="questions"><h2>What people ask</h2><ul class="cards two">{"".join(items)}</ul></section>\n'
    return section if found else ""
