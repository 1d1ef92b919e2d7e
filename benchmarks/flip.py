"""What a person sees of a simplified mesh, by FLIP of rendered views: `python -m benchmarks.flip [PSB.zip]`

FLIP (Andersson et al. 2020) predicts the differences that a person notices when two pictures are shown in turns. Needs
the package flip-evaluator; almeshopt, machine code of meshoptimizer, is left out where it is not installed.

Meshes: the 19 with human gaze, and the first of each class of the Princeton segmentation benchmark (psb.zip). Each is
simplified to SHARES of its faces by METHODS, and drawn from ten sides in grey. A row of reports/bench/flip.csv has:

- flip: the mean over the pixels that show the mesh before or after, and over the views.
- flip_gaze: the mean over the pixels that show the mesh before, weighted by the density of the recorded gaze.
- metro_mean: the mean distance of the surfaces, in diagonals.

The glance never saw the mesh: for each mesh with gaze it is learned from the other objects. flip_means.csv beside it
has the difference of each method from plain simplification, in per cent of the error: the geometric mean over the
meshes on which both reached the number of faces, with a 95 % interval. About 40 minutes on one core.
"""

import ctypes
import importlib.util
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
import pandas as pd

from benchmarks import arguments
from benchmarks._simplify_peers import in_use
from benchmarks.deep_gaze import SETS, SHARED, features_of, left_out
from haptic_glance import find_points, saliency, simplify
from haptic_glance.base.files import write_table
from haptic_glance.lod import InfeasibleTarget, metro, shrunk_rings
from haptic_glance.look.views import View, Viewpoint, render
from haptic_glance.mesh.mesh import Mesh
from stages.bench import gazed
from stages.engine.parallel import progress
from stages.engine.statistics import interval
from stages.meshes import Params
from stages.meshes.collect import prepare_mesh
from stages.meshes.sources import SOURCES

OUT, PSB = Path("reports/bench/flip.csv"), "../shared/data/psb.zip"
SHARES = (0.1, 0.05, 0.02)
VIEWS = tuple(Viewpoint(36 * k, 30 * (k % 2)) for k in range(10))  # around the mesh, level and from above in turns
SIZE = (450, 600)  # rows and columns of a picture
PLAIN, RINGS, NO_LIMIT = "plain", 3, 1e30
ERRORS = ("flip", "flip_gaze", "metro_mean")
Simplifier = Callable[[Mesh, int], Mesh]


def flip_map(reference: np.ndarray, picture: np.ndarray) -> np.ndarray:
    """(rows, columns) f4 in 0..1: FLIP of two pictures (rows, columns, 3) u1, at the package's default distance."""
    import flip_evaluator

    before, after = (np.ascontiguousarray(side, np.float32) / 255 for side in (reference, picture))
    return flip_evaluator.evaluate(before, after, "LDR", True, False, False)[0][..., 0]


def seen_errors(before: list[View], after: list[View], density: np.ndarray | None) -> dict[str, float | None]:
    """dict(flip, flip_gaze) of views of a mesh and of its simplified form; density (f,): gaze on the faces before."""
    sums = np.zeros((2, 2))  # (of pixels, of gaze) x (error, weight)
    for first, second in zip(before, after, strict=True):
        errors, shown = flip_map(first.rgb, second.rgb), first.face >= 0
        weights = [shown | (second.face >= 0)]
        weights += [] if density is None else [np.where(shown, density[first.face], 0)]
        sums[: len(weights)] += [((errors * weight).sum(), weight.sum()) for weight in weights]
    flip, gaze = (total / weight if weight else None for total, weight in sums)
    return {"flip": flip, "flip_gaze": gaze}


def simplifiers(mesh: Mesh, density: np.ndarray | None, weights: Mapping[str, float] | None) -> dict[str, Simplifier]:
    """{method: simplifier} of one mesh; weights: of the glance, None for the published ones."""
    values = saliency(mesh, weights=weights)
    points = find_points(mesh, weights=weights)
    methods: dict[str, Simplifier] = {
        PLAIN: simplify,
        "weighted": lambda mesh, faces: simplify(mesh, faces, weights=values),
        "kept": lambda mesh, faces: simplify(mesh, faces, points, shrunk_rings(mesh, faces, points, RINGS)),
    }
    if density is not None:
        methods["weighted_by_gaze"] = lambda mesh, faces: simplify(mesh, faces, weights=density / density.max())
    return methods | PEERS


def native() -> dict[str, Simplifier]:
    """Two functions of meshoptimizer's machine code: the second moves vertices; {} without the package almeshopt."""
    if importlib.util.find_spec("almeshopt") is None:
        print("meshoptimizer is left out: no module almeshopt")
        return {}
    folder = Path(*(importlib.util.find_spec("almeshopt").submodule_search_locations or ()))
    library = ctypes.CDLL(str(next(folder.glob("almeshopt_*.so"))))
    size, real, array, bits = ctypes.c_size_t, ctypes.c_float, ctypes.c_void_p, ctypes.c_uint
    plain, moving = library.meshopt_simplify, library.meshopt_simplifyWithUpdate
    plain.restype = moving.restype = size
    plain.argtypes = [array, array, size, array, size, size, size, real, bits, array]
    moving.argtypes = [array, size, array, size, size, array, size, array, size, array, size, real, bits, array]

    def picks(mesh: Mesh, faces: int) -> Mesh:
        ids, points = mesh.faces.astype(np.uint32), mesh.vertices.astype(np.float32)
        left = np.empty_like(ids)
        surface = left.ctypes.data, ids.ctypes.data, ids.size, points.ctypes.data, len(points), points.strides[0]
        count = plain(*surface, 3 * faces, NO_LIMIT, 0, None)
        return in_use(points, left.ravel()[:count].reshape(-1, 3))

    def moves(mesh: Mesh, faces: int) -> Mesh:
        ids, points = mesh.faces.astype(np.uint32), mesh.vertices.astype(np.float32)
        surface = ids.ctypes.data, ids.size, points.ctypes.data, len(points), points.strides[0]
        count = moving(*surface, None, 0, None, 0, None, 3 * faces, NO_LIMIT, 0, None)
        return in_use(points, ids.ravel()[:count].reshape(-1, 3))

    return {"meshoptimizer": picks, "meshoptimizer_moving": moves}


PEERS: dict[str, Simplifier] = {}  # those of `native`, once the benchmark runs


def pictures(mesh: Mesh) -> list[View]:
    """The mesh from VIEWS."""
    return [render(mesh, viewpoint, SIZE) for viewpoint in VIEWS]


def rows_of(mesh: Mesh, density: np.ndarray | None, weights: Mapping[str, float] | None) -> list[dict]:
    """A row a share and method; faces and errors are empty where a method cannot reach the number of faces."""
    before, rows = pictures(mesh), []
    on_faces = None if density is None else density[mesh.faces].mean(axis=1)
    for method, work in simplifiers(mesh, density, weights).items():
        for share in SHARES:
            asked = int(share * len(mesh.faces))
            row = {"share": share, "method": method, "full": len(mesh.faces), "asked": asked, "faces": None}
            try:
                small = work(mesh, asked)
            except InfeasibleTarget as error:
                rows.append(row | {"note": str(error)})
                continue
            errors = seen_errors(before, pictures(small), on_faces) | {"metro_mean": metro(mesh, small)["mean"]}
            rows.append(row | {"faces": len(small.faces)} | errors | {"note": ""})
    return rows


def means(table: pd.DataFrame) -> pd.DataFrame:
    """A row a set, share, method and error: its difference from plain simplification in per cent, over the meshes.

    The geometric mean of the ratios, with a 95 % interval. `both` has the meshes of both sets. Left out: meshes on
    which one of the two missed the number of faces, or has no error.
    """
    reached = table[table["faces"] <= table["asked"]]
    key, rows = ["set", "item", "share"], []
    plain = reached[reached["method"] == PLAIN].set_index(key)[list(ERRORS)].astype(float)
    for method, part in reached[reached["method"] != PLAIN].groupby("method", sort=False):
        ratios = part.set_index(key)[list(ERRORS)].astype(float) / plain
        logs = np.log(ratios.where(ratios > 0)).reset_index()
        pooled = pd.concat([logs, logs.assign(set="both")])
        for (name, share), group in pooled.groupby(["set", "share"], sort=False):
            for error in ERRORS:
                values = group[error].dropna()
                if len(values) > 2:
                    mean, low, high = (100 * np.expm1(value) for value in interval(values))
                    line = {"set": name, "share": share, "method": method, "than": PLAIN, "error": error}
                    rows.append(line | {"meshes": len(values), "difference": mean, "low": low, "high": high})
    return pd.DataFrame(rows)


def main() -> None:
    """Measures everything and writes both tables."""
    chosen = arguments(__doc__, archive=PSB)
    if importlib.util.find_spec("flip_evaluator") is None:
        raise SystemExit("benchmarks.flip: no module flip_evaluator: pip install flip-evaluator")
    PEERS.update(native())
    objects = {(name, item): part for name in SETS for item, part in gazed(name, SHARED / f"{name}.zip").items()}
    weights = left_out("glance", *features_of("glance", objects))
    tasks = [(*key, mesh, truth.density, weights[key]) for key, (mesh, truth) in objects.items() if key[0] == SETS[0]]
    first: dict[str, tuple] = {}
    for item in SOURCES["princeton"](Params("princeton", chosen.archive)):
        if (name := item.name.split("_")[0]) not in first:
            first[name] = ("princeton", item.name, prepare_mesh(item)[0], None, None)
    rows: list[dict] = []
    for name, item, mesh, density, learned in progress([*tasks, *first.values()], "flip"):
        rows += [{"set": name, "item": item} | row for row in rows_of(mesh, density, learned)]
        write_table(OUT, pd.DataFrame(rows).round({"flip": 6, "flip_gaze": 6, "metro_mean": 9}))
    table = means(pd.DataFrame(rows)).round(3)
    write_table(OUT.with_name("flip_means.csv"), table)
    print(table.to_string(index=False))


if __name__ == "__main__":
    main()
