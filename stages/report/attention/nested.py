"""What the models of gaze owe to features and a ridge that were chosen on the objects that they are judged on."""

from collections import Counter

import pandas as pd

from stages.kit.stats import interval
from stages.report.items import Table
from stages.report.markdown import number, signed, with_interval
from stages.report.results import Results, some
from stages.report.style import label

from .rows import ALONE

MODELS = {"glance": "glance", "fixations": "enhanced"}  # as the stage calls it -> as the tables do
ONCE, NESTED = "once", "nested"


def build(results: Results) -> Table:
    """NSS and AUC of each model with its choices made once, and made anew without the object; the difference paired."""
    rows = results.rows("attention_settings", "gaze")
    rows = rows[rows["method"].isin([f"{model}_{way}" for model in MODELS for way in (ONCE, NESTED)])]
    some(rows, "no model of gaze with nested choices", "attention_settings", runnable=False)
    found, shown = [], []
    for model, name in MODELS.items():
        values = {way: rows[rows["method"] == f"{model}_{way}"] for way in (ONCE, NESTED)}
        if values[NESTED].empty:
            continue
        tables = {way: own.pivot_table(index="item", columns="metric", values="value") for way, own in values.items()}
        line = {"model": label(name)}
        for metric, words in ALONE.items():
            once, nested = (tables[way][metric] for way in (ONCE, NESTED))
            numbers = {"once": interval(once), "nested": interval(nested), "once_over_nested": interval(once - nested)}
            found += [
                {"model": model, "metric": metric, "what": what, "objects": len(once)}
                | dict(zip(("mean", "low", "high"), ends, strict=True))
                for what, ends in numbers.items()
            ]
            line[f"chosen once, {words}"] = with_interval(*numbers["once"], places=3)
            line[f"without the object, {words}"] = with_interval(*numbers["nested"], places=3)
            line[f"flattered by, {words}"] = signed(*numbers["once_over_nested"], places=3)
        features = tables[NESTED]["features"]
        line["features"] = f"{features.min():.0f} to {features.max():.0f} (once: {_once(values)})"
        line["ridge"] = number(tables[NESTED]["ridge"].median())
        line["in every choice"] = ", ".join(_always(values[NESTED]))
        shown.append(line)
    return Table(pd.DataFrame(found), pd.DataFrame(shown), {"count": rows["item"].nunique()})


def _once(values: dict[str, pd.DataFrame]) -> str:
    """How many features the model has by the choice that was made once."""
    return f"{values[ONCE].loc[values[ONCE]['metric'] == 'features', 'value'].max():.0f}"


def _always(rows: pd.DataFrame) -> list[str]:
    """The features that are chosen for each object."""
    chosen = rows[rows["metric"] == "features"]["channels"].str.split(", ")
    counts = Counter(name for names in chosen for name in names)
    return [label(name) for name, count in counts.items() if count == len(chosen)]
