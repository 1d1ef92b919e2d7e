"""T figure 3.5: every detector and combination of channels by all errors and by the number of points."""

from matplotlib.ticker import FuncFormatter

from stages.report.items import Figure
from stages.report.results import NotRun, Results
from stages.report.style import CYCLE, WAYS, plt, save

from .dots import draw_dots, dress
from .lod_detectors import ordered, short
from .rows import ERRORS, PLAIN, cells, face_counts, paired_cells, said

SPREAD = {"metro_mean": "mean", "metro_rms": "rms", "metro_max": "max"}
SEEN = ("ssim_error", "dlap", "dnor")
COUNTS = 2  # face counts of panel b: the most, and the next
ROW = 0.185  # inches a method
APART = (-0.24, 0.0, 0.24)  # rows between the dots of one method in one panel
TITLES = ["(a) Metro, %", "(b) Metro mean, %", "(c) 1 − SSIM, %", "(d) DLap", "(e) Dnor", "(f) points"]


def build(results: Results) -> Figure:
    metrics = list(ERRORS)
    fixed = [method for method in set(cells(results, metrics)["method"]) if method.rpartition("-")[2] not in WAYS]
    rows = paired_cells(results, metrics, fixed)
    methods = ordered(set(rows["method"]))
    if PLAIN not in methods or len(methods) < 3:
        raise NotRun("no face count that plain QEM and two other methods reach", "lod", runnable=False)
    shown = face_counts(rows)[:COUNTS]
    figure, panels = plt.subplots(1, 6, figsize=(11.4, 1.1 + ROW * len(methods)), sharey=True)
    _draw(panels, rows, methods, shown)
    dress(panels, TITLES, [short(method) for method in methods], methods, pad=20)
    path = save(figure, results.reports / "figures/figure_3_5.png", dpi=100)
    objects = {target: rows.loc[rows["target"] == target, "item"].nunique() for target in shown}
    over = ", ".join(f"{count} at {said(target)}" for target, count in objects.items())
    return Figure(
        "Figure 3.5: every detector by the errors of the mesh that keeps its points",
        f"Six panels of dots, one row each for {', '.join(map(short, methods))}: Metro mean, rms and max; Metro mean "
        "by face count; SSIM error; Laplacian and normalised Laplacian distance; number of points.",
        f"(a), (c) to (e): mean over {rows['item'].nunique()} objects and all face counts that every method "
        f"reaches; (b): objects: {over}. Metro: % of the diagonal. Lines: 95 % interval of the paired difference from "
        "plain QEM, drawn about the dot: where one covers the dashed line, the two are not told apart. (f): points "
        "past the method's own threshold, with the interval of the mean. Blue name: ours.",
        [path],
    )


def _draw(panels, rows, methods, counts):
    """The six panels. counts: the face counts of panel b."""
    known = set(rows["metric"])
    spread = {metric: name for metric, name in SPREAD.items() if metric in known}
    for (metric, name), tint, down in zip(spread.items(), CYCLE, APART, strict=False):
        draw_dots(panels[0], _table(rows, metric), methods, tint, PLAIN, name, down)
    for target, tint, down in zip(counts, CYCLE[3:], APART, strict=False):
        table = _table(rows[rows["target"] == target], "metro_mean")
        draw_dots(panels[1], table, methods, tint, PLAIN, said(target).removesuffix(" faces"), down)
    for axes, metric in zip(panels[2:5], SEEN, strict=True):
        if metric in known:
            draw_dots(axes, _table(rows, metric), methods, CYCLE[0], PLAIN)
    points = rows.pivot_table(index="item", columns="method", values="points")
    draw_dots(panels[5], points, methods, CYCLE[0])
    panels[0].set_xscale("log")
    panels[0].xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    for axes in panels[:2]:
        if axes.get_legend_handles_labels()[0]:
            axes.legend(loc="lower center", bbox_to_anchor=(0.5, 0.99), ncols=3, fontsize=8, handletextpad=0,
                        columnspacing=0.6, borderpad=0.2)  # fmt: skip


def _table(rows, metric):
    """Frame objects x methods of one error in its unit, mean over the face counts."""
    here = rows[rows["metric"] == metric]
    return ERRORS[metric][1] * here.pivot_table(index="item", columns="method", values="value")
