"""Where each method breaks: the severity of each perturbation at which half of the points are lost."""

import numpy as np
import pandas as pd

from stages.kit.stats import interval
from stages.report.items import Table
from stages.report.markdown import number
from stages.report.results import Results
from stages.report.style import label
from stages.stability import PERTURBATIONS
from stages.stability.summary import breaking_points, middle_severity

CHANCE = "random"  # it looks at nothing, so that it cannot break; its level is a column
NOTES = [
    "The severity, interpolated, at which fewer than half of a method's points are found again within 2 % of the "
    "diagonal, mean over the objects; `> 90`: not up to 90, the harshest tried; `< 0.1` where harsher is less.",
    "Chance: the share of the points that as many random points would find again, mean over methods and severities.",
    "A method that works on the surface alone sees neither light nor image; one that works on the images does not see "
    "the triangles. What a method cannot see cannot break it.",
    "`background left in` is the thesis's way (T3.1.5): even black is another image than one without any background, "
    "so it may break at black. `background` is kept out of the maps, and so does nothing.",
]


def build(results: Results) -> Table:
    rows = results.measured("stability", metric=["repeatability", "chance", "drift"])
    points = rows[(rows["metric"] == "repeatability") & (rows["method"] != CHANCE)]
    frame = pd.DataFrame([_line(rows, *key, value) for key, value in breaking_points(points).items()])
    objects = ", ".join(dict.fromkeys(points["item"]))
    notes = [*NOTES, f"Objects: {objects}.", *(f"Not run: {note}." for note in results.notes("stability"))]
    return Table("Where each method breaks", frame, notes, _wide(frame))


def _line(rows, perturbation, method, breaking):
    """The tidy row of one perturbation and method: at the middle severity, and where it breaks."""
    rows = rows[rows["perturbation"] == perturbation]
    severities = list(dict.fromkeys(rows["severity"]))
    here = rows[(rows["method"] == method) & (rows["severity"] == middle_severity(severities))]
    values = {metric: group["value"].to_numpy() for metric, group in here.groupby("metric")}
    mean, low, high = interval(values.get("repeatability", []))
    return {
        "perturbation": perturbation, "unit": PERTURBATIONS[perturbation].unit, "method": method,
        "severity": middle_severity(severities), "repeatability": mean, "low": np.maximum(low, 0.0),
        "high": np.minimum(high, 1.0), "drift": interval(values.get("drift", []))[0],
        "chance": rows.loc[rows["metric"] == "chance", "value"].mean(), "harshest": severities[-1],
        "breaking_point": breaking,
    }  # fmt: skip


def _wide(frame):
    lines = []
    for perturbation, group in frame.groupby("perturbation", sort=False):
        first = group.iloc[0]
        line = {"perturbation": label(perturbation), "unit": first["unit"]}
        for row in group.itertuples():
            line[label(row.method)] = _cell(row)
        lines.append(line | {"chance, %": f"{100 * first['chance']:.0f}"})
    return pd.DataFrame(lines)


def _cell(row):
    if row.breaking_point == row.breaking_point:
        return number(row.breaking_point, 2)
    falling = row.harshest < PERTURBATIONS[row.perturbation].unharmed
    return f"{'<' if falling else '>'} {row.harshest:g}"
