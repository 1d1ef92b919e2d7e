"""Pictures of one or two objects: the points of every detector, and meshes with points kept (T figures 3.6 to 3.22)."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from itertools import islice

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LinearSegmentedColormap, Normalize
from scipy.spatial import KDTree

from haptic_glance.base.packing import ERROR_COLOURS
from haptic_glance.lod.errors import vertex_errors
from haptic_glance.look.views import render
from haptic_glance.mesh.mesh import Mesh
from stages.charts.datasets import SECTION_3_2, dataset_text
from stages.charts.drawing import (
    GREY,
    THIN,
    VIEWPOINT,
    colour_bar,
    filled,
    label,
    name_panels,
    show,
    square_grid,
    squared,
)
from stages.charts.items import Figure
from stages.charts.results import NotRun, Results, require_rows
from stages.lod.error_tables import (
    FIXED_ADAPTIVE,
    HKS,
    NAMES,
    OURS,
    PLAIN,
    PRINTED,
    UNSEEN,
    WEIGHTED,
    paired_cells,
    short,
    size,
    target_text,
)
from stages.lod.levels import levels_of
from stages.salient_points.measure import read_strong_points

COLUMNS = 7  # of figure 3.6
GUIDED = PRINTED[1]  # by SSIM: what figure 3.21 keeps
DIFFERING = ("corners", "VisAttCurvSymCon", HKS)  # figure 3.7, the thesis's: many, intermediate, few points
FACES = 1500  # the thesis's lower count; the nearest target that all methods reach
NEAR = 1.3  # times FACES, either way
ENOUGH = 2.0  # times as many points, from step to step: then the first object of the settings is taken
KEEPING = ("VisAttCurvSymCon", WEIGHTED, OURS)  # figure 3.8: the thesis's, or the next that was run
COLOURS = LinearSegmentedColormap.from_list("error", np.array(ERROR_COLOURS) / 255)  # of figure 3.8, as of the viewer
TOP = 0.98  # quantile of all errors shown that is darkest
EXAMPLES = 3  # objects of figure 3.22
DISTANCE = "metro_mean"
LEVELS = 3  # of figures 3.8 and 3.21: the thesis shows 3,000, 1,500 and 500 faces
BEYOND = "out of reach:\nthe kept neighbourhoods\nleave too few faces"
ROWS = {"figure_3_7": 330, "figure_3_8": 330, "figure_3_21": 300, "figure_3_22": 220}  # of pixels


def figure_3_6(results: Results) -> Figure:
    """The points of every detector on one object."""
    name = results.choose(results.settings.figure_objects, 1)[0]
    points, mesh = results.by_method("salient_points", read_strong_points, name), results.mesh(name)
    methods = points.those_of([method for method in NAMES if method != "thesis_ed"])
    drawing, grid = square_grid(-(-len(methods) // COLUMNS), COLUMNS, side=1.6, right=1.1, gap=0.3)
    ratios = against_the_mean(mesh, {method: points[method] for method in methods})
    for axes, method in zip(grid.flat, methods, strict=False):
        show(axes, mesh, ratios.get(method), points=points[method], tints=TINTS)
        title = f"{NAMES[method]}: {len(points[method])}"
        axes.set_title(title, fontsize=9, fontweight="normal", loc="center", pad=3)
    for axes in grid.flat[len(methods) :]:
        axes.set_axis_off()
    colour_bar(drawing, [0.94, 0.25, 0.01, 0.5], "of the detector's points", TINTS, ("fewer", "as the mean", "more"))
    ends = (pick(methods, key=lambda method: len(points[method])) for pick in (min, max))
    fewest, most = (f"{len(points[method])} ({NAMES[method]})" for method in ends)
    words = {"name": name, "count": len(methods), "few": fewest, "many": most, "set": dataset_text(results.sets[0])}
    return Figure(drawing, words, dpi=95)


def figure_3_7(results: Results) -> Figure:
    """Many, intermediate and few kept points on one object: one with area for wires, on which they differ most."""
    candidates = []
    for name, target, meshes in _simplified(results, DIFFERING, _preferred(results)):
        with suppress(NotRun):
            points = results.by_method("salient_points", read_strong_points, name)
            most, middle, fewest = (len(points[method]) for method in DIFFERING)
            contrast = min(most / max(middle, 1), middle / max(fewest, 1), ENOUGH)
            near = 1 / NEAR < len(meshes[DIFFERING[0]].faces) / FACES < NEAR
            candidates.append(((near and filled(results.mesh(name)) > THIN, contrast), name, target, meshes, points))
    require_rows(candidates, f"no object simplified with the points of {', '.join(DIFFERING)}", "lod", runnable=False)
    _, name, target, meshes, points = max(candidates, key=lambda entry: entry[0])  # of equals the first
    drawing, grid = square_grid(1, len(DIFFERING), side=2.9, right=1.1, gap=0.3)
    for axes, method in zip(grid[0], DIFFERING, strict=True):
        show(axes, meshes[method], faces_an_area(meshes[method]), True, rows=ROWS["figure_3_7"], tints=TINTS)
    name_panels(grid, [f"{short(method)}: {len(points[method])} points" for method in DIFFERING])
    colour_bar(drawing, [0.93, 0.2, 0.01, 0.6], "faces an area", TINTS, ("few", "as the mean", "many"))
    words = {"name": name, "target": target_text(target), "methods": ", ".join(map(short, DIFFERING))}
    return Figure(drawing, words | {"set": dataset_text(results.sets[0])}, dpi=75)


def figure_3_8(results: Results) -> Figure:
    """The original with its points, levels that keep them, and the original coloured by its distance to each level."""
    objects, pairs = results.settings.figure_objects, []
    for method in KEEPING:
        pairs += islice(_levels(results, (method, PLAIN), objects), 1)
    message = f"no levels of detail of {' or '.join(KEEPING)} beside plain QEM"
    name, levels = require_rows(pairs, message, "lod", runnable=False)[0]
    (method, salient), (_, even) = levels.items()
    mesh, points, rows = (
        results.mesh(name),
        results.by_method("salient_points", read_strong_points, name)[method],
        ROWS["figure_3_8"],
    )
    targets = sorted(set(salient) & set(even), key=lambda target: -len(salient[target].faces))[-LEVELS:]
    fields = [[errors(mesh, level[target]) for target in targets] for level in (salient, even)]
    top = float(np.quantile(np.concatenate(sum(fields, [])), TOP)) or 1.0
    drawing, grid = square_grid(3, len(targets) + 1, side=1.9, right=0.9, gap=0.25)
    show(grid[0, 0], mesh, points=points, rows=rows)
    for axes, target in zip(grid[0, 1:], targets, strict=True):
        show(axes, salient[target], wires=True, rows=rows)
    faces = [f"{len(salient[target].faces):,} faces" for target in targets]
    name_panels(grid, [f"original: {len(mesh.faces):,} faces, {len(points)} points", *faces], letters=(9.5, 10))
    for row, field, way in zip(grid[1:], fields, (f"{short(method)} kept", label(PLAIN)), strict=True):
        row[0].text(0.95, 0.5, f"error,\n{way}", ha="right", va="center", transform=row[0].transAxes)
        row[0].set_axis_off()
        for axes, values in zip(row[1:], field, strict=True):
            _show_coloured(axes, mesh, values / top, rows)
    scale = ScalarMappable(Normalize(0, 100 * top), COLOURS)
    bar = drawing.colorbar(scale, cax=drawing.add_axes((0.93, 0.1, 0.012, 0.5)), extend="max")
    bar.set_label("distance, % of the diagonal")
    bar.outline.set_edgecolor(GREY)
    worst = ", ".join(f"{100 * field.max():.2g} %" for field in fields[0])
    words = {"name": name, "levels": len(targets), "method": label(method), "top": f"{100 * TOP:.0f} %", "worst": worst}
    words["set"] = dataset_text(results.sets[0])
    return Figure(drawing, words, dpi=80)


def figure_3_21(results: Results) -> Figure:
    """One object at falling face counts, by plain QEM above and with salient neighbourhoods kept below."""
    candidates, preferred, rows = [], _preferred(results), ROWS["figure_3_21"]
    keeping = GUIDED if results.sets[0] == SECTION_3_2 else OURS
    for name, levels in _levels(results, (PLAIN, keeping), preferred, len(preferred)):
        counts = sorted(filter(str.isdigit, levels[PLAIN]), key=size)
        face_counts = (counts if len(counts) > 1 else sorted(levels[PLAIN], key=size))[:LEVELS]
        # Area for wires, and the most targets within reach of kept points.
        score = (filled(results.mesh(name)) > THIN, len(set(face_counts) & set(levels[keeping])))
        candidates.append((score, name, face_counts, levels))
    require_rows(candidates, f"no simplified mesh with the points of {keeping} kept", "lod", runnable=False)
    _, name, targets, levels = max(candidates, key=lambda entry: entry[0])
    original, points = results.mesh(name), results.by_method("salient_points", read_strong_points, name)[keeping]
    drawing, grid = square_grid(2, len(targets) + 1, side=2.0, gap=0.3)
    show(grid[0, 0], original, rows=rows)
    show(grid[1, 0], original, points=points, rows=rows)
    name_panels(grid, [f"original\n{len(original.faces):,} faces"], map(label, levels))
    for row, meshes in zip(grid[:, 1:], levels.values(), strict=True):
        name_panels(
            row[None], [f"{len(meshes[target].faces):,} faces" if target in meshes else "" for target in targets]
        )
        for axes, target in zip(row, targets, strict=True):
            if target in meshes:
                show(axes, meshes[target], wires=True, rows=rows)
            else:
                axes.set_axis_off()
                axes.text(0.5, 0.5, BEYOND, ha="center", va="center", color=GREY, transform=axes.transAxes)
    words = {"name": name, "count": len(targets), "set": dataset_text(results.sets[0])}
    return Figure(drawing, words, dpi=85)


def figure_3_22(results: Results) -> Figure:
    """Objects by plain collapse and with points of ED, SSIM and SVM kept, neighbourhoods fixed and adaptive."""
    printed = {unseen: name for name, unseen in UNSEEN.items()} if results.sets[0] == SECTION_3_2 else {}
    methods = [PLAIN, *(printed.get(method, method) for method in FIXED_ADAPTIVE)]
    examples = list(islice(_simplified(results, methods, results.settings.figure_objects), EXAMPLES))
    require_rows(examples, f"no object simplified by all of {', '.join(methods)}", "lod", runnable=False)
    drawing, grid = square_grid(len(examples), len(methods), side=1.6, gap=0.15)
    for row, (*_, meshes) in zip(grid, examples, strict=True):
        for axes, mesh in zip(row, meshes.values(), strict=True):
            show(axes, mesh, wires=True, rows=ROWS["figure_3_22"])
    above = [label(method).replace(", ", ",\n") for method in (PLAIN, *FIXED_ADAPTIVE)]
    name_panels(
        grid, above, [f"{name}\n{target_text(target)}" for name, target, _ in examples], letters=(9.5, 9), away=0.02
    )
    words = {"names": ", ".join(name for name, *_ in examples), "set": dataset_text(results.sets[0])}
    return Figure(drawing, words | _beside_plain(results, examples[0][1]), dpi=85)


def _beside_plain(results: Results, target: str) -> dict[str, str | int]:
    """How many objects all methods took to a target; how many times as far as plain QEM those with points kept err."""
    cells = paired_cells(results.rows("lod", target=target), [DISTANCE], FIXED_ADAPTIVE)
    ratio = np.exp(np.log(cells["value"] / cells["plain"]).mean())
    return {"objects": cells["item"].nunique(), "times": f"{ratio:.1f}"}


def _simplified(results: Results, methods: Sequence[str], preferred: Sequence[str]) -> Iterator[tuple]:
    """(object, target, {method: Mesh}) of the objects that all methods took to one target, the nearest to FACES."""
    for name, levels in _levels(results, methods, preferred):
        common = sorted(set.intersection(*map(set, levels.values())), key=size)
        if common:
            target = min(common, key=lambda target: abs(len(levels[methods[0]][target].faces) - FACES))
            yield name, target, {method: meshes[target] for method, meshes in levels.items()}


def _levels(results: Results, methods: Sequence[str], preferred: Sequence[str], count: int = 0) -> Iterator[tuple]:
    """(object, {method: {target: Mesh}}) of the objects, or the first `count`, that all methods simplified."""
    for name in results.choose(preferred, count or len(results.objects), stage="lod"):
        with suppress(NotRun):
            yield name, {method: dict(levels_of(results, name, method)) for method in methods}


def _preferred(results: Results) -> list[str]:
    settings = results.settings
    return list(dict.fromkeys([settings.hero_object, *settings.figure_objects, *settings.viewer_objects]))


def errors(mesh: Mesh, level: Mesh) -> np.ndarray:
    """(n,) distance of the original's vertices to the simplified surface, as a share of the original's diagonal."""
    return vertex_errors(level, mesh) / mesh.diagonal


def _show_coloured(axes: Axes, mesh: Mesh, values: np.ndarray, rows: int) -> None:
    colours = np.rint(255 * COLOURS(np.clip(values, 0, 1))[:, :3]).astype(np.uint8)
    mesh = Mesh(mesh.vertices, mesh.faces, colours)
    image = render(mesh, VIEWPOINT, (2 * rows, 2 * rows), "raster", background="white").rgb
    axes.imshow(squared(image.reshape(rows, 2, rows, 2, 3).mean(axis=(1, 3)) / 255)[0])
    axes.set_axis_off()


TINTS = "PuOr_r"  # purple: fewer, orange: more
SPREAD = 0.05  # of the diagonal: deviation of the Gaussian about a point
DEEPEST = 0.98  # quantile of all differences that has the deepest colour
OCTAVES = 3.0  # eight times as many faces an area as the mean, or an eighth, have the deepest colours


def density(mesh: Mesh, points: np.ndarray) -> np.ndarray:
    """(n,) share of the points (k,) vertex ids that lie about each vertex: 1 in the mean; 0 without points."""
    width = SPREAD * mesh.diagonal
    places = KDTree(mesh.vertices[points].reshape(-1, 3))
    near = places.sparse_distance_matrix(KDTree(mesh.vertices), 4 * width, output_type="coo_matrix")
    shares = np.bincount(near.col, np.exp(-0.5 * (near.data / width) ** 2), len(mesh.vertices))
    return shares / (shares.mean() or 1.0)


def against_the_mean(mesh: Mesh, points: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """{method: (n,) in 0..1}: more points about a vertex than the methods have in the mean is over 0.5."""
    densities = {method: density(mesh, values) for method, values in points.items() if len(values)}
    mean = np.mean(list(densities.values()), axis=0)
    top = float(np.quantile(np.abs(list(densities.values()) - mean), DEEPEST)) or 1.0
    return {method: np.clip(0.5 + 0.5 * (values - mean) / top, 0, 1) for method, values in densities.items()}


def faces_an_area(mesh: Mesh) -> np.ndarray:
    """(n,) in 0..1: how dense the faces about a vertex lie, over 0.5 where denser than in the mean."""
    smaller = np.log2(mesh.face_areas.mean() / np.maximum(mesh.face_areas, 1e-12))
    corners = mesh.faces.ravel()
    count = np.maximum(np.bincount(corners, minlength=len(mesh.vertices)), 1)
    octaves = np.bincount(corners, np.repeat(smaller, 3), len(mesh.vertices)) / count
    return np.clip(0.5 + 0.5 * octaves / OCTAVES, 0, 1)
