"""Rows of the search for the front: of shapes by unseen regions, and of classes by unseen objects."""

from typing import Any

import pandas as pd

from haptic_glance.know.split import Split
from stages.kit.stats import interval
from stages.report.grid import everywhere, within
from stages.report.markdown import number
from stages.report.results import Results, some
from stages.report.style import label

STAGE = "front"
SEARCH, CONFIRMED, CHANGED = "last", "confirmation", "one_choice"  # of the column `rung`
CHOICES = ("method", "viewpoints", "image_rows", "points", "cells", "level", "touches", "classifier")
WHOLE = "100%"  # of the column `level`
SPLITS = {Split.REGIONS: "regions", Split.OBJECTS: "objects"}  # split -> its columns
PARTS = ("simplifying", "looking", "pressing", "asking")


def front_rows(results: Results) -> pd.DataFrame:
    """All rows of both splits; NotRun where nothing was searched."""
    return pd.concat(everywhere(results, STAGE, metric="accuracy").values(), ignore_index=True)


def of_rung(rows: pd.DataFrame, rung: str) -> pd.DataFrame:
    """One row a choice: its options, `words`, the accuracies with low and high, seconds with their parts, training."""
    found = []
    for choice, own in some(rows[rows["rung"] == rung], f"no rows of {rung}", STAGE).groupby("number"):
        first = own.iloc[0]
        line: dict[str, Any] = {"number": choice, "words": words(first)} | {name: first[name] for name in CHOICES}
        for split, name in SPLITS.items():
            ends = within(own.loc[own["split"] == split, "value"])
            line |= zip((name, f"{name}_low", f"{name}_high"), ends, strict=True)
        found.append(line | own[["seconds", *PARTS, "training", "faces"]].mean().to_dict())
    return pd.DataFrame(found)


def words(row: pd.Series) -> str:
    """A choice in words: `blind touch, 40 places, 8 x 8, all faces, 3 touches, kNN`."""
    sight = f" ({row['viewpoints']} views of {row['image_rows']:.0f} rows)" if pd.notna(row["image_rows"]) else ""
    faces = "all faces" if row["level"] == WHOLE else f"{row['level']} faces"
    touches = "1 touch" if row["touches"] == 1 else f"{row['touches']} touches"
    parts = [f"{label(row['method'])}{sight}", f"{row['points']} places", f"{row['cells']} x {row['cells']} cells"]
    return ", ".join([*parts, faces, touches, label(row["classifier"])])


def effect(base: pd.DataFrame, own: pd.DataFrame, split: str) -> tuple[float, float, float]:
    """(mean, low, high) over the objects: the points of accuracy by which the rows of a choice exceed those of base."""
    before, after = (frame[frame["split"] == split].set_index("item")["value"] for frame in (base, own))
    return interval(100 * (after - before).dropna())


def brief(value: float) -> str:
    """A number to two digits: 19, 0.95, 110."""
    return number(float(f"{value:.2g}"), 2)


def named(rows: pd.DataFrame, role: str) -> int:
    """The number of the confirmed choice with a role, `smallest` or `default`."""
    return int(some(rows[rows["role"] == role], f"no {role} choice was confirmed", STAGE)["number"].iloc[0])
