"""What the glance owes to features and a ridge that were chosen on the objects that they are judged on."""

from collections import Counter

import pandas as pd

from stages.kit.stats import interval
from stages.report.items import Table
from stages.report.markdown import number, signed, with_interval
from stages.report.results import Results, some
from stages.report.style import label

from .rows import ALONE, OURS

ONCE, NESTED = "once", "nested"


def build(results: Results) -> Table:
    """NSS and AUC of the glance with its choices made once, and made anew without the object; the difference paired."""
    rows = results.rows("attention_checks", "gaze")
    values = {way: rows[rows["method"] == f"{OURS}_{way}"] for way in (ONCE, NESTED)}
    some(values[NESTED], "no glance with nested choices", "attention_checks", runnable=False)
    tables = {way: own.pivot_table(index="item", columns="metric", values="value") for way, own in values.items()}
    found, line = [], {"model": label(OURS)}
    for metric, words in ALONE.items():
        once, nested = (tables[way][metric] for way in (ONCE, NESTED))
        numbers = {"once": interval(once), "nested": interval(nested), "once_over_nested": interval(once - nested)}
        found += [
            {"model": OURS, "metric": metric, "what": what, "objects": len(once)}
            | dict(zip(("mean", "low", "high"), ends, strict=True))
            for what, ends in numbers.items()
        ]
        line[f"chosen once, {words}"] = with_interval(*numbers["once"], places=3)
        line[f"without the object, {words}"] = with_interval(*numbers["nested"], places=3)
        line[f"flattered by, {words}"] = signed(*numbers["once_over_nested"], places=3)
    features = tables[NESTED]["features"]
    line["features"] = f"{features.min():.0f} to {features.max():.0f} (once: {tables[ONCE]['features'].max():.0f})"
    line["ridge"] = number(tables[NESTED]["ridge"].median())
    line["in every choice"] = ", ".join(_always(values[NESTED]))
    return Table(pd.DataFrame(found), pd.DataFrame([line]), {"count": len(features)})


def _always(rows: pd.DataFrame) -> list[str]:
    """The features that are chosen for each object."""
    chosen = rows[rows["metric"] == "features"]["chosen"].str.split(", ")
    counts = Counter(name for names in chosen for name in names)
    return [label(name) for name, count in counts.items() if count == len(chosen)]
