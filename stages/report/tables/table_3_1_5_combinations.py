"""T3.1.5: the combinations of channels and the errors that each led to."""

from contextlib import suppress

import pandas as pd

from stages.report.intervals import summary
from stages.report.items import Table
from stages.report.lod_cells import paired_cells
from stages.report.results import NotRun
from stages.salient_points import COMBINATIONS

ALIASES = {"VisAtt": "itti"}  # the classical model goes by its author's name elsewhere
NOTES = [
    "The names are the thesis's (T3.1.5). Its errors appear in figures 3.4 and 3.5 only, so none stands beside ours.",
    "Errors: mean over the objects and face counts that every method reaches, for the combinations that this run "
    "simplified with; lod.methods in params.yaml chooses them.",
]


def build(results):
    errors = {}
    with suppress(NotRun):  # the list is worth having without the errors
        rows = paired_cells(results, ["metro_mean", "ssim_error"])
        errors = {(row["method"], row["metric"]): row["mean"] for row in summary(rows, ["method", "metric"])}
    lines = []
    for name, channels in COMBINATIONS.items():
        found = {metric: errors.get((ALIASES.get(name, name), metric)) for metric in ("metro_mean", "ssim_error")}
        lines.append({"combination": name, "channels": ", ".join(channels)} | found)
    frame = pd.DataFrame(lines)
    shown = frame.astype(object).fillna("not run")
    shown = shown.rename(columns={"metro_mean": "Metro mean", "ssim_error": "SSIM error"})
    return Table("Section 3.1.5: combinations of channels", frame, NOTES, shown)
