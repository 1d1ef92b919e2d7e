"""Simplifies one mesh and spares the places that people look at.

Reads STL, OBJ, PLY, OFF or GLB and writes the mesh in its own coordinates, with its colours and textures. The error is
weighted by saliency, so that faces go where people look; nothing is frozen but the boundary (unless --free-borders) and
borders of materials.
With --neighbourhood the faces around the salient points stay unchanged: on 50 household objects that raises the error
over the whole mesh by half. Prints the errors, beside those of plain quadric edge collapse (QEM) with as many faces.
Of a folder every mesh is simplified; the nodes of a GLB keep their names. A GLB is written y up, as the format has it.

examples:
  haptic-glance simplify bunny.stl --faces 1500 --out small.glb
  haptic-glance simplify chair.obj --tolerance 0.2% --up y --out chair_small.obj --picture chair.png
  haptic-glance simplify vase.glb --faces 2000 --attributes uv=1 --out vase_small.glb
  haptic-glance simplify bunny.stl --levels 50%,25%,10% --out levels
  haptic-glance simplify scans --levels 5000,1000 --format glb --free-borders --out levels --json
  haptic-glance simplify bunny.stl --faces 10% --neighbourhood adaptive --keep 8 --out small.ply
"""

import json
import sys
from argparse import Namespace
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from stages.kit import Mesh
from stages.kit.extras import MissingExtra
from stages.kit.timing import WallClock
from stages.meshes.colours import bake_texture
from stages.meshes.load import load_unnamed
from stages.meshes.own import mesh_files, names_of
from stages.meshes.up import upright_by, upright_for
from stages.salient_points import find_points, saliency

from .attribute_quadrics import check_attributes
from .command_table import summary
from .error_table import measure_meshes
from .export import COLORLESS, write_any
from .feasibility import InfeasibleTarget, SimplifyError
from .fewest import fewest_faces
from .kernels.jit import FOLDER
from .levels import level_path
from .neighbourhood import RINGS, neighbourhoods
from .options import check_options, check_paths, one_file, parser, targets
from .parts import Parts, moved_parts, parts_of
from .remedies import infeasible, number
from .targets import face_count
from .task import SimplificationTask, repaired
from .variant import PLAIN, SOFT

MIN_EXTENT = 1e-60  # units: areas, and products of two, underflow near 1e-80


def run(argv: Sequence[str]) -> int:
    """Runs the command line `argv`, without the program's name; 1 where a level, or a mesh of a folder, failed."""
    chosen = parser(__doc__ or "").parse_args(argv)
    check_paths(chosen)
    check_options(chosen)
    if not any(FOLDER.rglob("*.nbc")):
        report("the first run on a machine compiles the simplifier, which takes a minute")
    files, figures = mesh_files(chosen.mesh), []
    for path, name in zip(files, names_of(files), strict=True):
        try:
            figures.append(simplify_file(path, name, chosen))
        except (ValueError, MissingExtra) as error:
            if not chosen.mesh.is_dir():
                kind = MissingExtra if isinstance(error, MissingExtra) else ValueError
                raise kind(f"{path}: {error}").with_traceback(error.__traceback__) from None
            report(f"{path}: {error}")
    if chosen.json:
        print(json.dumps(figures))
    whole = len(figures) == len(files) and all(len(each["levels"]) == len(targets(chosen)) for each in figures)
    return 0 if whole else 1


def simplify_file(path: Path, name: str, chosen: Namespace) -> dict[str, Any]:
    """Writes what is asked for of one file; prints its table, unless as JSON, and returns its figures."""
    given, mesh = read(path, chosen.up)
    task, parts = prepare(mesh, chosen, path.stem), parts_of(path)
    found = {target: level for target in targets(chosen) if (level := reduce(task, chosen, target)) is not None}
    if not found:
        raise ValueError("no level is feasible")
    meshes = list(found.values())
    written = [level_path(chosen.out, name, path, target, chosen.format) for target in found]
    if one_file(chosen):
        written = [chosen.out]
    for out, level in zip(written, meshes, strict=True):
        write_level(out, task, level, given, parts)
    alone = not chosen.levels and chosen.method != PLAIN
    rival = plain(task, len(meshes[0].faces)) if alone else None
    report("measuring the errors")
    errors = measure_meshes(task, [*meshes, *([] if rival is None else [rival])], chosen.seed, report)
    if not chosen.json:
        print(summary(task, list(found) if chosen.levels else [method_label(chosen)], meshes, rival, errors))
    if chosen.picture:
        draw(task, meshes[0], chosen.picture)
    report("written: " + ", ".join(map(str, filter(None, [*written, chosen.picture]))))
    rows = zip(written, meshes, errors, strict=False)  # the rival's errors come last
    levels = [{"file": str(out), "faces": len(level.faces), **row} for out, level, row in rows]
    return {"mesh": str(path), "faces": len(task.mesh.faces), "levels": levels}


def write_level(out: Path, task: SimplificationTask, level: Mesh, given: Mesh, parts: Parts) -> None:
    """Writes one result in the file's coordinates, with the nodes of its scene, upright as its format has it."""
    restored = task.restored(level)
    turned, note = upright_for(out, restored)
    write_any(out, turned, moved_parts(parts, given, restored))
    if note:
        report(note)
    if out.suffix.lower() in COLORLESS and (task.given.texture or task.given.colors is not None):
        report(f"{out.suffix} files have no colours: write .glb, .obj or .ply to keep them")


def draw(task: SimplificationTask, found: Mesh, path: Path) -> None:
    """Writes the picture of the mesh before and after."""
    from .picture import write_picture  # loads matplotlib, which nothing else here needs

    points = task.points[task.points_kept(found)]
    write_picture(path, task.upright(task.mesh), task.upright(found), task.saliency, points, task.given.up)


def read(path: Path, up: str | None) -> tuple[Mesh, Mesh]:
    """(the mesh of a file, the same repaired), whose axis `up` points up; ValueError where it cannot be used."""
    report(f"reading {path.name}")
    given, note = upright_by(load_unnamed(path), path, up)
    extent = np.ptp(given.vertices, axis=0).max()
    if extent < MIN_EXTENT:
        raise ValueError(f"its extent is {extent:g}: export it in smaller units, or with more digits")
    mesh, notes = repaired(given)
    report(number(len(mesh.faces), "face") + "".join(f"; {note}" for note in [note, *notes]))
    return given, mesh


def prepare(mesh: Mesh, chosen: Namespace, name: str) -> SimplificationTask:
    """The SimplificationTask: saliency, and the points to keep."""
    asked, target = chosen.faces, len(mesh.faces)
    check_attributes(mesh, chosen.attributes)
    if asked and face_count(asked, target, "--faces") >= target:
        raise ValueError(f"--faces {asked}: the mesh has only {number(target, 'face')}, there is nothing to simplify")
    rendered = bake_texture(mesh)
    report("looking at it")
    method = "glance" if chosen.method == PLAIN else chosen.method
    with WallClock() as watch:
        values = saliency(rendered, method)
    report(f"saliency by {method} in {watch.seconds:.1f} s")
    points = np.zeros(0, dtype=np.int64)
    if chosen.neighbourhood != SOFT:
        points = find_points(rendered, method, chosen.keep, seed=chosen.seed, name=name)
        report(f"the faces around {number(len(points), 'point')} are frozen")
    rule = "fixed" if chosen.neighbourhood == SOFT else chosen.neighbourhood
    rings = neighbourhoods(mesh, points, rule, values, RINGS if chosen.rings is None else chosen.rings)
    soft = chosen.neighbourhood == SOFT and chosen.method != PLAIN
    weights = values if soft else None
    ways = chosen.backend, chosen.shrink, chosen.attributes, chosen.free_borders
    return SimplificationTask(mesh, values, points, rings, weights, *ways)


def reduce(task: SimplificationTask, chosen: Namespace, target: str) -> Mesh | None:
    """The Mesh with the face count `target`, or within the tolerance; None, with the reason reported, for a level."""
    report(
        "simplifying" + (f" to {100 * chosen.tolerance:g} % of the diagonal" if chosen.tolerance else f" to {target}")
    )
    try:
        if chosen.tolerance is None:
            return task.simplified(face_count(target, len(task.mesh.faces), "--faces"))
        found = fewest_faces(task.mesh, task.simplified, task.lowest_target, chosen.tolerance, chosen.seed, report)
    except (InfeasibleTarget, SimplifyError) as error:
        reason = infeasible(task, error, chosen.neighbourhood) if isinstance(error, InfeasibleTarget) else str(error)
        if not chosen.levels:
            raise ValueError(reason) from None
        report(f"no level {target}: {reason}")
        return None
    if found is task.mesh:
        report("no simplified mesh is within the tolerance: all faces are kept")
    return found


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


def report(text: str) -> None:
    """Prints progress to stderr, apart from the results."""
    print(f"simplify: {text}", file=sys.stderr, flush=True)
