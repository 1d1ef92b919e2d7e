"""T3.1.5, T figure 3.4: the combinations of channels, and what each does to the simplified mesh."""

from contextlib import suppress

import pandas as pd

from stages.report.grid import means
from stages.report.items import Figure, Table
from stages.report.markdown import number
from stages.report.results import NotRun, Results
from stages.report.style import CYCLE, plt
from stages.salient_points import METHODS

from .dots import draw_dots, dress
from .methods import CLASSICAL, COMBINATIONS, short
from .rows import ERRORS, FEWEST, by_object, face_counts, paired_cells, said

DRAWN = ("metro_mean", "ssim_error")
SHOWN = 3  # face counts
ROW = 0.19  # inches a method


def table(results: Results) -> Table:
    """The combinations, their channels and the mean errors that each led to."""
    found = []
    with suppress(NotRun):  # the list is worth having without the errors
        found = means(paired_cells(results, methods=COMBINATIONS), ["method", "metric"])
    errors = pd.DataFrame(found, columns=["method", "metric", "mean"]).pivot(index="method", columns="metric")["mean"]
    metrics = [metric for metric in ERRORS if metric != "gaze_error" or metric in errors]
    channels = {short(method): ", ".join(METHODS[method].channels) for method in COMBINATIONS}
    frame = pd.DataFrame({"combination": channels.keys(), "channels": channels.values()})
    frame[metrics] = errors.reindex(COMBINATIONS, columns=metrics).to_numpy(dtype=float)
    shown = frame.copy()
    for metric in metrics:
        name, factor = ERRORS[metric]
        shown[metric] = (factor * frame[metric]).map(number).replace("–", "not run")
        shown = shown.rename(columns={metric: name})
    return Table(frame, shown)


def figure(results: Results) -> Figure:
    """Dots of the Metro and the SSIM error by combination, a panel for each face count."""
    rows = paired_cells(results, methods=COMBINATIONS)
    methods = [method for method in COMBINATIONS if method in set(rows["method"])]
    if CLASSICAL not in methods or len(methods) < 2:
        raise NotRun("no two combinations of channels reach one face count on one object", "lod", runnable=False)
    targets = face_counts(rows)[:SHOWN]
    if not targets:
        raise NotRun(f"no face count that all combinations reach on {FEWEST} objects", "lod", runnable=False)
    cells = [(metric, target) for metric in DRAWN for target in targets]
    size = (1.5 + 1.6 * len(cells), 0.8 + ROW * len(methods))
    drawing, panels = plt.subplots(1, len(cells), figsize=size, sharey=True, squeeze=False)
    for axes, (metric, target) in zip(panels[0], cells, strict=True):
        draw_dots(axes, by_object(rows, metric, target), methods, CYCLE[DRAWN.index(metric)], base=CLASSICAL)
    dress(panels[0], [f"{ERRORS[metric][0]}\n{said(target)}" for metric, target in cells], methods)
    objects = rows.groupby("target")["item"].nunique()
    words = {
        "methods": ", ".join(map(short, methods)), "counts": len(targets), "classical": short(CLASSICAL),
        "over": ", ".join(f"{said(target)}: {objects[target]} objects" for target in targets),
    }  # fmt: skip
    return Figure(drawing, words, dpi=100)
