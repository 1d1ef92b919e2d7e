"""Tables of the objects and the errors of simplified meshes (T3.1.5, T table 3.2, T figure 3.6).

Errors are compared on the same objects and targets only. The constants hold the methods' groups,
short names and the order of T figure 3.6.
"""

from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from typing import Any

import numpy as np
import pandas as pd

from haptic_glance.look.points.methods import METHODS, PLUS, SUMS
from haptic_glance.look.weights.weights import GLANCE
from stages.charts.datasets import ON_GREY, ON_WHITE, SECTION_3_1, SECTION_3_2, dataset_text
from stages.charts.drawing import WAYS, label
from stages.charts.items import Table, shared_notes
from stages.charts.results import OWN_FOLDER, NotRun, Results, require_rows
from stages.charts.tables import Ranking, grouped, means, number, over_items, records, with_interval, within
from stages.engine.measurements import either
from stages.engine.statistics import interval

CELL = ["item", "target"]
ERRORS = {  # metric -> name, with its unit
    "metro_mean": "Metro mean, %", "metro_rms": "Metro rms, %", "metro_max": "Metro max, %",
    "ssim_error": "1 − SSIM, %", "dlap": "DLap", "dnor": "Dnor",
    "salient_error": "error where our model looks, %", "gaze_error": "error where people look, %",
}  # fmt: skip
UNITS = {metric: 100 if name.endswith("%") else 1 for metric, name in ERRORS.items()}  # factors to the unit
METRICS = ("metro_mean", "ssim_error")  # those of the thesis's figures
LOOKED_AT = ("salient_error", "gaze_error")  # weighed by where our model looks, and people
MINUS = "minus plain QEM"
FEWEST = 3  # objects that a mean over objects needs to be shown


def rows_by_set(results: Results, methods: Iterable[str] = ()) -> dict[str, pd.DataFrame]:
    """{set: its rows of lod} where any of these methods (none: any) simplified meshes, those switched on first.

    Without the sets of one method on other backgrounds.
    """
    wanted = {*methods}
    rows = {name: results.rows("lod", name) for name in results.datasets("lod") if name not in (ON_GREY, ON_WHITE)}
    require_rows(rows, "no measurements of lod", "lod")
    rows = {name: part for name, part in rows.items() if not wanted or wanted & {*part["method"].replace(UNSEEN)}}
    return require_rows(rows, f"no mesh was simplified by {either([*wanted])}", "lod", runnable=False)


def paired_cells(
    rows: pd.DataFrame, metrics: Iterable[str] = ERRORS, methods: Iterable[str] | None = None, whole: bool = False
) -> pd.DataFrame:
    """Rows of these errors and methods (None: of all but sums), only where all that were run reach the target.

    `seconds` is the simplification's; `plain` the value of plain QEM for the same object, target and metric. whole:
    only where, moreover, no method had to shrink its neighbourhoods: the thesis's own algorithm. Methods that have
    learned from the object itself, as printed, have the names of those that have not.
    """
    rows = rows[rows["metric"].isin([*metrics, "faces"])].dropna(subset=["value"])
    rows = rows.assign(method=rows["method"].replace(UNSEEN))
    times = rows.loc[rows["metric"] == "faces", [*CELL, "method", "seconds"]]
    rows = rows[rows["metric"] != "faces"].drop(columns="seconds")
    plain = rows[rows["method"] == PLAIN].rename(columns={"value": "plain"})[[*CELL, "metric", "plain"]]
    sums = rows["method"].str.contains(PLUS + SUMS, regex=False)
    asked = rows["method"].isin(list(methods)) if methods is not None else ~sums
    rows = rows[asked]
    rows = rows.merge(times, on=[*CELL, "method"]).merge(plain, on=[*CELL, "metric"], how="left")
    methods_met = rows["method"].mask(rows["shrunk"].fillna(False).astype(bool)) if whole else rows["method"]
    method_counts = rows.assign(method=methods_met).groupby([*CELL, "metric"])["method"].transform("nunique")
    return rows[method_counts == rows["method"].nunique()]


def compared(rows: pd.DataFrame, by: list[str], least: float = 0.0) -> pd.DataFrame:
    """Mean, its interval from `least` on, and mean difference from `plain`, over the objects of each value of `by`."""
    lines = []
    for key, group in grouped(rows, by):
        values = over_items(group)
        gain = interval(values - group["plain"].to_numpy())
        lines.append((*key, *within(values, least=least, top=np.inf), values.count(), *gain))
    ends = ["mean", "low", "high", "objects", "over_plain", "over_plain_low", "over_plain_high"]
    return pd.DataFrame(lines, columns=[*by, *ends])


def by_object(rows: pd.DataFrame, methods: list[str], metric: str, target: str | None = None) -> pd.DataFrame:
    """Frame objects x methods of one error in its unit; target: at this one alone, or the mean over all."""
    rows = rows[(rows["metric"] == metric) & (rows["target"].eq(target) if target else True)]
    return UNITS[metric] * rows.pivot_table(index="item", columns="method", values="value").reindex(columns=methods)


def face_counts(rows: pd.DataFrame) -> list[str]:
    """The targets of the rows with enough objects, most faces first: counts, or shares where there are no counts."""
    objects = rows.groupby("target")["item"].nunique()
    frequent = sorted(objects.index[objects >= FEWEST], key=size)
    return [target for target in frequent if target.isdigit()] or frequent


def wide(cells: pd.DataFrame, down: str | list[str], across: str) -> pd.DataFrame:
    """Column `text` pivoted, rows and columns in the order of the cells; `–` where there is none."""
    table = cells.pivot(index=down, columns=across, values="text").rename_axis(columns=None)
    return table.reindex(cells.set_index(down).index.unique(), columns=cells[across].unique()).fillna("–")


def error_text(row: Any) -> str:
    """An error with its interval."""
    return with_interval(row.mean, row.low, row.high, UNITS[row.metric])


def over_plain(rows: pd.DataFrame) -> pd.Series:
    """The difference of the first errors of METRICS from plain QEM, with its interval; a dash where there is none."""
    texts = [
        ("+" if row.over_plain > 0 else "")
        + with_interval(row.over_plain, row.over_plain_low, row.over_plain_high, UNITS[row.metric])
        if row.over_plain == row.over_plain and row.over_plain
        else "–"
        for row in records(rows)
    ]
    return pd.Series(texts, rows.index)


def size(target: str) -> tuple[bool, float]:
    """A key that sorts targets: shares before counts, large before small."""
    return (not target.endswith("%"), -float(target.rstrip("%")))


def target_text(target: str) -> str:
    """A target in words: `25%`, `1,500 faces`."""
    return target if target.endswith("%") else f"{int(target):,} faces"


PLAIN, QSLIM, OURS = "qem", "qslim", GLANCE  # QSLIM: plain QEM without the fit of ours, the thesis's
CLASSICAL = "itti"  # the classical model, VisAtt in the thesis
WEIGHTED = "thesis_ssim"  # the thesis's own: the average weighted with its SSIM weights
HKS = "heat_kernel"
COMBINATIONS = (  # of channels, as the stages call them, in the order of T3.1.5
    CLASSICAL, "VisAttCurvP", "VisAttCurv", "Curv", "VisAttSymP", "VisAttSym", "SymLat", "SymRad", "2Sym",
    "VisAttCurvSym", "VisAttCon", "VisAttCurvSymCon", "VisAttEnt", "VisAttAll",
)  # fmt: skip
# T2.2.3's detectors but the heat kernel signature, which T3.1.5 takes out of the claim ("except HKS approach").
RIVALS = ("salient_points", "mesh_saliency", "sift", "harris", "corners")
PROPOSED = ("guided_ed", "guided_ssim", "svm")  # T3.2.9: ED, SSIM, SVM, learned from other objects than the simplified
PRINTED = ("guided_ed+seen", "guided_ssim+seen", "svm+object")  # the same, learned from that object too, as printed
ADAPTIVE = tuple(f"{name}-adaptive" for name in PROPOSED)
PRINTED_ADAPTIVE = tuple(f"{name}-adaptive" for name in PRINTED)
UNSEEN = dict(zip(PRINTED + PRINTED_ADAPTIVE, PROPOSED + ADAPTIVE, strict=True))
OF_T3_2 = (*PROPOSED, OURS)  # by which the sets of T3.2 are known
FIXED_ADAPTIVE = tuple(name for pair in zip(PROPOSED, ADAPTIVE, strict=True) for name in pair)
NAMES = {  # short, the thesis's, in the order of its figure 3.6; then those of later sections, ours and chance
    "harris": "3DH", "mesh_saliency": "MS", "salient_points": "SP", "corners": "SDC", "sift": "3DS",
    "VisAttCurvP": "VisAttCurvP", "VisAttAll": "VisAttAll", "VisAttSymP": "VisAttSymP", "VisAttEnt": "VisAttEnt",
    "Curv": "Curv", "VisAttCurv": "VisAttCurv", "VisAttCurvSym": "VisAttCurvSym", "VisAttSym": "VisAttSym",
    "VisAttCurvSymCon": "VisAttCurvSymCon", CLASSICAL: "VisAtt", "VisAttCon": "VisAttCon", "2Sym": "2Sym",
    "SymLat": "SymLat", HKS: "HKS", "SymRad": "SymRad", "guided_ed": "ED", "guided_ssim": "SSIM",
    WEIGHTED: label(WEIGHTED), "thesis_ed": label("thesis_ed"), "svm": "SVM", OURS: label(OURS), "random": "blind",
}  # fmt: skip


def fixed(method: str) -> bool:
    """Whether a method keeps neighbourhoods of fixed size: no way of keeping them stands behind its name."""
    return method.rpartition("-")[2] not in WAYS


def is_drawn(method: str) -> bool:
    """Whether a method is one of T figure 3.5, or beside these: fixed neighbourhoods, and maps that are no sums."""
    return fixed(method) and PLUS + SUMS not in method


def short(method: str) -> str:
    """The thesis's short name of a method."""
    base, _, way = method.rpartition("-")
    return NAMES.get(method, label(method)) if fixed(method) else f"{short(base)}, {way}"


def ordered(methods: Iterable[str]) -> list[str]:
    """The methods in the thesis's order (figure 3.6), then those with a way behind their name, QEM last."""
    order = [*NAMES, *(f"{name}-{way}" for name in NAMES for way in WAYS)]
    plain = [PLAIN, QSLIM]
    return sorted(methods, key=lambda name: (name in plain, order.index(name) if name in order else len(order), name))


COUNTS = ["points", "kept"]  # beside the errors of every detector
GUIDED = [*FIXED_ADAPTIVE, "thesis_ed", "thesis_ed-adaptive", WEIGHTED, f"{WEIGHTED}-adaptive", "VisAttAll", HKS,
          OURS, PLAIN, QSLIM]  # fmt: skip
THESIS = {"guided_ed": "ed", "thesis_ed": "ed", "guided_ssim": "ssim", WEIGHTED: "ssim", "svm": "svm"}


def combinations(results: Results) -> Table:
    """The combinations of channels, in the thesis's order, and the mean errors that each led to."""
    if results.own_meshes:
        raise NotRun("the combinations of T3.1.5 are judged on the project's own data sets", OWN_FOLDER, runnable=False)
    averages, reached = [], ""
    with suppress(NotRun):  # the list is worth having without the errors
        rows = paired_cells(results.rows("lod", results.printed(SECTION_3_1, "lod")), methods=COMBINATIONS)
        averages = means(rows, ["method", "metric"])
        counts = rows.groupby("target")["item"].nunique()
        reached = ": " + ", ".join(f"{counts[name]} at {target_text(name)}" for name in sorted(counts.index, key=size))
    averages = pd.DataFrame(averages, columns=["method", "metric", "mean"])
    errors = averages.pivot(index="method", columns="metric", values="mean")
    metrics = [metric for metric in ERRORS if metric in errors] or list(METRICS)
    channels = [", ".join(map(label, METHODS[method].channels)) for method in COMBINATIONS]
    frame = pd.DataFrame({"combination": map(short, COMBINATIONS), "channels": channels})
    frame[metrics] = errors.reindex(COMBINATIONS, columns=metrics).to_numpy(dtype=float)
    columns = {metric: (UNITS[metric] * frame[metric]).map(number).replace("–", "not run") for metric in metrics}
    text_table, best = frame.assign(**columns).rename(columns=ERRORS), Ranking(ERRORS[metrics[0]], lowest=True)
    return Table(frame, text_table, {"reached": reached}, best)


def every_detector(results: Results) -> Table:
    """Errors and numbers of points of every method, on every data set."""
    by_set = {dataset_text(name): paired_cells(rows) for name, rows in rows_by_set(results).items()}
    by_set = {data: rows for data, rows in by_set.items() if PLAIN in set(rows["method"])}
    require_rows(
        by_set, "no face count that plain QEM and all other methods reach on one object", "lod", runnable=False
    )
    parts = {data: _by_method(rows) for data, rows in by_set.items()}
    frame = pd.concat(parts, names=["data", None]).reset_index("data")
    frame.insert(3, "objects", frame.pop("objects"))
    counts = ", ".join(f"{rows['item'].nunique()} {data}" for data, rows in by_set.items())
    texts, errors = _methods_wide(frame), [ERRORS[METRICS[0]], ERRORS[METRICS[1]], *map(ERRORS.get, LOOKED_AT)]
    answer = ["kept points", "points", ERRORS[METRICS[0]], MINUS, *errors[1:]]
    best = Ranking(errors, lowest=True)
    note = shared_notes(__package__, "gaze") if not results.own_meshes else ""
    return Table(frame, texts, {"counts": counts, "gaze": note}, best, answer, split="objects")


def _by_method(rows: pd.DataFrame) -> pd.DataFrame:
    """A row a method and metric, COUNTS among them: over the objects, each by its mean over the targets."""
    counts = [rows.assign(metric=name, value=rows[name], plain=np.nan) for name in COUNTS if name in rows]
    keys = ["item", "method", "metric"]
    objects = pd.concat([rows, *counts]).groupby(keys, sort=False)[["value", "plain"]].mean().reset_index()
    frame = compared(objects, keys[1:], least=-np.inf).set_index("method")
    return frame.loc[ordered(frame.index.unique())].reset_index()


def _methods_wide(frame: pd.DataFrame) -> pd.DataFrame:
    """A row a data set and method, with each error, and the difference of the first from plain QEM."""
    texts = [error_text(row) if row.metric in ERRORS else f"{row.mean:.1f}" for row in records(frame)]
    cells = frame.assign(text=texts, head=frame["metric"].replace(ERRORS))
    cells = cells.sort_values("metric", key=lambda metric: metric.isin(ERRORS), kind="stable")
    table = wide(cells, ["data", "method"], "head")
    table.insert(0, MINUS, over_plain(frame[frame["metric"] == METRICS[0]].set_index(["data", "method"])))
    table = table.reindex(list(frame[["data", "method"]].drop_duplicates().itertuples(index=False, name=None)))
    return table.rename(short, level="method").reset_index(names=["objects", "kept points"])


def table_3_2(results: Results) -> Table:
    """Errors by method and face count, on all objects and where nothing shrank, beside the thesis's."""
    rows, thesis = rows_by_set(results, OF_T3_2), results.thesis("table_3_2_lod_errors")
    parts = list(_parts(rows))
    if not parts:
        raise NotRun("no face count that all methods of the table reach", "lod", runnable=False)
    frame = compared(pd.concat(parts), ["data", "nothing_shrunk", "target", "method", "metric"])
    thesis = thesis.melt(["method", "faces"], METRICS, "metric", "thesis")
    thesis = thesis[:0] if results.own_meshes else thesis
    thesis = thesis.rename(columns={"method": "printed", "faces": "target"}).astype({"target": str})
    frame = frame.assign(printed=frame["method"].map(THESIS)).merge(thesis, "left").drop(columns="printed")
    text_table, errors = _blocks_wide(frame), [ERRORS[name] for name in METRICS]
    words = {"objects": _objects(frame), "fewest": FEWEST, "beside": "", "printed": ""}
    if not results.own_meshes:
        words |= {"beside": ", beside the thesis", "printed": shared_notes(__package__, "printed_3_2")}
    return Table(frame, text_table, words, Ranking(errors, True, ["faces"]), split="objects")


def _objects(frame: pd.DataFrame) -> str:
    """The least and the most objects of each view of table 3.2."""
    counts = frame.groupby(_view(frame), sort=False)["objects"].agg(["min", "max"])
    return "; ".join(f"{row.Index}: {' to '.join(map(str, sorted({row.min, row.max})))}" for row in records(counts))


def _parts(by_set: Mapping[str, pd.DataFrame]) -> Iterator[pd.DataFrame]:
    """Rows of each data set, with all cells and, where they are fewer, with those in which nothing shrank."""
    for name in sorted(by_set, key=lambda name: name != SECTION_3_2):
        total = np.inf
        for whole in (False, True):
            rows = paired_cells(by_set[name], METRICS, GUIDED, whole)
            rows = rows[rows["target"].isin(face_counts(rows))]
            if 0 < len(rows) < total:
                yield rows.assign(data=dataset_text(name), nothing_shrunk=whole)
            total = len(rows)


def _view(frame: pd.DataFrame) -> pd.Series:
    """The data set of each row, and whether no neighbourhood shrank on its objects."""
    return frame["data"] + np.where(frame["nothing_shrunk"], ", nothing shrunk", "")


def _blocks_wide(frame: pd.DataFrame) -> pd.DataFrame:
    """A row a view, face count and method, most faces first; for each error the difference and the thesis's beside."""
    keys = ["view", "target", "method"]
    cells = frame.assign(view=pd.Categorical(_view(frame), list(dict.fromkeys(_view(frame)))))
    orders = {"target": sorted(set(frame["target"]), key=size), "method": GUIDED}
    cells = cells.assign(**{name: pd.Categorical(frame[name], order) for name, order in orders.items()})
    parts = {}
    for metric in METRICS:
        rows = cells[cells["metric"] == metric].sort_values(keys).set_index(keys)
        name = ERRORS[metric].removesuffix(", %")
        parts[ERRORS[metric]] = pd.Series([error_text(row) for row in records(rows)], rows.index)
        parts[f"{name} {MINUS}"] = over_plain(rows)
        if frame["thesis"].notna().any():
            parts[f"{name}, thesis, %"] = (UNITS[metric] * rows["thesis"]).map(number)
    table = pd.DataFrame(parts).reset_index().astype({name: str for name in keys})
    table = table.assign(target=table["target"].map(target_text), method=table["method"].map(label)).fillna("–")
    return table.rename(columns={"view": "objects", "target": "faces", "method": "kept points"})
