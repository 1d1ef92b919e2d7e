"""What counts once in an interval: an object with its copies, a class with its objects, an object with its draws."""

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pandas as pd

# Objects of the household set whose three sizes normalisation makes equal: 50 objects are 40 shapes.
COPIES = re.compile(r"(cube|cylinder|pyramid|sphere|torus)(?:small|medium|large)")
BENCHMARK = re.compile(r"([A-Z][A-Za-z]+)_\d+")  # CLASS_ID: a mesh of the Princeton segmentation benchmark


def unit(item: str) -> str:
    """What an object is one of: its shape where others are copies of it, its class where its name tells it."""
    found = COPIES.fullmatch(item) or BENCHMARK.fullmatch(item)
    return found[1] if found else item


def by_unit(values: "pd.Series") -> "pd.Series":
    """The means of the outermost units of values whose index runs from the outermost level to the innermost.

    A level `item` counts by `unit`. Means are taken level by level, from the innermost: a unit with many draws weighs
    as much as one with few. The bootstrap over these means is the hierarchical one: outermost units are drawn with
    replacement, and what is inside of one comes along whole. The spread of the means holds the spread inside. Drawing
    inside again would count that twice (Davison and Hinkley, Bootstrap Methods and their Application, 1997, section
    3.8; Ren et al., Nonparametric bootstrapping for hierarchical data, 2010). NaN is left out.
    """
    values = values.dropna()
    if "item" in values.index.names:
        levels = [values.index.get_level_values(depth) for depth in range(values.index.nlevels)]
        merged = [[unit(str(one)) for one in level] if level.name == "item" else level for level in levels]
        values = values.groupby(merged, sort=False).mean()
    for depth in range(values.index.nlevels - 1, 0, -1):
        values = values.groupby(level=list(range(depth)), sort=False).mean()
    return values
