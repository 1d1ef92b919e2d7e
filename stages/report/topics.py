"""The topics of the report, in reading order, and their contents."""

from collections.abc import Iterable
from pathlib import Path
from types import ModuleType

from matplotlib.figure import Figure as Drawing

from . import (
    attention,
    chain,
    exploration,
    fidelity,
    fixation,
    hybrid,
    meshes,
    recorded,
    scene,
    sensor,
    sequences,
    stability,
    touch,
    transfer,
)
from .drawing import SETTINGS, plt
from .items import Built, Figure, Table, add_words
from .page import item_html
from .records import record_of
from .results import NoData, NotRun, Results

TOPICS: tuple[ModuleType, ...] = (
    attention, fixation, meshes, scene, touch, exploration, sensor, sequences, transfer, hybrid, recorded, stability,
    chain, fidelity,
)  # fmt: skip
KINDS = {"tables": "TABLES", "figures": "FIGURES", "tradeoff": "CHARTS"}  # folder of reports/ -> dict of a topic


def name_of(topic: ModuleType) -> str:
    """`touch`, say."""
    return topic.__name__.rpartition(".")[2]


def files_of(topic: ModuleType, kind: str) -> list[Path]:
    """The code of a topic and, for a kind that has words in it, its prose; findings are read for each page anew."""
    folder = Path(topic.__file__ or "").parent
    return [*folder.glob("*.py"), *([folder / "prose.md"] if kind in KINDS else [])]


def build_all(kind: str, results: Results, topics: Iterable[ModuleType] = TOPICS) -> Built:
    """Builds and writes all of one kind (a key of KINDS), topic by topic; what lacks its measurement is noted.

    On a folder of one's own, only where its stage ran there: the rest needs other data sets.
    """
    built = Built()
    for topic in topics:
        for name in getattr(topic, KINDS[kind]):
            try:
                item = build_one(topic, kind, name, results)
            except NotRun as missing:
                if results.concerns(missing):
                    built.not_run[name] = str(missing)
                    if isinstance(missing, NoData):
                        built.no_data[name] = missing.stage
                continue
            item.html = item_html(item)
            if isinstance(item, Figure):
                item.drawing = Drawing()  # its pictures would fill the memory, and travel between processes
            built.items.append(item)
    return built


def build_one(topic: ModuleType, kind: str, name: str, results: Results) -> Table | Figure:
    """One table, figure or chart, with its words, written to OUT/KIND; NotRun where it lacks its measurement."""
    results.forget()
    with plt.rc_context(SETTINGS):
        item = getattr(topic, KINDS[kind])[name](results)
        add_words(item, topic, kind, name)
        item.topic, item.sets = name_of(topic), results.in_order(results.read)
        item.record = record_of(item, results, kind)
        item.write(results.out / kind)
    return item
