"""T table 3.2: errors of the simplified meshes, on every data set."""

from collections.abc import Iterator

import pandas as pd

from stages.kit.stats import interval
from stages.report.grid import means
from stages.report.items import Table
from stages.report.markdown import number
from stages.report.results import NotRun, Results
from stages.report.style import label
from stages.report.words import dataset_text

from .methods import ENHANCED, FIXED_ADAPTIVE, HKS, OURS, PLAIN
from .rows import ERRORS, FEWEST, data_sets, face_counts, marked, paired_cells, said, size, wide

METHODS = [*FIXED_ADAPTIVE, "thesis_ed", "thesis_ed-adaptive", ENHANCED, f"{ENHANCED}-adaptive", "VisAttAll", HKS,
           OURS, PLAIN]  # fmt: skip
PRINTED = {"guided_ed": "ed", "thesis_ed": "ed", "guided_ssim": "ssim", ENHANCED: "ssim", "svm": "svm"}
METRICS = ["metro_mean", "ssim_error"]
BLOCK = ["target", "nothing_shrunk"]
KEY = ["data", "nothing_shrunk", "target", "method", "metric"]


def build(results: Results) -> Table:
    """Errors by method and face count, on all objects and where nothing shrank, beside the thesis's."""
    parts = list(_parts(results))
    if not parts:
        raise NotRun("no face count that all methods of the table reach", "lod", runnable=False)
    frame = pd.concat(parts, ignore_index=True)
    thesis = results.thesis("table_3_2_lod_errors").melt(["method", "faces"], METRICS, "metric", "thesis")
    thesis = thesis.rename(columns={"method": "printed", "faces": "target"}).astype({"target": str})
    frame = frame.assign(printed=frame["method"].map(PRINTED)).merge(thesis, "left").drop(columns="printed")
    blocks = [said(row.target) + ", nothing shrunk" * row.nothing_shrunk for row in frame.itertuples()]
    cells = frame.assign(block=blocks)
    return Table(frame, _wide(cells), {"objects": _counted(cells), "fewest": FEWEST})


def _parts(results: Results) -> Iterator[pd.DataFrame]:
    """Frames of each data set, with all cells and, where they are fewer, with those in which nothing shrank."""
    for name in data_sets(results):
        every = None
        for whole in (False, True):
            rows = paired_cells(results, METRICS, METHODS, name, whole)
            rows = rows[rows["target"].isin(face_counts(rows))]
            if len(rows) and (every is None or len(rows) < len(every)):
                yield _means(rows.assign(data=dataset_text(name), nothing_shrunk=whole))
            every = rows


def _means(rows: pd.DataFrame) -> pd.DataFrame:
    found = pd.DataFrame(means(rows, KEY)).rename(columns={"values": "objects"}).drop(columns="seconds").set_index(KEY)
    gain = rows.assign(gain=rows["value"] - rows["plain"]).groupby(KEY, sort=False)["gain"]
    found[["over_plain", "over_plain_low", "over_plain_high"]] = [interval(gain.get_group(key)) for key in found.index]
    return found.reset_index()


def _wide(cells: pd.DataFrame) -> pd.DataFrame:
    """A row a block and method, most faces first; for each metric a column a data set, and the thesis's."""
    printed = cells.drop_duplicates([*BLOCK, "method", "metric"]).assign(data="thesis")
    printed["text"] = [number(ERRORS[row.metric][1] * row.thesis) for row in printed.itertuples()]
    cells = pd.concat([cells.assign(text=[marked(row) for row in cells.itertuples()]), printed])
    cells = cells.sort_values([*BLOCK, "method", "metric"], key=_rank, kind="stable")
    heads = [f"{ERRORS[metric][0]}, {data}" for metric, data in zip(cells["metric"], cells["data"], strict=True)]
    cells = cells.assign(head=heads, target=cells["block"], **{"kept points": cells["method"].map(label)})
    return wide(cells, ["target", "kept points"], "head").reset_index()


def _counted(cells: pd.DataFrame) -> str:
    """How many objects each block is over."""
    counts = cells.drop_duplicates(["data", *BLOCK]).sort_values(BLOCK, key=_rank, kind="stable")
    counts["objects"] = counts["objects"].astype(str) + " " + counts["data"]
    objects = counts.groupby("block", sort=False)["objects"].agg(", ".join)
    return "; ".join(f"{block}: {said}" for block, said in objects.items())


def _rank(column: pd.Series) -> pd.Series:
    """Places in the order of the table: most faces first, methods and metrics as they are listed."""
    orders = {"method": METHODS, "metric": METRICS}
    if column.name == "target":
        orders["target"] = sorted(set(column), key=size)
    return column.map(orders[column.name].index) if column.name in orders else column
