"""Both senses at once, whole, damaged or missing: which way to join them recognises most."""

import pandas as pd

from stages.report.grid import grid, grouped
from stages.report.items import Table
from stages.report.networks import accuracy, measured, seen
from stages.report.results import Results

from .section_5_5 import MIDDLE

METHODS = {
    "better_sense": "the better sense alone",
    "vision": "sight alone",
    "touch": "touch alone",
    "sum_mean": "the streams summed, both heads",
    "sum_vision": "the streams summed, sight's head",
    "sum_touch": "the streams summed, touch's head",
    "fusion_mean": "both heads, mean",
    "fusion_product": "both heads, product",
    "fusion_entropy": "both heads, by certainty",
    "fusion_entropy_raw": "both heads, by certainty, no temperatures",
    "fusion_surest": "the surer head",
}
WHOLE = "none"  # the perturbation of senses that are as they should be


def build(results: Results) -> Table:
    """Accuracy of each way to join the senses under the harshest of each damage, on items at random."""
    found = measured(results, data="hybrid", mode=MIDDLE, split="random", sense="both")
    found = found[found["severity"] == found.groupby("perturbation")["severity"].transform("max")]
    frame = pd.DataFrame(
        {"damage": damage, "severity": severity, "method": method} | accuracy(part[part["method"] == method], "random")
        for (damage, severity), part in grouped(found, ["perturbation", "severity"])
        for method in METHODS
    ).drop(columns="values")
    cells = frame.assign(head=[*map(spoken, frame["damage"], frame["severity"])])
    wide = grid(cells, "method", "head", beside=(), names={"method": METHODS.get})
    words = seen(found)
    return Table(frame, wide.rename(columns={"method": "answers"}), {"seen": f"For touch: {words}." if words else ""})


def spoken(perturbation: str, severity: float) -> str:
    """A damage as a person says it, as the head of a column of per cents."""
    sense, _, what = perturbation.partition("_")
    said = "both whole" if perturbation == WHOLE else f"{sense}: {what.replace('_', ' ')}"
    return said + (f" {severity:g}, %" if severity not in (0, 1) else ", %")
