"""How many points each detector found, and how much about them the simplified meshes kept."""

import numpy as np
import pandas as pd

from stages.report.items import Table
from stages.report.results import SECTION_3_1, NotRun, Results, some
from stages.report.simplified import UNIT, as_plain
from stages.report.words import dataset_text

from .methods import PLAIN, QSLIM, fixed, ordered, short
from .rows import data_sets, face_counts, said

SHARES = {"without_points": "without a point, %", "three_rings": "three rings, %", "as_plain": "as plain, %"}


def build(results: Results) -> Table:
    """A row a data set, method and target: median points, median rings, shares of objects without or with all."""
    sets = data_sets(results)
    first = results.printed(SECTION_3_1, "lod") or sets[0]
    if "rings" not in results.rows("lod", first):
        raise NotRun("no rings in the rows of lod", "lod")
    frames = {name: counted(results.rows("lod", name)) for name in sorted(sets, key=lambda name: name != first)}
    frame = pd.concat({dataset_text(name): found for name, found in frames.items()}, names=["data", None])
    frame = frame.reset_index("data").reset_index(drop=True)
    own = frame[frame["data"] == dataset_text(first)]
    targets = face_counts(results.rows("lod", first))[:2]
    some(targets, "no target is a number of faces", "lod", runnable=False)
    return Table(
        frame, _wide(own, targets), {"set": dataset_text(first)}
    )  # no ranking: numbers of points do not compete


def counted(rows: pd.DataFrame) -> pd.DataFrame:
    """The table's numbers for the rows of one set: a row a method and target, over the objects that have a mesh."""
    units = rows[rows["value"].notna() & (rows["metric"] == "metro_mean")]
    units = units[[fixed(name) and name not in (PLAIN, QSLIM) for name in units["method"]]]
    units = units.assign(
        without_points=units["points"] == 0,
        three_rings=(units["points"] > 0) & ~units["shrunk"].astype(bool),
        as_plain=pd.MultiIndex.from_frame(units[UNIT]).isin(as_plain(rows)),
    )
    grouped = units.groupby(["method", "target"], sort=False)
    found = grouped.agg(objects=("item", "nunique"), points=("points", "median"), rings=("rings", "median"))
    found = found.join(grouped[list(SHARES)].mean()).reset_index()
    found["method"] = pd.Categorical(found["method"], ordered(found["method"].unique()))
    return found.sort_values("method", kind="stable").astype({"method": str})


def _wide(own: pd.DataFrame, targets: list[str]) -> pd.DataFrame:
    """A row a method: its points at the fewest faces, then rings and shares by face count, most faces first."""
    cells = own.set_index(["method", "target"])
    methods = own["method"].unique()
    shown = pd.DataFrame({"kept points": [short(name) for name in methods]})

    def column(name: str, target: str, text: str = "{:.1f}", factor: float = 1.0) -> list[str]:
        values = factor * cells.xs(target, level="target")[name].reindex(methods)
        return ["–" if np.isnan(value) else text.format(value) for value in values]

    shown["points"] = column("points", targets[-1])
    shown[SHARES["without_points"]] = column("without_points", targets[-1], "{:.0f}", 100)
    for target in targets:
        shown[f"rings, {said(target)}"] = column("rings", target)
        for name in ("three_rings", "as_plain"):
            shown[f"{SHARES[name]}, {said(target)}"] = column(name, target, "{:.0f}", 100)
    return shown
