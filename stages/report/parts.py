"""The parts of the report: what each stage shows, in reading order, and how a part is built."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from types import ModuleType

from matplotlib.figure import Figure as Drawing

from stages.charts.drawing import SETTINGS, plt
from stages.charts.html import item_html
from stages.charts.items import Figure, Table, add_words
from stages.charts.results import NoData, NotRun, Results

from . import (
    attention,
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

PARTS: dict[str, ModuleType] = {
    module.__name__.rpartition(".")[2]: module
    for module in (attention, fixation, meshes, scene, touch, exploration, sensor, sequences, transfer, hybrid,
                   recorded, stability, fidelity)
}  # fmt: skip
KINDS = {"tables": "TABLES", "figures": "FIGURES", "tradeoff": "CHARTS"}  # folder of reports/ -> dict of a part


@dataclass
class Built:
    """Items that were built, and {KIND/NAME: why} of those that lack their measurement.

    no_data: {KIND/NAME: stage} of the items that lack the stage's folder in data/; their files of an earlier run stay.
    """

    items: list[Table | Figure] = field(default_factory=list)
    not_run: dict[str, str] = field(default_factory=dict)
    no_data: dict[str, str] = field(default_factory=dict)

    def __add__(self, other: "Built") -> "Built":
        return Built(self.items + other.items, self.not_run | other.not_run, self.no_data | other.no_data)


def build_part(part: ModuleType, results: Results, kinds: Iterable[str] = KINDS) -> Built:
    """Builds and writes the tables, figures and charts of one part; what lacks its measurement is noted.

    On a folder of one's own, only where its stage ran there: the rest needs other data sets.
    """
    built = Built()
    for kind in kinds:
        for name in getattr(part, KINDS[kind]):
            try:
                item = build_item(part, kind, name, results)
            except NotRun as missing:
                if results.concerns(missing):
                    built.not_run[f"{kind}/{name}"] = str(missing)
                    if isinstance(missing, NoData):
                        built.no_data[f"{kind}/{name}"] = missing.stage
                continue
            item.html = item_html(item)
            if isinstance(item, Figure):
                item.drawing = Drawing()  # its pictures would fill the memory, and travel between processes
            built.items.append(item)
    return built


def build_item(part: ModuleType, kind: str, name: str, results: Results) -> Table | Figure:
    """One table, figure or chart, with its words, written to OUT/KIND; NotRun where it lacks its measurement."""
    results.read.clear()
    with plt.rc_context(SETTINGS):
        item = getattr(part, KINDS[kind])[name](results)
        add_words(item, part, kind, name)
        item.kind, item.page, item.sets = kind, page_of(part), results.in_order(results.read)
        item.write(results.out / kind)
    return item


def page_of(part: ModuleType) -> str:
    """The name of the page that a part is shown on."""
    return getattr(part, "PAGE", part.__name__.rpartition(".")[2])
