"""Two disturbances at once: is what they cost the sum of what each costs alone, more, or less?"""

import numpy as np
import pandas as pd

from stages.engine.statistics import interval
from stages.report.drawing import label
from stages.report.items import Table
from stages.report.results import Results, some
from stages.report.tables import percent, records, signed
from stages.stability.disturbance import AND
from stages.stability.simplification import middle_severity

from .score import BENCHMARK, STAGE, points_lost

SHOWN = ("glance", "glance_any_pose", "itti", "mesh_saliency", "harris")  # the CSV has all


def table(results: Results) -> Table:
    """A row a pair and method: the share of points lost to each alone, to both, and to both less the sum."""
    rows = results.rows(STAGE, results.printed(BENCHMARK, STAGE), metric=["repeatability", "chance"])
    lost = points_lost(rows)
    pairs = [name for name in dict.fromkeys(lost["perturbation"]) if AND in name]
    pairs = some(pairs, "no pairs of disturbances: stability.pairs is empty", STAGE, runnable=False)
    methods = [method for method in dict.fromkeys(lost["method"]) if method != "random"]
    frame = pd.DataFrame([
        {"pair": " and ".join(map(label, pair.split(AND))), "method": method}
        | compared(lost[lost["method"] == method], pair, middle_of(rows))
        for pair in pairs
        for method in methods
    ])  # fmt: skip
    shown = pd.DataFrame([
        {"disturbances": row.pair, "method": label(row.method),
         "first alone, %": percent(row.first), "second alone, %": percent(row.second),
         "both, %": percent(row.both), "both less the sum": signed(*_hundredfold(row, "beyond"), places=0),
         "is": verdict(row.beyond_low, row.beyond_high)}
        for row in records(frame[frame["method"].isin(SHOWN)])
    ])  # fmt: skip
    words = [verdict(row.beyond_low, row.beyond_high) for row in records(frame)]
    counted = ", ".join(f"{words.count(word)} {word}" for word in ("milder", "additive", "worse"))
    return Table(frame, shown, {"objects": rows["item"].nunique(), "counted": counted, "cases": len(words)})


def middle_of(rows: pd.DataFrame) -> dict[str, float]:
    """{perturbation: its middle severity}."""
    known = rows.dropna(subset=["severity"]).drop_duplicates(["perturbation", "severity"])
    severities = known.groupby("perturbation", sort=False)["severity"]
    return {str(name): middle_severity(list(own)) for name, own in severities}


def compared(lost: pd.DataFrame, pair: str, middle: dict[str, float]) -> dict[str, float]:
    """Means over the objects of one method: lost to `first`, `second` and `both`; `beyond` the sum, with its interval.

    lost: as of `points_lost`. The sum is at most 1, where all is lost. `independent`: both less what would be lost if
    what one leaves were lost to the other in the same share.
    """
    first, second = (
        lost[(lost["perturbation"] == name) & (lost["severity"] == middle[name])].set_index("item")["value"]
        for name in pair.split(AND)
    )
    both = lost[lost["perturbation"] == pair].set_index("item")["value"]
    joined = pd.concat({"first": first, "second": second, "both": both}, axis=1, join="inner")
    beyond = interval(joined["both"] - np.minimum(joined["first"] + joined["second"], 1))
    independent = joined["both"] - 1 + (1 - joined["first"]) * (1 - joined["second"])
    found = {name: float(joined[name].mean()) for name in ("first", "second", "both")}
    found |= dict(zip(("beyond", "beyond_low", "beyond_high"), beyond, strict=True))
    return found | {"independent": float(independent.mean()), "objects": len(joined)}


def verdict(low: float, high: float) -> str:
    """milder or worse than the sum, or additive where the interval covers 0 or there is none."""
    return "milder" if high < 0 else "worse" if low > 0 else "additive"


def _hundredfold(row, name):
    return [100 * getattr(row, key) for key in (name, f"{name}_low", f"{name}_high")]
