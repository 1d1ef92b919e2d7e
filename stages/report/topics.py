"""The topics of the report, in reading order, and what each has to say."""

from types import ModuleType

from . import (
    attention,
    exploration,
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
from .items import Built
from .results import NotRun, Results
from .style import plot_style

TOPICS: tuple[ModuleType, ...] = (
    attention, fixation, meshes, scene, touch, exploration, sensor, sequences, transfer, hybrid, recorded, stability,
)  # fmt: skip
KINDS = {"tables": "TABLES", "figures": "FIGURES", "tradeoff": "CHARTS"}  # folder of reports/ -> dict of a topic
CLAIMS = [claim for topic in TOPICS for claim in topic.CLAIMS]


def build_all(kind: str, results: Results) -> Built:
    """Builds all of one kind (a key of KINDS), topic by topic; what lacks its measurement is noted as not run."""
    built = Built()
    for topic in TOPICS:
        for name, build in getattr(topic, KINDS[kind]).items():
            try:
                with plot_style():
                    item = build(results)
            except NotRun as missing:
                built.not_run[name] = str(missing)
                continue
            item.name = name
            built.items.append(item)
    return built
