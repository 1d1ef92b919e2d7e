"""T figure 3.7: many, intermediate and few kept points on one object."""

from contextlib import suppress

from stages.report.drawing import THIN, filled, show, square_grid
from stages.report.items import Figure
from stages.report.results import NotRun, Results
from stages.report.style import save

from .lod_detectors import short
from .rows import said, size

METHODS = ("corners", "VisAttCurvSymCon", "heat_kernel")  # the thesis's: many, intermediate, few points
FACES = 1500  # the thesis's lower count; the nearest target that all three reach
NEAR = 1.3  # times FACES, either way
ENOUGH = 2.0  # times as many points, from step to step: then the first object of the settings is taken
ROWS = 330


def build(results: Results) -> Figure:
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
    """(object, target): one with area for wires, on which the three differ most in points; of equals the first."""
    settings, scores = results.settings, {}
    wanted = list(dict.fromkeys([settings.hero_object, *settings.figure_objects, *settings.viewer_objects]))
    for name in results.choose(wanted, len(results.objects), stage="lod"):
        with suppress(NotRun):
            levels = [dict(results.lods(name, method)) for method in METHODS]
            common = sorted(set(levels[0]).intersection(*levels[1:]), key=size)
            if common:
                target = min(common, key=lambda target: abs(len(levels[0][target].faces) - FACES))
                near = 1 / NEAR < len(levels[0][target].faces) / FACES < NEAR
                scores[name, target] = near and filled(results.mesh(name)) > THIN, _apart(results.strong_points(name))
    if not scores:
        raise NotRun(f"no object simplified with the points of {', '.join(METHODS)}", "lod", runnable=False)
    return max(scores, key=scores.get)


def _apart(points):
    """The smaller of many over intermediate and intermediate over few points, up to ENOUGH."""
    many, middle, few = (len(points[method]) for method in METHODS)
    return min(many / max(middle, 1), middle / max(few, 1), ENOUGH)
