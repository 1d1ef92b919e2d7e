"""T figure 3.7: many, intermediate and few kept points on one object."""

from contextlib import suppress

from stages.report.drawing import show, square_grid
from stages.report.items import Figure
from stages.report.lod_cells import said, size
from stages.report.results import NotRun
from stages.report.style import save
from stages.report.tables.lod_detectors import short

METHODS = ("corners", "VisAttCurvSymCon", "heat_kernel")  # the thesis's: many, intermediate, few points
FACES = 1500  # the thesis's lower count; the nearest target that all three reach
ROWS = 330


def build(results):
    name, target = _shown(results)
    points = results.strong_points(name)
    figure, grid = square_grid(1, len(METHODS), side=2.9, gap=0.3)
    for axes, method in zip(grid[0], METHODS, strict=True):
        show(axes, dict(results.lods(name, method))[target], wires=True, rows=ROWS)
        title = f"{short(method)}: {len(points[method])} points"
        axes.set_title(title, fontsize=10, fontweight="normal", loc="center")
    path = save(figure, results.reports / "figures/figure_3_7.png", dpi=85)
    return Figure(
        "Figure 3.7: many, intermediate and few kept points",
        f"Wireframes of {name} at {said(target)} with the points of {', '.join(map(short, METHODS))} kept.",
        f"{name} at {said(target)}. Many points make clusters of small faces and starve the rest; few leave a mesh "
        "close to uniform simplification (T3.1.5). Where the points left too few faces, their neighbourhoods shrank.",
        [path],
    )


def _shown(results):
    """(object, target): the first figure object that all three methods simplified to one target."""
    wanted = [results.settings.hero_object, *results.settings.figure_objects]
    for name in results.choose(list(dict.fromkeys(wanted)), len(results.objects), stage="lod"):
        with suppress(NotRun):
            levels = [dict(results.lods(name, method)) for method in METHODS]
            common = sorted(set(levels[0]).intersection(*levels[1:]), key=size)
            if common:
                return name, min(common, key=lambda target: abs(len(levels[0][target].faces) - FACES))
    raise NotRun(f"no object simplified with the points of {', '.join(METHODS)}", "lod", runnable=False)
