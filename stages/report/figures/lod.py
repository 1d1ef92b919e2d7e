"""One object at falling face counts: plain QEM above, salient neighbourhoods kept below."""

from contextlib import suppress

from stages.report.drawing import picture, show, square_grid, squared
from stages.report.items import Figure
from stages.report.results import NotRun
from stages.report.style import GREY, label, save

METHODS = ("qem", "enhanced")
LEVELS = 5
THIN = 0.25  # share of its square that an object fills at least, or its wires cannot be told apart


def build(results):
    name = _most_levels(results)
    levels = {method: dict(results.lods(name, method)) for method in METHODS}
    targets = list(levels[METHODS[0]])[:LEVELS]
    points = results.strong_points(name)["enhanced"]
    original = results.mesh(name)
    figure, grid = square_grid(2, len(targets) + 1, side=2.1, gap=0.3)
    show(grid[0, 0], original, wires=True, rows=520)
    show(grid[1, 0], original, wires=True, points=points, rows=520)
    grid[0, 0].set_title(f"original\n{len(original.faces):,} faces", fontsize=10, fontweight="normal", loc="center")
    for down, method in enumerate(METHODS):
        grid[down, 0].text(-0.04, 0.5, label(method), rotation=90, va="center", ha="right",
                           transform=grid[down, 0].transAxes)  # fmt: skip
        for across, target in enumerate(targets, start=1):
            _level(grid[down, across], levels[method].get(target), levels[METHODS[0]][target])
    path = save(figure, results.reports / "figures/lod.png")
    return Figure(
        "Fine where one looks, coarse elsewhere",
        f"Wireframes of {name}: the original and {len(targets)} simplified meshes, by plain QEM above and with salient "
        "neighbourhoods kept below.",
        "Red: the salient points whose neighbourhoods the lower row keeps.",
        [path],
    )


def _most_levels(results):
    """The object that shows the most: one with area for wires, and the most targets within reach of kept points."""
    wanted = [results.settings.hero_object, *results.settings.figure_objects, *results.settings.viewer_objects]
    wanted = list(dict.fromkeys(wanted))
    scores = {}
    for name in results.choose(wanted, len(wanted), stage="lod"):
        with suppress(NotRun):
            filled = (squared(picture(results.mesh(name), rows=60, smoothing=1), margin=0)[0] < 1).any(axis=2).mean()
            scores[name] = (filled > THIN, len(results.lods(name, METHODS[1])))
    if not scores:
        raise NotRun(f"no simplified mesh with the points of {METHODS[1]} kept", "lod")
    return max(scores, key=scores.get)


def _level(axes, mesh, plain):
    """One simplified mesh, or what stands in its place where the kept faces leave too few others."""
    shown = plain if mesh is None else mesh
    axes.set_title(f"{len(shown.faces):,} faces", fontsize=10, fontweight="normal", loc="center")
    if mesh is None:
        axes.set_axis_off()
        words = "out of reach:\nthe kept neighbourhoods\nleave too few faces"
        axes.text(0.5, 0.5, words, ha="center", va="center", color=GREY, transform=axes.transAxes)
    else:
        show(axes, mesh, wires=True, rows=520)
