"""Simplifies one mesh and spares the places that people look at.

Reads STL, OBJ, PLY, OFF, GLB or glTF and writes the mesh in its own coordinates, with its colours and textures; from
glTF to GLB with its materials, but for what is named as dropped. The error is weighted by saliency, so that faces go
where people look; nothing is frozen but the boundary (unless --free-borders) and borders of materials.
With --neighbourhood the faces around the salient points stay unchanged: on 50 household objects that raises the error
over the whole mesh by half. Prints the errors, beside those of plain quadric edge collapse (QEM) with as many faces.
Every mesh of a folder is simplified. The nodes of a GLB keep their names; their transforms become part of the vertices.
A GLB is written y up, as the format has it, with normals: smooth but for edges of 60 degrees and more.

examples:
  haptic-glance simplify bunny.stl --faces 1500 --out small.glb
  haptic-glance simplify chair.obj --tolerance 0.2% --up y --out chair_small.obj --picture chair.png
  haptic-glance simplify vase.glb --faces 2000 --attributes uv=1 --out vase_small.glb
  haptic-glance simplify bunny.stl --levels 50%,25%,10% --out levels
  haptic-glance simplify scans --levels 5000,1000 --format glb --free-borders --out levels --json
  haptic-glance simplify bunny.stl --faces 10% --neighbourhood adaptive --keep 8 --out small.ply
"""

import argparse
import json
import re
from argparse import Namespace
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from haptic_glance.base import progress
from haptic_glance.base.extras import MissingExtra, about
from haptic_glance.base.files import check_folder, existing, said_of
from haptic_glance.base.timing import WallClock
from haptic_glance.lod.attribute_quadrics import check_attributes
from haptic_glance.lod.export import COLORLESS, FORMATS, face_count, level_path, levels, write_any
from haptic_glance.lod.feasibility import InfeasibleTarget, SimplifyError
from haptic_glance.lod.measures import NAMES, fewest_faces, format_table, measure_meshes
from haptic_glance.lod.neighbourhood import NEIGHBOURHOODS, RINGS, neighbourhoods
from haptic_glance.lod.simplify import BACKEND, BACKENDS
from haptic_glance.lod.task import (
    FREE_BORDERS,
    PLAIN,
    SOFT,
    SimplificationTask,
    infeasible,
    may_free_borders,
    number,
    repaired,
)
from haptic_glance.lod.topology import Parts, moved_parts, parts_of
from haptic_glance.look.points import find_points, saliency
from haptic_glance.look.points.find import HELP, check_name
from haptic_glance.mesh.files import load_unnamed, mesh_files, names_of
from haptic_glance.mesh.gltf import as_glb
from haptic_glance.mesh.materials import COLOURS_OF, bake_texture, not_read
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.up import add_up, upright_by, upright_for

LEAST_PERCENT = 0.01  # a bare tolerance from here on is more likely one in percent: few want 1 % of the diagonal


def parser(about: str) -> argparse.ArgumentParser:
    """The parser; about: the text of --help, whose first line comes first."""
    first, _, rest = about.partition("\n")
    form = argparse.RawDescriptionHelpFormatter
    command = argparse.ArgumentParser("haptic-glance simplify", description=first, epilog=rest, formatter_class=form)
    command.add_argument("mesh", metavar="MESH", type=Path, help="the file to simplify, or a folder of files")
    target = command.add_mutually_exclusive_group(required=True)
    help_levels = "several results from one look: face counts or shares, such as 50%%,25%%,10%%"
    target.add_argument("--levels", metavar="N,N,...", type=levels, help=help_levels)
    target.add_argument("--faces", metavar="N", help="target face count: 1500, or a share such as 10%%")
    help_tolerance = "the fewest faces with a Metro mean error of at most this share of the diagonal: 0.2%%, or 0.002"
    help_tolerance += f" (from {LEAST_PERCENT:g} on the sign is required: 0.2 could mean 20%% or 0.2%%)"
    target.add_argument("--tolerance", metavar="SHARE", type=share, help=help_tolerance)
    help_out = f"the result: {', '.join(FORMATS)}; with --levels, or of a folder: the folder for them"
    command.add_argument("--out", metavar="PATH", type=Path, required=True, help=help_out)
    help_format = "of the files in that folder (default: that of the mesh, or glb)"
    command.add_argument("--format", choices=[suffix[1:] for suffix in FORMATS], help=help_format)
    command.add_argument(
        "--picture", metavar="FILE", type=Path, help="also draw the saliency, and the mesh before and after"
    )
    help_method = f"whose saliency and points: {HELP}; qem: nobody's, every place has the same weight"
    command.add_argument("--method", default="glance", help=help_method)
    help_ways = "soft: the saliency weights the error, nothing is frozen (default); the others freeze the faces around"
    help_ways += f" the salient points, within {RINGS} rings, or by the mesh's density, or by the salient area"
    command.add_argument("--neighbourhood", choices=[SOFT, *NEIGHBOURHOODS], default=SOFT, help=help_ways)
    help_keep = "how many points to freeze the faces around (default: those past the method's threshold)"
    command.add_argument("--keep", metavar="N", type=int, help=help_keep)
    command.add_argument("--rings", metavar="N", type=int, help=f"rings of --neighbourhood fixed (default: {RINGS})")
    command.add_argument(
        "--shrink", action="store_true", help="freeze fewer faces where the target is too low for all of them"
    )
    help_weights = "what the error counts beside the shape, and how much: colors=1,uv=1,normals=0.03 or some of them;"
    help_weights += " with colors=1, black and white differ as much as two ends of the mesh (default: nothing)"
    command.add_argument(
        "--attributes", metavar="NAME=WEIGHT,...", type=attribute_weights, default={}, help=help_weights
    )
    help_borders = "simplify the boundary, too: for scans and open surfaces, whose edges stay as they are otherwise"
    command.add_argument("--free-borders", action="store_true", help=help_borders)
    add_up(command)
    command.add_argument("--backend", choices=list(BACKENDS), default=BACKEND, help="default: %(default)s")
    command.add_argument("--json", action="store_true", help="print the figures as JSON")
    command.add_argument("--seed", type=int, default=0, help="for the samples of the errors (default: %(default)s)")
    return command


def share(text: str) -> float:
    """A share of the diagonal from `0.2%` or `0.002`; a bare number that may well be one in percent is refused."""
    match = re.fullmatch(r"(\d*\.?\d+(?:e-?\d+)?)(%?)", text.strip(), re.IGNORECASE)
    value = float(match[1]) / (100 if match[2] else 1) if match else np.inf
    if value == 0:
        reason = "rounding alone exceeds 0: allow a little, such as 0.001%"
        raise argparse.ArgumentTypeError(f"{text!r}: {reason}")
    if match and not match[2] and value >= LEAST_PERCENT:
        percent = f"{100 * value:g}%, " if value < 1 else ""
        raise argparse.ArgumentTypeError(f"{text!r}: write {percent}{match[1]}% or what else of the diagonal is meant")
    if not value < 1:
        raise argparse.ArgumentTypeError(f"{text!r} is not a share of the diagonal: write one like 0.2% or 0.002")
    return value


def attribute_weights(text: str) -> dict[str, float]:
    """Weights by name from `colors=1,uv=0.5`; which ones a mesh has shows later."""
    try:
        return {name.strip(): float(weight) for name, weight in (pair.split("=") for pair in text.split(","))}
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r}: write names and weights such as colors=1,uv=0.5") from None


def check_paths(chosen: argparse.Namespace) -> None:
    """Raises ValueError where the result or the picture cannot be written, or would overwrite the mesh."""
    if not one_file(chosen):
        check_folder_of_several(chosen)
    elif chosen.out.suffix.lower() not in FORMATS:
        raise ValueError(f"--out {chosen.out}: meshes are written as {', '.join(FORMATS)}")
    elif chosen.format:
        raise ValueError("--format is for the files in a folder: --out says that of one file")
    check_outputs(chosen.mesh, chosen.out if one_file(chosen) else None, chosen.picture)
    if chosen.picture:
        from haptic_glance.lod.pictures import check_picture

        check_picture(chosen.picture)


def one_file(chosen: argparse.Namespace) -> bool:
    """Whether --out is a file, and not the folder of several."""
    return not chosen.levels and not chosen.mesh.is_dir()


def targets(chosen: argparse.Namespace) -> list[str]:
    """The face counts asked for; of a tolerance one text that names it."""
    return chosen.levels or [chosen.faces or f"within_{100 * chosen.tolerance:g}%"]


def check_folder_of_several(chosen: argparse.Namespace) -> None:
    """Raises ValueError where --out is no folder, or not another one than that of the meshes."""
    check_folder(chosen.out, f"--out {chosen.out}")
    if chosen.out.suffix.lower() in FORMATS:
        raise ValueError(f"--out {chosen.out}: name a folder, since there are several results")
    if chosen.out.resolve() == (chosen.mesh if chosen.mesh.is_dir() else chosen.mesh.parent).resolve():
        raise ValueError(f"--out {chosen.out} is the folder of the meshes: name another one")
    if chosen.picture:
        raise ValueError("--picture is for one result")


def check_outputs(mesh: Path, *paths: Path | None) -> None:
    """Raises ValueError where one of the paths cannot be written, or would overwrite the mesh or another one."""
    given = [path for path in paths if path]
    for path in given:
        if sum(other.resolve() == path.resolve() for other in given) > 1:
            raise ValueError(f"{path} is named for two results: write them to two files")
        if path.is_dir():
            raise ValueError(f"{path} is a folder: name a file")
        check_folder(path.parent, f"{path}: {path.parent}")
        if path.exists() and mesh.exists() and path.samefile(mesh):
            raise ValueError(f"{path} is the mesh itself, which would be overwritten: write to another file")


def check_options(chosen: argparse.Namespace) -> None:
    """Raises ValueError for options without effect, unknown methods, and invalid counts."""
    if chosen.faces:
        face_count(chosen.faces, 1, "--faces")
    if chosen.seed < 0:
        raise ValueError(f"--seed {chosen.seed}: give 0 or more")
    check_name(chosen.method, [PLAIN])
    freezing = {"--keep": chosen.keep, "--rings": chosen.rings, "--shrink": chosen.shrink or None}
    given = next((name for name, value in freezing.items() if value is not None), None)
    if chosen.method == PLAIN and (given or chosen.neighbourhood != SOFT):
        raise ValueError(f"{given or '--neighbourhood'} has no effect with --method {PLAIN}, which freezes nothing")
    if given and chosen.neighbourhood == SOFT:
        remedy = f"add --neighbourhood {' or '.join(NEIGHBOURHOODS)}, or leave it out"
        raise ValueError(f"{given} has no effect where no faces are frozen: {remedy}")
    if chosen.attributes and chosen.backend == "pymeshlab":
        raise ValueError("--attributes has no effect with --backend pymeshlab: choose fast or qslim")
    if chosen.free_borders and (chosen.attributes or chosen.backend == "pymeshlab"):
        given = "--attributes" if chosen.attributes else "--backend pymeshlab"
        raise ValueError(f"--free-borders has no effect with {given}: leave one of them out")
    if chosen.rings is not None and chosen.neighbourhood != "fixed":
        raise ValueError(f"--rings has no effect with --neighbourhood {chosen.neighbourhood}: it is for fixed")
    if chosen.keep is not None and chosen.keep < 1:
        raise ValueError(f"--keep {chosen.keep}: give 1 or more points; --method {PLAIN} keeps none")
    if chosen.rings is not None and chosen.rings < 0:
        raise ValueError(f"--rings {chosen.rings}: give 0 (the faces that touch a point) or more")


MIN_EXTENT = 1e-60  # units: areas, and products of two, underflow near 1e-80


def run(argv: Sequence[str]) -> int:
    """Runs the command line `argv`, without the program's name; 1 where a level, or a mesh of a folder, failed."""
    chosen = parser(__doc__ or "").parse_args(argv)
    check_paths(chosen)
    check_options(chosen)
    files, figures = mesh_files(chosen.mesh), []
    for path, name in zip(files, names_of(files), strict=True):
        try:
            with about(path):
                figures.append(simplify_file(path, name, chosen))
        except (ValueError, MissingExtra) as error:
            if not chosen.mesh.is_dir():
                raise
            report(str(error))
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
    before = existing(*written, chosen.picture)
    for out, level in zip(written, meshes, strict=True):
        write_level(out, task, level, given, parts)
    alone = not chosen.levels and chosen.method != PLAIN
    rival = plain(task, len(meshes[0].faces)) if alone else None
    hint_at_pictures(chosen, mesh)
    report("measuring the errors")
    errors = measure_meshes(task, [*meshes, *([] if rival is None else [rival])], chosen.seed, report)
    if not chosen.json:
        print(summary(task, list(found) if chosen.levels else [method_label(chosen)], meshes, rival, errors))
    if chosen.picture:
        draw(task, meshes[0], chosen.picture)
    report(said_of([path for path in (*written, chosen.picture) if path], before))
    rows = zip(written, meshes, errors, strict=False)  # the rival's errors come last
    levels = [{"file": str(out), "faces": len(level.faces), **row} for out, level, row in rows]
    return {"mesh": str(path), "faces": len(task.mesh.faces), "levels": levels}


def hint_at_pictures(chosen: Namespace, mesh: Mesh) -> None:
    """Says once how the error can count a picture that it does not count."""
    counted = chosen.attributes or chosen.free_borders or chosen.backend == "pymeshlab" or "hinted" in chosen
    if not counted and mesh.texture and max(image.size for image in mesh.texture.images) > 4:
        chosen.hinted = True
        report("the error counts the shape alone; with --attributes uv=1 the picture on it moves less")


def write_level(out: Path, task: SimplificationTask, level: Mesh, given: Mesh, parts: Parts) -> None:
    """Writes one result in the file's coordinates, with the nodes of its scene, upright as its format has it."""
    restored = task.restored(level)
    turned, note = upright_for(out, restored)
    write_any(out, turned, moved_parts(parts, given, restored))
    if note:
        report(note)
    suffix, texture = out.suffix.lower(), task.given.texture
    if suffix in COLORLESS and (texture or task.given.colors is not None):
        report(f"{out.suffix} files have no colours: write .glb, .obj or .ply to keep them")
    elif suffix != ".glb" and texture and (said := {name for each in texture.materials for name in each or ()}):
        kept = "colours of vertices" if suffix == ".ply" else "the colours of materials"
        report(f"{out.suffix} files have {kept} alone, dropped: {', '.join(sorted(said - COLOURS_OF))}")


def draw(task: SimplificationTask, found: Mesh, path: Path) -> None:
    """Writes the picture of the mesh before and after."""
    from haptic_glance.lod.pictures import write_picture

    points = task.points[task.points_kept(found)]
    write_picture(path, task.upright(task.mesh), task.upright(found), task.saliency, points, task.given.up)


def read(path: Path, up: str | None) -> tuple[Mesh, Mesh]:
    """(the mesh of a file, the same repaired), whose axis `up` points up; ValueError where it cannot be used."""
    report(f"reading {path.name}")
    given, note = upright_by(load_unnamed(path), path, up)
    extent = np.ptp(given.vertices, axis=0).max()
    if extent < MIN_EXTENT:
        raise ValueError(f"its extent is {extent:g}: export it in smaller units, or with more digits")
    if lost := dropped_from(path):
        report(lost)
    mesh, notes = repaired(given)
    report(number(len(mesh.faces), "face") + "".join(f"; {note}" for note in [note, *notes]))
    return given, mesh


def dropped_from(path: Path) -> str:
    """The sentence that names the parts of a glTF file that a Mesh has no place for; empty without such parts."""
    lost = not_read(as_glb(path))
    return f"dropped from {path.name}, since they cannot be carried over: {', '.join(lost)}" if lost else ""


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
        if isinstance(error, InfeasibleTarget):
            reason = infeasible(task, error, chosen.neighbourhood)
        else:
            reason = f"{error}, or {FREE_BORDERS}" if may_free_borders(task) else str(error)
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
    progress.report("simplify", text)


def summary(
    task: SimplificationTask, heads: Sequence[str], meshes: Sequence[Mesh], rival: Mesh | None, errors: Sequence[dict]
) -> str:
    """The table that the command prints: the mesh, the meshes under their heads, and plain QEM where there is one."""
    shown = [*meshes, *([] if rival is None else [rival])]
    rest = [None] * (len(shown) - len(meshes))
    rows: list[tuple] = [("faces", len(task.mesh.faces), *(len(mesh.faces) for mesh in shown))]
    if len(task.points):
        rows += [("points kept", len(task.points), *(int(task.points_kept(mesh).sum()) for mesh in meshes), *rest)]
    if len(task.border) and not task.free_borders:
        rows += [("border edges kept", len(task.border), *(task.border_edges_kept(mesh) for mesh in meshes), *rest)]
    if len(task.points) or len(task.border):
        rows += [("fewest faces that keep them", None, *([task.smallest_with_borders] * len(meshes)), *rest)]
    rows += [(NAMES[name], None, *(each[name] for each in errors)) for name in NAMES if name in errors[0]]
    return format_table(["before", *heads, *["plain QEM"] * len(rest)], rows)
