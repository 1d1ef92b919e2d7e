"""Pictures of one or two objects: the points of every detector, and meshes with points kept (T figures 3.6 to 3.22)."""

from collections.abc import Iterator, Sequence
from contextlib import suppress
from itertools import islice

from matplotlib.axes import Axes

from stages.kit import Mesh
from stages.report.drawing import THIN, filled, show, square_grid
from stages.report.items import Figure
from stages.report.results import NotRun, Results
from stages.report.style import GREY, label

from .methods import FIXED_ADAPTIVE, HKS, NAMES, OURS, PLAIN, short
from .rows import said, size

COLUMNS = 7  # of figure 3.6
DIFFERING = ("corners", "VisAttCurvSymCon", HKS)  # figure 3.7, the thesis's: many, intermediate, few points
FACES = 1500  # the thesis's lower count; the nearest target that all methods reach
NEAR = 1.3  # times FACES, either way
ENOUGH = 2.0  # times as many points, from step to step: then the first object of the settings is taken
LEVELS = 3  # of figure 3.21: the thesis shows 3,000, 1,500 and 500 faces
BEYOND = "out of reach:\nthe kept neighbourhoods\nleave too few faces"
OBJECTS = 2  # of figure 3.22
ROWS = {"figure_3_7": 330, "figure_3_21": 300, "figure_3_22": 220}  # of pixels


def figure_3_6(results: Results) -> Figure:
    """The points of every detector on one object."""
    name = results.choose(results.settings.figure_objects, 1)[0]
    points, mesh = results.strong_points(name), results.mesh(name)
    methods = points.those_of([method for method in NAMES if method != "thesis_ed"])
    drawing, grid = square_grid(-(-len(methods) // COLUMNS), COLUMNS, side=1.6, gap=0.3)
    for axes, method in zip(grid.flat, methods, strict=False):
        show(axes, mesh, points=points[method])
        _title(axes, f"{NAMES[method]}: {len(points[method])}", 9, pad=3)
    for axes in grid.flat[len(methods) :]:
        axes.set_axis_off()
    few, many = (pick(methods, key=lambda method: len(points[method])) for pick in (min, max))
    said_points = {"few": f"{len(points[few])} ({NAMES[few]})", "many": f"{len(points[many])} ({NAMES[many]})"}
    return Figure(drawing, {"name": name, "count": len(methods), **said_points})


def figure_3_7(results: Results) -> Figure:
    """Many, intermediate and few kept points on one object: one with area for wires, on which they differ most."""
    found = []
    for name, target, meshes in _simplified(results, DIFFERING, _preferred(results)):
        with suppress(NotRun):
            points = results.strong_points(name)
            many, middle, few = (len(points[method]) for method in DIFFERING)
            apart = min(many / max(middle, 1), middle / max(few, 1), ENOUGH)
            near = 1 / NEAR < len(meshes[DIFFERING[0]].faces) / FACES < NEAR
            found.append(((near and filled(results.mesh(name)) > THIN, apart), name, target, meshes, points))
    if not found:
        raise NotRun(f"no object simplified with the points of {', '.join(DIFFERING)}", "lod", runnable=False)
    _, name, target, meshes, points = max(found, key=lambda one: one[0])  # of equals the first
    drawing, grid = square_grid(1, len(DIFFERING), side=2.9, gap=0.3)
    for axes, method in zip(grid[0], DIFFERING, strict=True):
        show(axes, meshes[method], wires=True, rows=ROWS["figure_3_7"])
        _title(axes, f"{short(method)}: {len(points[method])} points")
    return Figure(drawing, {"name": name, "target": said(target), "methods": ", ".join(map(short, DIFFERING))}, dpi=85)


def figure_3_21(results: Results) -> Figure:
    """One object at falling face counts, by plain QEM above and with salient neighbourhoods kept below.

    The object has area for wires, and the most targets within reach of kept points.
    """
    found, wanted, rows = [], _preferred(results), ROWS["figure_3_21"]
    for name in results.choose(wanted, len(wanted), stage="lod"):
        with suppress(NotRun):
            levels = {method: dict(results.lods(name, method)) for method in (PLAIN, OURS)}
            counts = sorted(filter(str.isdigit, levels[PLAIN]), key=size)
            shown = (counts if len(counts) > 1 else sorted(levels[PLAIN], key=size))[:LEVELS]
            score = (filled(results.mesh(name)) > THIN, len(set(shown) & set(levels[OURS])))
            found.append((score, name, shown, levels))
    if not found:
        raise NotRun(f"no simplified mesh with the points of {OURS} kept", "lod")
    _, name, targets, levels = max(found, key=lambda one: one[0])
    original, points = results.mesh(name), results.strong_points(name)[OURS]
    drawing, grid = square_grid(2, len(targets) + 1, side=2.0, gap=0.3)
    show(grid[0, 0], original, rows=rows)
    show(grid[1, 0], original, points=points, rows=rows)
    _title(grid[0, 0], f"original\n{len(original.faces):,} faces")
    for row, (method, meshes) in zip(grid, levels.items(), strict=True):
        row[0].text(-0.04, 0.5, label(method), rotation=90, va="center", ha="right", transform=row[0].transAxes)
        for axes, target in zip(row[1:], targets, strict=True):
            if target in meshes:
                _title(axes, f"{len(meshes[target].faces):,} faces")
                show(axes, meshes[target], wires=True, rows=rows)
            else:
                axes.set_axis_off()
                axes.text(0.5, 0.5, BEYOND, ha="center", va="center", color=GREY, transform=axes.transAxes)
    return Figure(drawing, {"name": name, "count": len(targets)}, dpi=85)


def figure_3_22(results: Results) -> Figure:
    """Objects with the points of ED, SSIM and SVM kept, with fixed and with adaptive neighbourhoods."""
    shown = list(islice(_simplified(results, FIXED_ADAPTIVE, results.settings.figure_objects), OBJECTS))
    if not shown:
        raise NotRun(f"no object simplified by all of {', '.join(FIXED_ADAPTIVE)}", "lod", runnable=False)
    drawing, grid = square_grid(len(shown), len(FIXED_ADAPTIVE), side=1.6, gap=0.15)
    for row, (name, target, meshes) in zip(grid, shown, strict=True):
        for axes, mesh in zip(row, meshes.values(), strict=True):
            show(axes, mesh, wires=True, rows=ROWS["figure_3_22"])
        row[0].text(-0.02, 0.5, f"{name}\n{said(target)}", rotation=90, va="center", ha="right", fontsize=9,
                    transform=row[0].transAxes)  # fmt: skip
    for axes, method in zip(grid[0], FIXED_ADAPTIVE, strict=True):
        _title(axes, label(method).replace(", ", ",\n"), 9.5)
    return Figure(drawing, {"names": " and ".join(name for name, *_ in shown)}, dpi=85)


def _simplified(
    results: Results, methods: Sequence[str], preferred: Sequence[str]
) -> Iterator[tuple[str, str, dict[str, Mesh]]]:
    """(object, target, {method: Mesh}) of the objects that all methods took to one target, the nearest to FACES."""
    for name in results.choose(preferred, len(results.objects), stage="lod"):
        with suppress(NotRun):
            levels = {method: dict(results.lods(name, method)) for method in methods}
            common = sorted(set.intersection(*map(set, levels.values())), key=size)
            if common:
                faces = {target: len(levels[methods[0]][target].faces) for target in common}
                target = min(common, key=lambda target: abs(faces[target] - FACES))
                yield name, target, {method: meshes[target] for method, meshes in levels.items()}


def _preferred(results: Results) -> list[str]:
    settings = results.settings
    return list(dict.fromkeys([settings.hero_object, *settings.figure_objects, *settings.viewer_objects]))


def _title(axes: Axes, words: str, size: float = 10, pad: float | None = None) -> None:
    axes.set_title(words, fontsize=size, fontweight="normal", loc="center", pad=pad)
