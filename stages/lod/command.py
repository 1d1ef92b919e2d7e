"""Simplifies one mesh and spares the places that people look at.

Reads STL, OBJ, PLY, OFF or GLB and writes the mesh in its own coordinates, with its colours and textures. The error is
weighted by saliency, so that faces go where people look; nothing is frozen but the boundary and borders of materials.
With --neighbourhood the faces around the salient points stay unchanged: on 50 household objects that raises the error
over the whole mesh by half. Prints the errors, beside those of plain quadric edge collapse (QEM) with as many faces.
With a data set of params.yaml instead of MESH, the stage `lod` of the pipeline runs on it.

examples:
  python -m stages.lod bunny.stl --faces 1500 --out small.glb
  python -m stages.lod chair.obj --tolerance 0.2% --up y --out chair_small.obj --picture chair.png
  python -m stages.lod vase.glb --faces 2000 --attributes uv=1 --out vase_small.glb
  python -m stages.lod bunny.stl --faces 10% --neighbourhood adaptive --keep 8 --out small.ply
"""

import sys
from argparse import Namespace
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from stages.kit import Mesh, Stopwatch
from stages.meshes.colours import bake_texture
from stages.meshes.load import load_unnamed
from stages.meshes.up import lying_note, upright_by
from stages.salient_points import find_points, saliency

from .attribute_quadrics import check_attributes
from .error_table import NAMES, format_table, measure_meshes
from .export import COLORLESS, write_any
from .feasibility import InfeasibleTarget, SimplifyError, smallest_feasible
from .fewest import fewest_faces
from .kernels.jit import FOLDER
from .neighbourhood import RINGS, neighbourhoods
from .options import check_options, check_paths, parser
from .targets import face_count
from .task import SimplificationTask, repaired
from .topology import topology
from .variant import PLAIN, SOFT

MIN_EXTENT = 1e-60  # units: areas, and products of two, underflow near 1e-80


def run(argv: Sequence[str]) -> None:
    """Runs the command line `argv`, without the program's name."""
    chosen = parser(__doc__ or "").parse_args(argv)
    check_paths(chosen)
    check_options(chosen)
    if not any(FOLDER.rglob("*.nbc")):
        report("the first run on a machine compiles the simplifier, which takes a minute")
    try:
        task = prepare(read(chosen.mesh, chosen.up), chosen)
        found = reduce(task, chosen)
    except ValueError as error:
        raise ValueError(f"{chosen.mesh}: {error}").with_traceback(error.__traceback__) from None
    write_any(chosen.out, task.restored(found))
    print(summary(task, found, chosen))
    if chosen.picture:
        from .picture import write_picture  # loads matplotlib, which nothing else here needs

        points = task.points[task.points_kept(found)]
        write_picture(
            chosen.picture, task.upright(task.mesh), task.upright(found), task.saliency, points, task.given.up
        )
    print("written: " + ", ".join(str(path) for path in (chosen.out, chosen.picture) if path))
    if note := lying_note(chosen.out, task.given):
        report(note)
    if chosen.out.suffix.lower() in COLORLESS and (task.given.texture or task.given.colors is not None):
        report(f"{chosen.out.suffix} files have no colours: write .glb, .obj or .ply to keep them")


def read(path: Path, up: str | None) -> Mesh:
    """The repaired mesh of a file, whose axis `up` points up; ValueError where it cannot be used."""
    report(f"reading {path.name}")
    mesh, note = upright_by(load_unnamed(path), path, up)
    extent = np.ptp(mesh.vertices, axis=0).max()
    if extent < MIN_EXTENT:
        raise ValueError(f"its extent is {extent:g}: export it in smaller units, or with more digits")
    mesh, notes = repaired(mesh)
    report(number(len(mesh.faces), "face") + "".join(f"; {note}" for note in [note, *notes]))
    return mesh


def prepare(mesh: Mesh, chosen: Namespace) -> SimplificationTask:
    """The SimplificationTask: saliency, and the points to keep."""
    asked, target = chosen.faces, len(mesh.faces)
    check_attributes(mesh, chosen.attributes)
    if asked and face_count(asked, target, "--faces") >= target:
        raise ValueError(f"--faces {asked}: the mesh has only {number(target, 'face')}, there is nothing to simplify")
    rendered = bake_texture(mesh)
    report("looking at it")
    method = "glance" if chosen.method == PLAIN else chosen.method
    with Stopwatch() as watch:
        values = saliency(rendered, method)
    report(f"saliency by {method} in {watch.seconds:.1f} s")
    points = np.zeros(0, dtype=np.int64)
    if chosen.neighbourhood != SOFT:
        points = find_points(rendered, method, chosen.keep, seed=chosen.seed, name=chosen.mesh.stem)
        report(f"the faces around {number(len(points), 'point')} are frozen")
    rule = "fixed" if chosen.neighbourhood == SOFT else chosen.neighbourhood
    rings = neighbourhoods(mesh, points, rule, values, RINGS if chosen.rings is None else chosen.rings)
    soft = chosen.neighbourhood == SOFT and chosen.method != PLAIN
    weights = values if soft else None
    return SimplificationTask(mesh, values, points, rings, weights, chosen.backend, chosen.shrink, chosen.attributes)


def reduce(task: SimplificationTask, chosen: Namespace) -> Mesh:
    """The Mesh with the face count, or within the tolerance, of the command line."""
    report("simplifying" + (f" to {100 * chosen.tolerance:g} % of the diagonal" if chosen.tolerance else ""))
    try:
        if chosen.tolerance is None:
            return task.simplified(face_count(chosen.faces, len(task.mesh.faces), "--faces"))
        found = fewest_faces(task.mesh, task.simplified, task.lowest_target, chosen.tolerance, chosen.seed, report)
    except InfeasibleTarget as error:
        raise ValueError(infeasible(task, error, chosen)) from None
    if found is task.mesh:
        report("no simplified mesh is within the tolerance: all faces are kept")
    return found


def infeasible(task: SimplificationTask, error: InfeasibleTarget, chosen: Namespace) -> str:
    """The message for a target that is too low: the reason, and what is feasible."""
    frozen = [f"{number(error.frozen, 'face')} around {number(len(task.points), 'point')}"] if error.frozen else []
    if len(task.boundary):
        frozen.append(f"{number(len(task.boundary), 'boundary edge')}")
    reason = f", since {' and '.join(frozen)} are frozen" if frozen else ""
    ways = remedies(task, error, chosen) or ["the mesh cannot be simplified further"]
    return f"{number(error.faces, 'face')} are infeasible{reason}: {', or '.join(ways)}"


def remedies(task: SimplificationTask, error: InfeasibleTarget, chosen: Namespace) -> list[str]:
    """What would help; empty where nothing would."""
    total = len(task.mesh.faces)
    if smallest_feasible(task.mesh) >= total:  # not even with nothing frozen
        several = len(task.boundary) and topology(task.mesh.faces).components > 1
        return ["join its connected components first"] if several else []
    ways = [f"ask for --faces {error.smallest} or more"] if error.smallest < total else []
    if error.frozen and len(task.points) > 1:
        ways += ["--keep fewer points"]
    if error.frozen and chosen.neighbourhood == "fixed" and task.rings.any():
        ways += ["take fewer --rings"]
    if error.frozen:
        ways += [*(() if task.shrink else ("let them --shrink",)), "leave --neighbourhood out"]
    return ways


def summary(task: SimplificationTask, found: Mesh, chosen: Namespace) -> str:
    """The table that the command prints."""
    rivals = [] if chosen.method == PLAIN else [plain(task, len(found.faces))]
    meshes = [found, *(rival for rival in rivals if rival is not None)]
    report("measuring the errors")
    errors = measure_meshes(task, meshes, chosen.seed, report)
    rest = [None] * (len(meshes) - 1)
    rows: list[tuple] = [("faces", len(task.mesh.faces), *(len(mesh.faces) for mesh in meshes))]
    if len(task.points):
        rows += [("points kept", len(task.points), int(task.points_kept(found).sum()), *rest)]
    if len(task.border):
        rows += [("border edges kept", len(task.border), task.border_edges_kept(found), *rest)]
    if len(task.points) or len(task.border):
        rows += [("fewest faces that keep them", None, task.smallest_with_borders, *rest)]
    rows += [(NAMES[name], None, *(each[name] for each in errors)) for name in NAMES if name in errors[0]]
    return format_table(["before", method_label(chosen), *["plain QEM"] * len(rest)], rows)


def method_label(chosen: Namespace) -> str:
    """The name of the variant, as the stage `lod` has it."""
    return PLAIN if chosen.method == PLAIN else f"{chosen.method}-{chosen.neighbourhood}"


def plain(task: SimplificationTask, faces: int) -> Mesh | None:
    """The Mesh of as many faces by plain QEM; None, with the reason reported, where none is sound."""
    try:
        return task.plain(faces)
    except (InfeasibleTarget, SimplifyError) as error:
        report(f"no comparison with plain QEM: {error}")
        return None


def number(count: int, noun: str) -> str:
    """`1 face`, `1,280 faces`."""
    return f"{count:,} {noun}{'' if count == 1 else 's'}"


def report(text: str) -> None:
    """Prints progress to stderr, apart from the results."""
    print(f"lod: {text}", file=sys.stderr, flush=True)
