"""The parts of the report: what each stage shows, in reading order, and how a part is built."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from types import ModuleType

from matplotlib.figure import Figure as Drawing

from stages.charts.drawing import SETTINGS, plt
from stages.charts.html import item_html
from stages.charts.items import Figure, Table, add_words
from stages.charts.results import NoData, NotRun, Results
from stages.classification import report as classification
from stages.fixation import report as fixation
from stages.lod import report as lod
from stages.look_and_touch import report as look_and_touch
from stages.meshes import report as meshes
from stages.recorded import report as recorded
from stages.recorded_networks import report as recorded_networks
from stages.salient_points import report as salient_points
from stages.scene import report as scene
from stages.sensor_size import report as sensor_size
from stages.sequences import report as sequences
from stages.simulated_to_real import report as simulated_to_real
from stages.stability import report as stability
from stages.touch_stability import report as touch_stability
from stages.transfer import report as transfer
from stages.views import report as views
from stages.weights import report as weights

from . import fidelity_table
from .topics import page_of

PARTS: dict[str, ModuleType] = {
    "views": views,
    "weights": weights,
    "salient_points": salient_points,
    "fixation": fixation,
    "meshes": meshes,
    "lod": lod,
    "scene": scene,
    "classification": classification,
    "look_and_touch": look_and_touch,
    "sensor_size": sensor_size,
    "sequences": sequences,
    "transfer": transfer,
    "recorded": recorded,
    "recorded_networks": recorded_networks,
    "simulated_to_real": simulated_to_real,
    "stability": stability,
    "touch_stability": touch_stability,
    "report": fidelity_table,
}
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
                if not results.concerns(missing):
                    continue
                built.not_run[f"{kind}/{name}"] = str(missing)
                if not isinstance(missing, NoData):
                    continue
                built.no_data[f"{kind}/{name}"] = missing.stage
                if (item := earlier(part, kind, name, results)) is None:
                    continue
            item.html = item_html(item)
            if isinstance(item, Figure):
                item.drawing = Drawing()  # its pictures would fill the memory, and travel between processes
            built.items.append(item)
    return built


def earlier(part: ModuleType, kind: str, name: str, results: Results) -> Figure | None:
    """A figure as an earlier run drew it, where its words need no data; None where there is none."""
    path = results.out / kind / f"{name}.png"
    if kind != "figures" or results.own_meshes or not path.exists():
        return None
    item = Figure(Drawing(), kind=kind, page=page_of(part.PAGE, f"{kind}/{name}"), paths=[path])
    try:
        add_words(item, part, kind, name)
    except KeyError:
        return None
    return item


def build_item(part: ModuleType, kind: str, name: str, results: Results) -> Table | Figure:
    """One table, figure or chart, with its words, written to OUT/KIND; NotRun where it lacks its measurement."""
    results.read.clear()
    with plt.rc_context(SETTINGS):
        item = getattr(part, KINDS[kind])[name](results)
        add_words(item, part, kind, name)
        item.kind, item.page, item.sets = kind, page_of(part.PAGE, f"{kind}/{name}"), results.in_order(results.read)
        item.write(results.out / kind)
    return item
