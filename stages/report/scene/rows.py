"""The measurements of the scene stage, how its methods are called, and what the comparison of them leaves open."""

from typing import Any

import numpy as np
import pandas as pd

from stages.report.grid import records
from stages.report.markdown import with_interval
from stages.report.results import Results

NAMES = {
    "full": "full models",
    "uniform": "uniform levels by distance",
    "uniform_size": "uniform levels by size on the screen",
    "network": "the thesis's network",
    "ours_plain": "ours, salience left out",
    "ours": "ours",
    "equal": "ours, the limit shared equally",
    "online": "ours, no frame seen ahead",
    "online_unrendered": "the same, nothing rendered",
}
COLOURS = {
    "full": "#222222", "uniform": "#E69F00", "uniform_size": "#D55E00", "network": "#CC79A7", "ours_plain": "#56B4E9",
    "ours": "#0072B2", "online": "#009E73",
}  # fmt: skip
UNITS = {"pixels": "pixels", "ssim": "1 − SSIM"}
OURS = "ours"
RANDOM = "household_scenes"  # the set with scenes drawn at random
UNIFORM = ("uniform", "uniform_size")


def scene_rows(results: Results, **where: Any) -> tuple[pd.DataFrame, str, float, str]:
    """(rows of the stage with a value and no gaps in `matched`, the scene, the first tolerance, its unit in words)."""
    rows = results.measured("scene", **where).fillna({"matched": ""})
    first = rows.dropna(subset=["tolerance"]).iloc[0]
    return rows, first["group"], float(first["tolerance"]), UNITS[first["kind"]]


def amount(value: float, unit: str) -> str:
    """A tolerance in words: 1 pixel, 0.5 pixels."""
    return f"{value:g} {unit.removesuffix('s') if value == 1 else unit}"


def savings(rows: pd.DataFrame) -> pd.DataFrame:
    """The rows on the share of the faces that ours saves: value, low, high, the `rival`, and in per cent as `text`."""
    found = rows[rows["metric"].str.startswith("saved_")].dropna(subset=["kind", "value"])
    text = [with_interval(row.value, row.low, row.high, 100, 0) for row in records(found)]
    return found.assign(rival=found["metric"].str.removeprefix("saved_"), text=text)


def left_of(saved: pd.DataFrame) -> str:
    """How much of `savings` at an equal error is left at an equal displacement; empty where that is not measured."""
    shares = {key: list(values) for key, values in saved.groupby(["rival", "matched"])["value"]}
    pairs = {name: (shares[name, "error"], shares[name, "displacement"]) for name in UNIFORM
             if {(name, "error"), (name, "displacement")} <= set(shares)}  # fmt: skip
    if not pairs:
        return ""
    equal, spread = (np.mean(np.concatenate(each)) for each in zip(*pairs.values(), strict=True))
    part = "most" if spread < equal / 2 else "part"
    left = "the saving is no smaller" if spread >= equal else f"{part} of the saving vanishes"
    said = [f"{_range(each)} instead of {_range(own)} against {NAMES[name]}" for name, (own, each) in pairs.items()]
    return f" At an equal mean displacement of all pixels {left}: {'; '.join(said)}."


def _range(shares: list[float]) -> str:
    """Shares as percent: 12 %, or 3 to 40 %."""
    return " to ".join(dict.fromkeys(f"{round(100 * share):d}" for share in (min(shares), max(shares)))) + " %"
