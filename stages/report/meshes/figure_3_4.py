"""T figure 3.4: errors of the simplified meshes by combination of channels and number of faces."""

from stages.report.items import Figure
from stages.report.results import NotRun, Results
from stages.report.style import CYCLE, plt, save

from .dots import draw_dots, dress
from .lod_detectors import short
from .rows import ERRORS, FEWEST, face_counts, said
from .table_3_1_5_combinations import ALIASES, COMBINATIONS, combined_cells

CLASSICAL = ALIASES["VisAtt"]
METRICS = ("metro_mean", "ssim_error")
SHOWN = 3  # face counts
ROW = 0.19  # inches a method


def build(results: Results) -> Figure:
    rows = combined_cells(results)
    methods = [method for method in COMBINATIONS if method in set(rows["method"])]
    if CLASSICAL not in methods or len(methods) < 2:
        raise NotRun("no two combinations of channels reach one face count on one object", "lod", runnable=False)
    targets = face_counts(rows)[:SHOWN]
    if not targets:
        raise NotRun(f"no face count that all combinations reach on {FEWEST} objects", "lod", runnable=False)
    count = len(METRICS) * len(targets)
    figure, panels = plt.subplots(1, count, figsize=(1.5 + 1.6 * count, 0.8 + ROW * len(methods)), sharey=True,
                                  squeeze=False)  # fmt: skip
    cells = [(metric, target) for metric in METRICS for target in targets]
    for axes, (metric, target) in zip(panels[0], cells, strict=True):
        here = rows[(rows["metric"] == metric) & (rows["target"] == target)]
        table = ERRORS[metric][1] * here.pivot(index="item", columns="method", values="value")
        draw_dots(axes, table, methods, CYCLE[METRICS.index(metric)], base=CLASSICAL)
    titles = [f"{ERRORS[metric][0]}\n{said(target)}" for metric, target in cells]
    dress(panels[0], titles, [short(method) for method in methods], methods)
    path = save(figure, results.reports / "figures/figure_3_4.png", dpi=100)
    objects = rows.groupby("target")["item"].nunique()
    over = ", ".join(f"{said(target)}: {objects[target]} objects" for target in targets)
    return Figure(
        "Figure 3.4: what each combination of channels does to the simplified mesh",
        f"Dots of the Metro and the SSIM error for {', '.join(map(short, methods))} at {len(targets)} face counts.",
        f"Mean over the objects on which every combination reaches the face count ({over}). Lines: 95 % interval of "
        f"the paired difference from {short(CLASSICAL)}, the classical model, drawn about the dot: where one covers "
        "the dashed line, the two are not told apart. Metro: % of the diagonal. Each panel has its own scale.",
        [path],
    )
