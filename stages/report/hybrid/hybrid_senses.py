"""Both senses at once, whole, damaged or missing: which way to join them recognises most."""

import pandas as pd

from stages.report.items import Table
from stages.report.markdown import with_interval
from stages.report.networks import mean
from stages.report.results import NotRun

from .rows import BOTH, WHOLE, rows

NOTES = [
    "Accuracy in per cent [95 % interval over repeated splits]: each test touch with a picture of the same object, "
    "items at random. Damage is done to one sense alone; its severity is the highest measured. A sense that is missing "
    "says nothing, which counts as wrong: below guessing.",
    "The better sense: that which was right more often on whole items that neither learned from; it does not know of "
    "the damage. By certainty: each head "
    "counts by one minus the entropy of its answer, after its temperature was set on such items. The streams summed: "
    "what the thesis's own network does when it is fed both, which the thesis never did.",
]


def build(results):
    found = rows(results, metric="accuracy", split="random", sense="both")
    if found.empty:
        raise NotRun("no accuracies with both senses", "transfer")
    harshest = found.groupby("perturbation")["severity"].transform("max")
    found = found[found["severity"] == harshest]
    lines = []
    for (perturbation, severity), part in found.groupby(["perturbation", "severity"], sort=False):
        for method in BOTH:
            values = part.loc[part["method"] == method, "value"]
            triple = dict(zip(("accuracy", "low", "high"), mean(values, "random"), strict=True))
            lines.append({"damage": perturbation, "severity": severity, "method": method} | triple)
    frame = pd.DataFrame(lines)
    return Table("Sight and touch at once", frame, NOTES, _wide(frame))


def spoken(perturbation):
    """A damage as a person says it."""
    if perturbation == WHOLE:
        return "both whole"
    sense, _, what = perturbation.partition("_")
    return f"{sense}: {what.replace('_', ' ')}"


def _wide(frame):
    text = [with_interval(row.accuracy, row.low, row.high, 100, 0) for row in frame.itertuples()]
    head = [
        spoken(row.damage) + (f" {row.severity:g}" if row.severity not in (0, 1) else "") for row in frame.itertuples()
    ]
    wide = frame.assign(text=text, head=head).pivot(index="method", columns="head", values="text")
    wide = wide.loc[[name for name in BOTH if name in wide.index]][list(dict.fromkeys(head))]
    return wide.rename(index=BOTH, columns=lambda name: f"{name}, %").reset_index(names="answers")
