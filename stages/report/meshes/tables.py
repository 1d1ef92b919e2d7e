"""Tables of the objects and of the errors by method: T3.1.5's combinations, every detector, and T table 3.2."""

from collections.abc import Iterator
from contextlib import suppress

import numpy as np
import pandas as pd

from haptic_glance.look.points import METHODS
from stages.report.grid import means
from stages.report.items import Table
from stages.report.markdown import number
from stages.report.ranking import Ranking
from stages.report.results import SECTION_3_1, SECTION_3_2, NotRun, Results, some
from stages.report.style import label
from stages.report.words import dataset_text

from .methods import COMBINATIONS, FIXED_ADAPTIVE, HKS, OF_T3_2, OURS, PLAIN, QSLIM, WEIGHTED, ordered, short
from .rows import ERRORS, FEWEST, METRICS, UNITS, cell, compared, data_sets, face_counts, paired_cells, said, size, wide

COUNTS = ["points", "kept"]  # beside the errors of every detector
GUIDED = [*FIXED_ADAPTIVE, "thesis_ed", "thesis_ed-adaptive", WEIGHTED, f"{WEIGHTED}-adaptive", "VisAttAll", HKS,
          OURS, PLAIN, QSLIM]  # fmt: skip
THESIS = {"guided_ed": "ed", "thesis_ed": "ed", "guided_ssim": "ssim", WEIGHTED: "ssim", "svm": "svm"}
BLOCK = ["target", "nothing_shrunk"]
KEEP_NOTHING = [label(PLAIN), label(QSLIM)]  # what the others are held against


def dataset(results: Results) -> Table:
    """What the run was made of: one row per object of the first data set, and what was refused."""
    manifest, refused = (results.table("meshes", f"{name}.csv") for name in ("manifest", "refused"))
    frame = manifest.filter(["object", "vertices", "faces", "parts", "watertight", "repairs", "licence"])
    named = "; ".join(f"{row.object} ({row.reason})" for row in refused.itertuples())
    words = {
        "count": len(frame), "least": frame["faces"].min(), "most": frame["faces"].max(),
        "closed": frame["watertight"].sum(), "refused": f"Refused: {named}." if named else "No mesh was refused.",
    }  # fmt: skip
    shown = frame.fillna("").assign(watertight=frame["watertight"].map({True: "yes", False: "no"}))
    return Table(frame, shown, words)  # no ranking: objects do not compete


def combinations(results: Results) -> Table:
    """The combinations of channels, in the thesis's order, and the mean errors that each led to."""
    found = []
    with suppress(NotRun):  # the list is worth having without the errors
        rows = paired_cells(results, methods=COMBINATIONS, dataset=results.printed(SECTION_3_1, "lod"))
        found = means(rows, ["method", "metric"])
    found = pd.DataFrame(found, columns=["method", "metric", "mean"])
    errors = found.pivot(index="method", columns="metric", values="mean")
    metrics = [metric for metric in ERRORS if metric in errors] or list(METRICS)
    channels = [", ".join(map(label, METHODS[method].channels)) for method in COMBINATIONS]
    frame = pd.DataFrame({"combination": map(short, COMBINATIONS), "channels": channels})
    frame[metrics] = errors.reindex(COMBINATIONS, columns=metrics).to_numpy(dtype=float)
    shown = {metric: (UNITS[metric] * frame[metric]).map(number).replace("–", "not run") for metric in metrics}
    return Table(frame, frame.assign(**shown).rename(columns=ERRORS), best=Ranking(ERRORS[metrics[0]], lowest=True))


def every_detector(results: Results) -> Table:
    """Errors and numbers of points of every method, on every data set."""
    found = {dataset_text(name): paired_cells(results, dataset=name) for name in data_sets(results)}
    found = {data: rows for data, rows in found.items() if PLAIN in set(rows["method"])}
    some(found, "no face count that plain QEM and all other methods reach on one object", "lod", runnable=False)
    parts = {data: _by_method(rows) for data, rows in found.items()}
    frame = pd.concat(parts, names=["data", None]).reset_index("data")
    frame.insert(3, "objects", frame.pop("objects"))
    counts = ", ".join(f"{rows['item'].nunique()} {data}" for data, rows in found.items())
    shown, own = _methods_wide(frame), [ERRORS[name] for name in (*METRICS, "salient_error")]
    own = [name for name in map(str, shown) if name in own or name in COUNTS or name.startswith(ERRORS["gaze_error"])]
    best = Ranking(ERRORS[METRICS[0]], lowest=True, exempt=KEEP_NOTHING)
    return Table(frame, shown, {"counts": counts}, best, ["kept points", *own])


def _by_method(rows: pd.DataFrame) -> pd.DataFrame:
    """A row a method and metric, COUNTS among them: over the objects, each by its mean over the targets."""
    counts = [rows.assign(metric=name, value=rows[name], plain=np.nan) for name in COUNTS if name in rows]
    keys = ["item", "method", "metric"]
    objects = pd.concat([rows, *counts]).groupby(keys, sort=False)[["value", "plain"]].mean().reset_index()
    frame = compared(objects, keys[1:], least=-np.inf).set_index("method")
    return frame.loc[ordered(frame.index.unique())].reset_index()


def _methods_wide(frame: pd.DataFrame) -> pd.DataFrame:
    own = frame["data"] == frame["data"].iloc[0]
    cells = frame[own | frame["metric"].isin([*METRICS, "gaze_error"])]  # of the further data sets these alone
    cells = cells.sort_values("metric", key=lambda metric: metric.isin(ERRORS), kind="stable")  # the counts come first
    texts = [cell(row) if row.metric in ERRORS else f"{row.mean:.1f}" for row in cells.itertuples()]
    names = cells["metric"].replace(ERRORS)
    heads = names.where(cells["data"] == frame["data"].iloc[0], names + ", " + cells["data"])
    found = wide(cells.assign(text=texts, head=heads), "method", "head")
    return found.loc[ordered(found.index)].rename(short).reset_index(names="kept points")


def table_3_2(results: Results) -> Table:
    """Errors by method and face count, on all objects and where nothing shrank, beside the thesis's."""
    parts = some(list(_parts(results)), "no face count that all methods of the table reach", "lod", runnable=False)
    frame = compared(pd.concat(parts), ["data", "nothing_shrunk", "target", "method", "metric"])
    thesis = results.thesis("table_3_2_lod_errors").melt(["method", "faces"], METRICS, "metric", "thesis")
    thesis = thesis.rename(columns={"method": "printed", "faces": "target"}).astype({"target": str})
    frame = frame.assign(printed=frame["method"].map(THESIS)).merge(thesis, "left").drop(columns="printed")
    orders = {"target": sorted(set(frame["target"]), key=size), "method": GUIDED, "metric": METRICS}
    cells = frame.assign(block=frame["target"].map(said) + np.where(frame["nothing_shrunk"], ", nothing shrunk", ""))
    cells = cells.assign(**{name: pd.Categorical(frame[name], order) for name, order in orders.items()})
    counts = cells.drop_duplicates(["data", *BLOCK]).sort_values(BLOCK)
    objects = (counts["objects"].astype(str) + " " + counts["data"]).groupby(counts["block"], sort=False)
    over = "; ".join(f"{block}: {sets}" for block, sets in objects.agg(", ".join).items())
    shown = _blocks_wide(cells)
    answer = [name for name in map(str, shown) if not name.startswith(ERRORS[METRICS[1]])]  # the first error alone
    best = Ranking(next(name for name in answer[2:] if not name.endswith("thesis")), True, ["target"], KEEP_NOTHING)
    return Table(frame, shown, {"objects": over, "fewest": FEWEST}, best, answer)


def _parts(results: Results) -> Iterator[pd.DataFrame]:
    """Rows of each data set, with all cells and, where they are fewer, with those in which nothing shrank."""
    for name in sorted(data_sets(results, OF_T3_2), key=lambda name: name != SECTION_3_2):
        every = np.inf
        for whole in (False, True):
            rows = paired_cells(results, METRICS, GUIDED, name, whole)
            rows = rows[rows["target"].isin(face_counts(rows))]
            if 0 < len(rows) < every:
                yield rows.assign(data=dataset_text(name), nothing_shrunk=whole)
            every = len(rows)


def _blocks_wide(cells: pd.DataFrame) -> pd.DataFrame:
    """A row a block and method, most faces first; for each metric the set as printed, the thesis's, the other sets."""
    printed = cells.drop_duplicates([*BLOCK, "method", "metric"]).assign(data="thesis")
    printed["text"] = (printed["metric"].map(UNITS).astype(float) * printed["thesis"]).map(number)
    cells = pd.concat([cells.assign(text=[cell(row) for row in cells.itertuples()]), printed])
    cells = cells.sort_values([*BLOCK, "method", "metric"], ignore_index=True)
    cells["head"] = cells["metric"].map(ERRORS).astype(str) + ", " + cells["data"]
    cells["kept points"] = cells["method"].map(label)
    found = wide(cells, ["block", "kept points"], "head")
    sets = sorted(cells["data"].unique(), key=[dataset_text(SECTION_3_2), "thesis"].__contains__, reverse=True)
    found = found[[f"{ERRORS[metric]}, {data}" for metric in METRICS for data in sets]]
    return found.reset_index(names=["target", "kept points"])
