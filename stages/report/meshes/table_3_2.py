"""T table 3.2: errors of the simplified meshes, on every data set."""

import numpy as np
import pandas as pd

from stages.kit.stats import interval
from stages.report.grid import means
from stages.report.items import Table
from stages.report.markdown import number
from stages.report.results import NotRun, Results
from stages.report.style import label
from stages.report.words import dataset_text

from .rows import ERRORS, FEWEST, PLAIN, data_sets, face_counts, marked, paired_cells, said, size

PROPOSED = ["guided_ed", "guided_ssim", "svm", "thesis_ed", "thesis_ssim"]
METHODS = [each for name in PROPOSED for each in (name, f"{name}-adaptive")]
METHODS += ["VisAttAll", "heat_kernel", "enhanced", PLAIN]
PRINTED = {"guided_ed": "ed", "thesis_ed": "ed", "guided_ssim": "ssim", "thesis_ssim": "ssim", "svm": "svm"}
METRICS = ["metro_mean", "ssim_error"]
KEY = ["data", "nothing_shrunk", "target", "method", "metric"]
NOTES = [
    "Metro mean: mean distance between the two surfaces, in % of the bounding-box diagonal; 1 − SSIM: of renders from "
    "the viewpoints, in %. Each figure: mean over the objects [95 % interval over the objects].",
    "For one data set and face count all methods are compared on the same objects. + and – behind a figure: higher or "
    "lower than plain QEM on the same objects, beyond chance (95 % interval of the paired difference, in the CSV).",
    "Where the kept neighbourhoods leave too few faces for a target, they shrink from the least salient point on. "
    "Blocks `nothing shrunk` hold the objects on which no method had to: the thesis's own algorithm. A set with fewer "
    f"than {FEWEST} such objects is left out.",
    "Guided: weights learned from our own marked objects, never from the object itself; of table 3.1: the weights that "
    "the thesis published. The thesis's figures (43 models of the 3D interest point benchmark, the unit of its Metro "
    "error is not stated; here read as a share of the diagonal) stand beside both.",
]


def build(results: Results) -> Table:
    frame = pd.concat(_blocks(results, data_sets(results)), ignore_index=True)
    if frame.empty:
        raise NotRun("no face count that all methods of the table reach", "lod", runnable=False)
    thesis = results.thesis("table_3_2_lod_errors").set_index(["method", "faces"])
    frame["thesis"] = [_printed(thesis, row) for row in frame.itertuples()]
    title = "Table 3.2: errors of simplified meshes, beside the thesis"
    return Table(title, frame, [_counted(frame), *NOTES], _wide(frame))


def _blocks(results, names):
    """Frames of each data set, with all cells and with those in which nothing shrank."""
    yield pd.DataFrame(columns=KEY)
    for name in names:
        every = None
        for whole in (False, True):
            rows = paired_cells(results, METRICS, METHODS, name, whole)
            rows = rows[rows["target"].isin(face_counts(rows))]
            if len(rows) and (every is None or len(rows) < len(every)):
                yield _means(rows.assign(data=dataset_text(name), nothing_shrunk=whole))
            every = rows


def _means(rows):
    found = pd.DataFrame(means(rows, KEY)).rename(columns={"values": "objects"}).drop(columns="seconds")
    gain = rows.assign(gain=rows["value"] - rows["plain"]).groupby(KEY, sort=False)["gain"]
    found = found.set_index(KEY)
    found[["over_plain", "over_plain_low", "over_plain_high"]] = [interval(gain.get_group(key)) for key in found.index]
    return found.reset_index()


def _printed(thesis, row):
    """The thesis's figure, beside its methods in their fixed form."""
    key = (PRINTED.get(row.method), int(row.target) if row.target.isdigit() else 0)
    return thesis.loc[key, row.metric] if key in thesis.index else np.nan


def _wide(frame):
    lines = []
    for target, whole in _keys(frame):
        block = frame[(frame["target"] == target) & (frame["nothing_shrunk"] == whole)]
        name = said(target) + (", nothing shrunk" if whole else "")
        for method in [method for method in METHODS if method in set(block["method"])]:
            lines.append({"target": name, "kept points": label(method)} | _figures(block[block["method"] == method]))
    return pd.DataFrame(lines).fillna("–")


def _keys(frame):
    """(target, nothing shrunk) of the blocks, most faces first."""
    keys = frame[["target", "nothing_shrunk"]].drop_duplicates().itertuples(index=False, name=None)
    return sorted(keys, key=lambda key: (size(key[0]), key[1]))


def _counted(frame):
    """How many objects each block is over, as a note."""
    counts = frame.drop_duplicates(["data", "target", "nothing_shrunk"]).set_index(["target", "nothing_shrunk"])
    parts = [
        f"{said(key[0])}{', nothing shrunk' if key[1] else ''}: "
        + ", ".join(f"{row.objects:.0f} {row.data}" for row in counts.loc[[key]].itertuples())
        for key in _keys(frame)
    ]
    return f"Objects: {'; '.join(parts)}."


def _figures(rows):
    line = {}
    for metric in METRICS:
        name, factor = ERRORS[metric]
        here = rows[rows["metric"] == metric]
        for row in here.itertuples():
            line[f"{name}, {row.data}"] = marked(row, factor)
        line[f"{name}, thesis"] = number(factor * here["thesis"].iloc[0])
    return line
