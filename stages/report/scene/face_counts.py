"""T3.1.3: how many faces an object needs, told by networks, by less and by more."""

import pandas as pd

from stages.report.items import Table
from stages.report.markdown import number, with_interval
from stages.report.results import Results

MODELS = {
    "network": "the thesis's networks",
    "linear": "linear in logarithms",
    "one_mesh": "one measured mesh, common power law",
    "lookup": "lookup of the object's own curve",
}
CONDITIONS = {
    "left_out": "objects left out",
    "equal_rate": "the same, times a safety factor",
    "built": "a sample, as meshes",
    "built_equal_rate": "the sample with the factor, as meshes",
    "coarser": "coarser than anything known",
    "finer": "finer than anything known",
    "larger": "objects larger than any known",
    "flat": "objects of flat sides",
}
METRICS = {
    "factor_median": ("off by (half)", 1, 2),
    "factor_90": ("off by (90 %)", 1, 2),
    "count_bias": ("count / needed", 1, 2),
    "within": ("within the tolerance, %", 100, 0),
    "excess": ("excess error, %", 100, 0),
    "waste": ("wasted faces, %", 100, 0),
}
NOTES = [
    "Each case asks for a measured error of a mesh that the model has not seen, at a distance drawn at random; the "
    "right count is that mesh's. The tolerance is in pixels on a screen, so that the distance says what "
    "error on the surface it allows; the thesis marked its distances by eye in VRML. Errors are Metro's mean.",
    "Off by: the factor, either way, that half and 90 % of the counts stay within. Count / needed: geometric mean. "
    "Excess error: of the cases that break the tolerance, the median above it. Wasted: faces beyond those "
    "needed, over them, mean. Brackets: 95 % interval, bootstrap over the objects.",
    "Safety factor: found on training objects alone, so that 90 % of their cases keep to the tolerance. Compare the "
    "waste there: without it a model that asks for too few faces wastes none.",
    "Networks and linear model know the tolerance, the distance, the object's faces and its number of points: one a "
    "combination of channels, averaged (T3.1.3). The lookup knows the object's curve without the point asked for; the "
    "power law the point nearest to half of the object's faces. Errors there are read from the measured curve; the "
    "rows `as meshes` build the mesh and measure it.",
    "Coarser, finer: asked for less (more) than half of the object's faces, where all that is known, of any object, "
    "lies on the other side. Flat sides: every measured mesh is exact, so the coarsest stands for the right count.",
]


def build(results: Results) -> Table:
    rows = results.measured("scene", condition=[*CONDITIONS, "cost"], method=list(MODELS))
    scores = rows[rows["condition"] != "cost"]
    return Table("Section 3.1.3: how many faces an object needs", rows, [*_said(rows), *NOTES], _shown(scores))


def cell(rows, condition, method, metric):
    """The row of a condition, method and metric; None where it was not measured."""
    found = rows[(rows["condition"] == condition) & (rows["method"] == method) & (rows["metric"] == metric)]
    return None if found.empty else found.iloc[0]


def _shown(rows):
    lines = []
    for condition, words in CONDITIONS.items():
        for method, name in MODELS.items():
            here = rows[(rows["condition"] == condition) & (rows["method"] == method)]
            if len(here):
                facts = {"cases": int(here["cases"].max()), "objects": int(here["objects"].max())}
                lines.append({"asked about": words, "model": name} | _line(rows, condition, method) | facts)
    return pd.DataFrame(lines)


def _line(rows, condition, method):
    line = {}
    for metric, (name, scale, places) in METRICS.items():
        row = cell(rows, condition, method, metric)
        line[name] = "–" if row is None else with_interval(row["value"], row["low"], row["high"], scale, places)
    return line


def _said(rows):
    """What each model costs, beside the lookup."""
    costs = []
    for method, name in MODELS.items():
        fit, ask = (cell(rows, "cost", method, metric) for metric in ("fit", "ask"))
        if fit is not None and ask is not None:
            costs.append(f"{name} {number(fit['value'])} and {number(ask['value'])}")
    if not costs:
        return []
    return [
        f"Cost before the first question and of one question, as a ratio to the lookup: {'; '.join(costs)}. The lookup "
        "and the power law pay for each object (building and measuring meshes); networks and linear model are trained "
        "once, on curves that had to be measured as well."
    ]
