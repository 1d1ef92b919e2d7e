"""Both senses at once, whole, damaged or missing: which way to join them recognises most."""

import pandas as pd

from stages.report.items import Table
from stages.report.networks import accuracy, measured, seen
from stages.report.results import Results
from stages.report.tables import Ranking, grid, grouped, percent

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
MEAN = "mean of all columns, %"
DETAILS = ("blur", "darkness", "occlusion", "dead cells")  # damages that stand behind noise and a missing sense
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
    wide = grid(cells, "method", "head", names={"method": METHODS.get}).rename(columns={"method": "answers"})
    shares = frame.groupby("method", sort=False)["accuracy"].mean()
    wide.insert(1, MEAN, [percent(shares[method]) for method in METHODS if method in shares])
    words, answer = seen(found), [name for name in map(str, wide) if not any(part in name for part in DETAILS)]
    return Table(frame, wide, {"seen": f"For touch: {words}." if words else ""}, Ranking(MEAN), answer)


def spoken(perturbation: str, severity: float) -> str:
    """A damage as a person says it, as the head of a column of per cents."""
    sense, _, what = perturbation.partition("_")
    said = "both whole" if perturbation == WHOLE else f"{sense}: {what.replace('_', ' ')}"
    return said + (f" {severity:g}, %" if severity not in (0, 1) else ", %")
