"""T figure 3.22: meshes with the points of ED, SSIM and SVM kept, with fixed and with adaptive neighbourhoods."""

from contextlib import suppress

from stages.report.drawing import show, square_grid
from stages.report.items import Figure
from stages.report.results import NotRun, Results
from stages.report.style import label, save

from .rows import said, size

METHODS = [each for name in ("guided_ed", "guided_ssim", "svm") for each in (name, f"{name}-adaptive")]
OBJECTS = 2
FACES = 1500  # the thesis's lower count, or the nearest that all six reach
ROWS = 220


def build(results: Results) -> Figure:
    shown = _shown(results)
    figure, grid = square_grid(len(shown), len(METHODS), side=1.6, gap=0.15)
    for row, (name, target, levels) in zip(grid, shown, strict=True):
        for axes, method in zip(row, METHODS, strict=True):
            show(axes, levels[method], wires=True, rows=ROWS)
        row[0].text(-0.02, 0.5, f"{name}\n{said(target)}", rotation=90, va="center", ha="right", fontsize=9,
                    transform=row[0].transAxes)  # fmt: skip
    for axes, method in zip(grid[0], METHODS, strict=True):
        axes.set_title(label(method).replace(", ", ",\n"), fontsize=9.5, fontweight="normal", loc="center")
    path = save(figure, results.reports / "figures/figure_3_22.png", dpi=85)
    names = " and ".join(name for name, *_ in shown)
    return Figure(
        "Figure 3.22: fixed and adaptive neighbourhoods",
        f"Wireframes of {names} with the points of ED, SSIM and SVM kept, each with fixed and adaptive neighbourhoods.",
        "Fixed: three rings about each point; adaptive: one to three, fewer where the mesh is dense (T eq. 3.17). "
        "Weights and SVM were learned from the other objects.",
        [path],
    )


def _shown(results):
    """Up to OBJECTS of (name, target, dict method -> Mesh), of those that all methods simplified to one target."""
    found = []
    for name in results.choose(results.settings.figure_objects, len(results.objects), stage="lod"):
        with suppress(NotRun):
            levels = {method: dict(results.lods(name, method)) for method in METHODS}
            common = sorted(set.intersection(*(set(meshes) for meshes in levels.values())), key=size)
            if common:
                first = levels[METHODS[0]]
                target = min(common, key=lambda target: abs(len(first[target].faces) - FACES))
                found.append((name, target, {method: meshes[target] for method, meshes in levels.items()}))
        if len(found) == OBJECTS:
            break
    if not found:
        raise NotRun(f"no object simplified by all of {', '.join(METHODS)}", "lod", runnable=False)
    return found
