"""Imprints a second and how exact they are: ours beside camera-based simulators, timed in one run of `make bench`."""

import numpy as np
import pandas as pd

from stages.report.intervals import interval
from stages.report.items import Table
from stages.report.markdown import with_interval
from stages.report.reach import reach
from stages.report.results import NotRun

OURS, REFERENCE = "ours", "tacto_160x120"
NAMES = {
    "ours": "ours", "trimesh_embree": "trimesh on embree", "depth_picture": "depth picture (pyrender)",
    "tacto_32x32": "TACTO, 32 x 32 pixels", "tacto_160x120": "TACTO, its 160 x 120 pixels",
}  # fmt: skip
WANTED = {"rate": 3000, "ratio": 50}  # imprints of WIDE x WIDE cells a second; times TACTO's rate
WIDE = 32
MANY = 100  # rates from here on are shown as whole numbers
NOTES = [
    "Rate: geometric mean over the meshes, arrays 0.002 and 0.01 units apart [95 % interval over the meshes], of 40 "
    "random vertices, the same for all, by the time of the process on one core; lowest: of the slowest mesh. Ratio: to "
    "the rate of TACTO (a camera-based simulator of a gel sensor) at its own resolution on the same mesh and points, "
    "one call of its renderer a touch, without noise, forces and steps of its physics.",
    "Error: the largest distance, over a plane, a sphere, a cylinder and a saddle, between what was measured and the "
    "mesh that was touched, in thousandths of the distance of two cells. The cameras' error comes from "
    "pyrender, which takes the depth at a sample up to 3/8 of a pixel off the pixel's middle.",
    "A depth picture, and TACTO's, is what is seen from above; the array also measures where it is inside the object. "
    "trimesh's rays start above as well, one a cell.",
]


def build(results):
    frame = summarised(results)
    return Table("Imprints a second", frame, [*_said(frame), _meshes(results), *NOTES], _wide(frame))


def summarised(results):
    """A row a method and number of cells: rates, ratios, error (units) and pitch (units) of that, note."""
    rows = results.bench("imprints")
    rates, errors = rows[rows["what"] == "rate"], rows[rows["what"] == "error"]
    if rates["value"].notna().sum() == 0 or len(errors) == 0:
        raise NotRun("bench/imprints.csv is not whole: `make bench` writes it anew", "imprints", runnable=False)
    found = []
    for (method, cells), group in rates.dropna(subset=["method"]).groupby(["method", "cells"], sort=False):
        line = {"method": method, "cells": int(cells), "meshes": group.dropna(subset=["value"])["mesh"].nunique()}
        for name, column in (("rate", "value"), ("ratio", "ratio")):
            line |= dict(zip((name, f"{name}_low", f"{name}_high"), _mean(group, column), strict=True))
            line[f"{name}_least"] = group[column].min()
        own = errors[errors["method"] == method]
        line |= {"error": own["to_mesh"].max(), "pitch": own["pitch"].max()}
        notes = group["note"].dropna()
        found.append(line | {"note": notes.iloc[0] if len(notes) else ""})
    return pd.DataFrame(found).sort_values(["cells", "rate"], ascending=[True, False], ignore_index=True)


def _mean(group, column):
    """(geometric mean, low, high) over the meshes."""
    logs = np.log(group[column].astype(float)).groupby(group["mesh"]).mean()
    return tuple(np.exp(interval(logs)))


def _said(frame):
    """What ours was to reach, and whether it did."""
    said = []
    for row in frame[frame["method"] == OURS].itertuples():
        rate, ratio = (row.rate, row.rate_low, row.rate_high), (row.ratio, row.ratio_low, row.ratio_high)
        size = f"{row.cells} x {row.cells} cells"
        text = f"Ours, {size}: {_whole(*rate)} imprints a second on one core"
        text += f"; {WANTED['rate']:,} is {reach(*rate, least=WANTED['rate'])}" if row.cells == WIDE else ""
        word = reach(*ratio, least=WANTED["ratio"])
        beside = f"{_whole(*ratio)} times TACTO's rate; {WANTED['ratio']} times is {word}"
        said.append(f"{text}. {beside if ratio[0] == ratio[0] else 'TACTO was not run'}.")
    return said


def _meshes(results):
    rows = results.bench("imprints").query("what == 'rate'")
    known = rows.dropna(subset=["value"]).drop_duplicates("mesh")
    lines = [f"{row.mesh} ({row.source}, {int(row.faces):,} faces)" for row in known.itertuples()]
    absent = rows[rows["value"].isna()].dropna(subset=["note"])
    who = absent["method"].map(NAMES).fillna(absent["source"])
    reasons = dict.fromkeys(f"{name}: {note}" for name, note in zip(who, absent["note"], strict=True))
    return f"Meshes: {', '.join(lines)}. " + "".join(f"{reason}. " for reason in reasons)


def _wide(frame):
    shown = pd.DataFrame({"method": frame["method"].map(NAMES), "cells": frame["cells"]})
    for name, title in (("rate", "imprints a second"), ("ratio", "ratio to TACTO")):
        triples = frame[[name, f"{name}_low", f"{name}_high"]].itertuples(index=False)
        shown[title] = ["–" if triple[0] != triple[0] else _whole(*triple) for triple in triples]
        shown[f"lowest {name}"] = [round(value) if value >= MANY else value for value in frame[f"{name}_least"]]
    shown["error, thousandths of a cell"] = [_error(value) for value in 1000 * frame["error"] / frame["pitch"]]
    return shown.assign(**{"version and renderer": frame["note"]})


def _whole(*triple):
    """A mean with its interval, large ones as whole numbers."""
    return with_interval(*(round(value) if value >= MANY else value for value in triple))


def _error(value):
    """A number; below a millionth it is rounding of double precision and said so."""
    return "< 1e-6" if value < 1e-6 else value
