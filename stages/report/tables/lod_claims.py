"""The claims on simplified meshes, judged on every data set beside each other."""

import pandas as pd

from stages.report.claims import MESHES
from stages.report.intervals import interval
from stages.report.items import Table
from stages.report.judged import signed
from stages.report.lod_cells import data_sets
from stages.report.results import NotRun
from stages.report.verdict import verdict

WORDS = {"supported": "yes", "contradicted": "no", "open": "open"}
NOTES = [
    "Each cell: the word (yes: the 95 % interval over the objects lies wholly on the claimed side; no: on the other; "
    "open: it covers zero), the mean, the interval and the number of objects. What is compared: claims.md.",
    "Nothing shrunk: only face counts at which none of the compared methods had to shrink its neighbourhoods; that is "
    "the thesis's own algorithm.",
    "The meshes of psb have up to 55,644 faces, those with gaze about 40,000, as the thesis's benchmark has: there "
    "3,000 and 1,500 faces are deeper cuts than on this run's.",
]


def build(results):
    names = _sources(results)
    lines = [_line(claim, results, data, source) for claim in MESHES for data, source in names.items()]
    frame = pd.DataFrame(lines)
    shown = frame.pivot(index="key", columns="data", values="cell").reindex([claim.key for claim in MESHES])
    shown = shown[list(names)].reset_index(drop=True)
    shown.insert(0, "claim", [claim.sentence for claim in MESHES])
    shown.insert(0, "section", [claim.section for claim in MESHES])
    shown["unit"] = [claim.unit for claim in MESHES]
    return Table("Claims on simplified meshes, by data set", frame.drop(columns="cell"), NOTES, shown)


def _sources(results):
    """The data sets, and the first of them once more where nothing shrank: dict name -> Source."""
    names = data_sets(results)
    first = next(iter(names))
    return names | {f"{first}, nothing shrunk": names[first]._replace(whole=True)}


def _line(claim, results, data, source):
    line = {"key": claim.key, "data": data}
    try:
        differences = claim.differences(results, source)
    except NotRun:
        return line | {"verdict": "open", "objects": 0, "cell": "not run"}
    mean, low, high = interval(differences, claim.shared)
    line |= {"verdict": verdict(low, high), "effect": mean, "low": low, "high": high, "objects": len(differences)}
    return line | {"cell": f"{WORDS[line['verdict']]}: {_said(mean, low, high)} ({len(differences)})"}


def _said(mean, low, high):
    """A signed effect to three digits, with its interval."""
    places = max(0, 2 - int(f"{mean:e}".split("e")[1])) if mean and mean == mean else 2
    return signed(mean, low, high, min(places, 7))
