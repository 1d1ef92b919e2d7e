"""Where recognition by touch breaks: the severity of each perturbation at which half of its lead is lost."""

import numpy as np
import pandas as pd

from stages.report.items import Table
from stages.report.results import Results
from stages.report.style import label
from stages.touch_stability import CLEAN, PERTURBATIONS

from .rows import ENOUGH, KEYS, LINES, breaking, breaking_text, curve, harmless

NOTES = [
    "Breaking point: the severity, interpolated, at which half of the lead over guessing is lost, and in brackets "
    "where the ends of the 95 % interval of the accuracy cross that level (repeated splits of the same imprints, "
    "widened for what they share: Nadeau and Bengio 2003). `> 45`: not up to 45, the harshest tried; `<` where harsher "
    "is less.",
    f"Harmless: the harshest severity up to which kNN loses at most {100 * ENOUGH:.0f} points of accuracy; `none` "
    "where the mildest costs more.",
    "Learned from clean touches, asked about disturbed ones of other places; a coarse model and few touches are what "
    "is learned from, asked about clean touches. Unseen regions: known touches are a sensor's width from those asked "
    "about. With places: the positions of the touches are features too (T table 4.5), where they change.",
    "A turn about the vertical does nothing to imprints but at the poles, since the array stands upright on the "
    "surface; to places it does.",
    "Some clean touches have a near twin among the known ones, since mirror-symmetric models are touched at vertices "
    "of both halves; of unseen regions too, whose mirror image may be known. Twins are recognised, and lost to the "
    "least disturbance: hence part of the drop at the mildest severities, most of all of the SVM, whose gamma of 1 "
    "(the thesis's) makes all but near twins strangers.",
]


def build(results: Results) -> Table:
    rows = results.measured("touch_stability", metric="accuracy")
    found = [one for one in dict.fromkeys(rows["perturbation"]) if one != CLEAN]
    frame = pd.DataFrame([_line(rows, one, line) for one in found for line in LINES]).dropna(subset=["accuracy"])
    objects = results.group_text(rows["group"].iloc[0])
    touched = f"{objects[0].upper()}{objects[1:]}, touched at points of {label(rows['method'].iloc[0])}."
    notes = [*NOTES, touched, _clean(rows), *(f"Not run: {note}." for note in results.notes("touch_stability"))]
    return Table("Where recognition by touch breaks", frame, notes, _wide(frame))


def _clean(rows):
    """The accuracy that the severities take from."""
    clean = rows[rows["perturbation"] == CLEAN].groupby(list(KEYS))["value"].mean()
    said = [f"{words} {100 * clean[line]:.0f} %" for line, words in LINES.items() if line in clean]
    return f"Undisturbed: {', '.join(said)}; guessing {100 * rows['chance'].iloc[0]:.0f} %."


def _line(rows, perturbation, line):
    """The tidy row of one perturbation and classifier; without accuracy where it was not measured."""
    common = {"perturbation": perturbation, "unit": PERTURBATIONS[perturbation].unit}
    common |= dict(zip(KEYS, line, strict=True))
    points = curve(rows, perturbation, line)
    if points is None or points["left"].isna().all():
        return common | {"accuracy": np.nan}
    at, low, high = breaking(points, perturbation)
    last = points.iloc[-1]
    return common | {
        "breaking_point": at, "low": low, "high": high, "harmless": harmless(points, perturbation),
        "harshest": last["severity"], "accuracy": last["accuracy"],
    }  # fmt: skip


def _wide(frame):
    lines = []
    for perturbation, group in frame.groupby("perturbation", sort=False):
        by_line = {(row.split, row.features, row.classifier): row for row in group.itertuples()}
        first = group.iloc[0]
        line = {"perturbation": label(perturbation), "unit": first["unit"]}
        unharmed = PERTURBATIONS[perturbation].unharmed
        line |= {f"{words} breaks at": breaking_text(by_line[key], unharmed) if key in by_line else "–"
                 for key, words in LINES.items()}  # fmt: skip
        fine = first["harmless"]
        lines.append(line | {"harmless to kNN": "none" if np.isnan(fine) else f"{fine:g}"})
    return pd.DataFrame(lines)
