"""T3.1.5: the combinations of channels and the errors that each led to."""

import math
from contextlib import suppress

import pandas as pd

from stages.report.grid import means
from stages.report.items import Table
from stages.report.markdown import number
from stages.report.results import NotRun, Results
from stages.salient_points import METHODS

from .rows import ERRORS, paired_cells

ALIASES = {"VisAtt": "itti"}  # the classical model goes by its author's name elsewhere
NAMES = [
    "VisAtt", "VisAttCurvP", "VisAttCurv", "Curv", "VisAttSymP", "VisAttSym", "SymLat", "SymRad", "2Sym",
    "VisAttCurvSym", "VisAttCon", "VisAttCurvSymCon", "VisAttEnt", "VisAttAll",
]  # fmt: skip
COMBINATIONS = [ALIASES.get(name, name) for name in NAMES]  # as the stages call them
NOTES = [
    "The names are the thesis's (T3.1.5); a P at the end: the points of both parts together, not one map. Its errors "
    "appear in figures 3.4 and 3.5 only, so none stands beside ours.",
    "Errors: mean over the objects and face counts that all of these combinations reach that this run simplified with; "
    "lod.methods in params.yaml chooses them. Metro and the error where our model looks (the distance weighted by its "
    "saliency): % of the diagonal. Intervals: figure 3.4 and the table of all detectors.",
]


def combined_cells(results):
    """Rows of the errors of the combinations that were run, only where all of them reach the target."""
    return paired_cells(results, list(ERRORS), COMBINATIONS)


def build(results: Results) -> Table:
    errors = {}
    with suppress(NotRun):  # the list is worth having without the errors
        errors = {
            (row["method"], row["metric"]): row["mean"] for row in means(combined_cells(results), ["method", "metric"])
        }
    errors_shown = [metric for metric in ERRORS if metric != "gaze_error" or any(metric in key for key in errors)]
    lines = []
    for name in NAMES:
        found = {metric: errors.get((ALIASES.get(name, name), metric), math.nan) for metric in errors_shown}
        lines.append({"combination": name, "channels": ", ".join(METHODS[name].channels)} | found)
    frame = pd.DataFrame(lines)
    shown = frame.copy().astype(object)
    for metric in errors_shown:
        factor = ERRORS[metric][1]
        shown[metric] = [number(factor * value) if value == value else "not run" for value in frame[metric]]
    shown = shown.rename(columns={metric: name for metric, (name, _) in ERRORS.items()})
    return Table("Section 3.1.5: combinations of channels", frame, NOTES, shown)
