"""T figure 3.21: one object at falling face counts, by plain QEM above and with salient neighbourhoods kept below."""

from contextlib import suppress

from stages.report.drawing import THIN, filled, show, square_grid
from stages.report.items import Figure
from stages.report.results import NotRun, Results
from stages.report.style import GREY, label, save

from .rows import PLAIN, size

METHODS = (PLAIN, "enhanced")
LEVELS = 3  # the thesis shows 3,000, 1,500 and 500 faces
ROWS = 300


def build(results: Results) -> Figure:
    name, targets = _most_levels(results)
    levels = {method: dict(results.lods(name, method)) for method in METHODS}
    points = results.strong_points(name)[METHODS[1]]
    original = results.mesh(name)
    figure, grid = square_grid(2, len(targets) + 1, side=2.0, gap=0.3)
    show(grid[0, 0], original, rows=ROWS)
    show(grid[1, 0], original, points=points, rows=ROWS)
    grid[0, 0].set_title(f"original\n{len(original.faces):,} faces", fontsize=10, fontweight="normal", loc="center")
    for down, method in enumerate(METHODS):
        grid[down, 0].text(-0.04, 0.5, label(method), rotation=90, va="center", ha="right",
                           transform=grid[down, 0].transAxes)  # fmt: skip
        for across, target in enumerate(targets, start=1):
            _level(grid[down, across], levels[method].get(target))
    path = save(figure, results.reports / "figures/figure_3_21.png", dpi=85)
    return Figure(
        "Figure 3.21: fine where one looks, coarse elsewhere",
        f"Wireframes of {name}: the original and {len(targets)} simplified meshes, by plain QEM above and with salient "
        "neighbourhoods kept below.",
        "Red: the salient points whose neighbourhoods the lower row keeps; where they left too few faces, the "
        "neighbourhoods shrank from the least salient point on.",
        [path],
    )


def _most_levels(results):
    """(object, targets): one with area for wires, and the most targets within reach of kept points."""
    settings = results.settings
    wanted = list(dict.fromkeys([settings.hero_object, *settings.figure_objects, *settings.viewer_objects]))
    scores = {}
    for name in results.choose(wanted, len(wanted), stage="lod"):
        with suppress(NotRun):
            kept = [target for target, _ in results.lods(name, METHODS[1])]
            targets = [target for target, _ in results.lods(name, METHODS[0])]
            counts = sorted((target for target in targets if target.isdigit()), key=size)
            shown = (counts if len(counts) > 1 else sorted(targets, key=size))[:LEVELS]
            scores[name] = (filled(results.mesh(name)) > THIN, len(set(shown) & set(kept))), shown
    if not scores:
        raise NotRun(f"no simplified mesh with the points of {METHODS[1]} kept", "lod")
    name = max(scores, key=lambda name: scores[name][0])
    return name, scores[name][1]


def _level(axes, mesh):
    """One simplified mesh, or what stands in its place where the kept faces leave too few others."""
    if mesh is None:
        axes.set_axis_off()
        words = "out of reach:\nthe kept neighbourhoods\nleave too few faces"
        axes.text(0.5, 0.5, words, ha="center", va="center", color=GREY, transform=axes.transAxes)
        return
    axes.set_title(f"{len(mesh.faces):,} faces", fontsize=10, fontweight="normal", loc="center")
    show(axes, mesh, wires=True, rows=ROWS)
