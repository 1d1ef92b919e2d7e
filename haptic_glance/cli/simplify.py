"""Simplifies one mesh and spares the places that people look at.

Reads STL, OBJ, PLY, OFF, GLB or glTF and writes the mesh in its own coordinates, with its colours and textures. A GLB
made from glTF keeps the materials; a message lists the parts that it cannot hold. The error is weighted by saliency,
so that faces go where people look; nothing is frozen but the boundary (unless --free-borders) and borders of
materials. With --neighbourhood the faces around the salient points stay unchanged: on household objects that raises
the mean error, by a tenth at half of the faces, and to about double at a tenth. Prints the errors, beside those of
plain quadric edge collapse (QEM) with as many faces. Every mesh of a folder is simplified. The nodes of a GLB keep
their names; their transforms become part of the vertices. A GLB is written y up, as the format has it, with normals:
smooth but for edges of 60 degrees and more.

examples:
  haptic-glance simplify bunny.stl --faces 1500 --out small.glb
  haptic-glance simplify chair.obj --tolerance 0.2% --up y --out chair_small.obj --picture chair.png
  haptic-glance simplify vase.glb --faces 2000 --attributes uv=1 --out vase_small.glb
  haptic-glance simplify bunny.stl --levels 50%,25%,10% --out levels
  haptic-glance simplify scans --levels 5000,1000 --format glb --free-borders --out levels --json
  haptic-glance simplify bunny.stl --faces 10% --neighbourhood adaptive --keep 8 --out small.ply
"""

import argparse
import itertools
import json
import re
from argparse import Namespace
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from haptic_glance.base import progress
from haptic_glance.base.extras import MissingExtra, about, from_extra
from haptic_glance.base.files import check_folder, existing, said_of
from haptic_glance.base.timing import WallClock
from haptic_glance.lod.attribute_quadrics import check_attributes
from haptic_glance.lod.export import COLORLESS, FORMATS, face_count, files_beside, level_path, levels, write_with_files
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
from haptic_glance.mesh import obj
from haptic_glance.mesh.files import files_of, load_unnamed, mesh_files, names_of
from haptic_glance.mesh.gltf import as_glb
from haptic_glance.mesh.materials import COLOURS_OF, bake_texture, not_read
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.up import add_up, upright_by, upright_for

from .arguments import check_output_folder, command_parser

RIVAL = "plain QEM"
report = partial(progress.report, "simplify")
LEAST_PERCENT = 0.01  # a bare tolerance from here on is more likely one in percent: few want 1 % of the diagonal


def parser() -> argparse.ArgumentParser:
    """The parser of the command line."""
    command = command_parser("simplify", __doc__ or "")
    command.add_argument("mesh", metavar="MESH", type=Path, help="the file to simplify, or a folder of files")
    target = command.add_mutually_exclusive_group(required=True)
    help_levels = "several results from one look: face counts or shares, such as 50%%,25%%,10%%"
    target.add_argument("--levels", metavar="N,N,...", type=levels, help=help_levels)
    target.add_argument("--faces", metavar="N", help="target face count: 1500, or a share such as 10%%")
    help_tolerance = "the fewest faces with a Metro mean error of at most this share of the diagonal: 0.2%%, or 0.002"
    help_tolerance += f" (from {LEAST_PERCENT:g} on the sign is required: 0.2 could mean 20%% or 0.2%%)"
    target.add_argument("--tolerance", metavar="SHARE", type=share, help=help_tolerance)
    help_out = f"the result: {', '.join(FORMATS)}; with --levels, or for a folder of meshes: the output folder"
    command.add_argument("--out", metavar="PATH", type=Path, required=True, help=help_out)
    help_format = "format of the files in the output folder (default: that of the mesh, or glb)"
    command.add_argument("--format", choices=[suffix[1:] for suffix in FORMATS], help=help_format)
    command.add_argument(
        "--picture", metavar="FILE", type=Path, help="for one result: draw the saliency, and the mesh before and after"
    )
    help_method = f"method of saliency and points: {HELP}; qem: none, every place has the same weight"
    command.add_argument("--method", default="glance", help=help_method)
    help_ways = "soft: the saliency weights the error, nothing is frozen (default); the others freeze the faces around"
    help_ways += f" the salient points, within {RINGS} rings, or by the mesh's density, or by the salient area"
    command.add_argument("--neighbourhood", choices=[SOFT, *NEIGHBOURHOODS], default=SOFT, help=help_ways)
    help_keep = "number of points whose faces are frozen (default: the points past the method's threshold)"
    command.add_argument("--keep", metavar="N", type=int, help=help_keep)
    command.add_argument("--rings", metavar="N", type=int, help=f"rings of --neighbourhood fixed (default: {RINGS})")
    command.add_argument(
        "--shrink", action="store_true", help="freeze fewer faces where the target is too low for all of them"
    )
    help_weights = "weights of attributes in the error: colors=1,uv=1,normals=0.03 or some of them;"
    help_weights += " with colors=1, black and white differ as much as two ends of the mesh (default: nothing)"
    command.add_argument(
        "--attributes", metavar="NAME=WEIGHT,...", type=attribute_weights, default={}, help=help_weights
    )
    help_borders = "simplify the boundary, too: for scans and open surfaces, whose edges stay as they are otherwise"
    command.add_argument("--free-borders", action="store_true", help=help_borders)
    add_up(command)
    command.add_argument("--backend", choices=list(BACKENDS), default=BACKEND, help="default: %(default)s")
    command.add_argument(
        "--json",
        action="store_true",
        help="print the figures as JSON; mean, rms, max and salient are errors in percent of the diagonal",
    )
    command.add_argument("--seed", type=int, default=0, help="seed of the error samples (default: %(default)s)")
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
        raise argparse.ArgumentTypeError(f"{text!r}: write {percent}{match[1]}% or another share of the diagonal")
    if not value < 1:
        raise argparse.ArgumentTypeError(f"{text!r} is not a share of the diagonal: write one like 0.2% or 0.002")
    return value


def attribute_weights(text: str) -> dict[str, float]:
    """Weights by name from `colors=1,uv=0.5`; which ones a mesh has shows later."""
    try:
        return {name.strip(): float(weight) for name, weight in (pair.split("=") for pair in text.split(","))}
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r}: write names and weights such as colors=1,uv=0.5") from None


def check_paths(options: argparse.Namespace) -> None:
    """Raises ValueError where the result or the picture cannot be written, or would overwrite the mesh."""
    if not one_file(options):
        check_folder_of_several(options)
    elif options.out.suffix.lower() not in FORMATS:
        raise ValueError(f"--out {options.out}: meshes are written as {', '.join(FORMATS)}")
    elif options.format:
        raise ValueError("--format is for the files in a folder: --out says that of one file")
    check_outputs(options.mesh, options.out if one_file(options) else None, options.picture)
    if options.picture:
        from haptic_glance.lod.mesh_pictures import check_picture

        check_picture(options.picture)


def one_file(options: argparse.Namespace) -> bool:
    """Whether --out is a file, and not the folder of several."""
    return not options.levels and not options.mesh.is_dir()


def targets(options: argparse.Namespace) -> list[str]:
    """The face counts asked for; of a tolerance one text that names it."""
    return options.levels or [options.faces or f"within_{100 * options.tolerance:g}%"]


def check_folder_of_several(options: argparse.Namespace) -> None:
    """Raises ValueError where --out is no folder, or not another one than that of the meshes."""
    check_output_folder(options.out, options.mesh)
    if options.out.suffix.lower() in FORMATS:
        raise ValueError(f"--out {options.out}: name a folder, since there are several results")
    if options.picture:
        raise ValueError("--picture is for one result: use --faces, or leave it out")


def check_outputs(mesh: Path, *paths: Path | None) -> None:
    """Raises ValueError where one of the paths cannot be written, or would overwrite the mesh, another or materials.

    The materials beside an OBJ that exists are its own, unless the mesh refers to them.
    """
    outputs = [path for path in paths if path]
    needed = files_of(mesh)
    for path in outputs:
        if sum(output.resolve() == path.resolve() for output in outputs) > 1:
            raise ValueError(f"{path} is named for two results: write them to two files")
        if path.is_dir():
            raise ValueError(f"{path} is a folder: name a file")
        check_folder(path.parent, f"{path}: {path.parent}")
        if path.exists() and mesh.exists() and path.samefile(mesh):
            raise ValueError(f"{path} is the mesh itself, which would be overwritten: write to another file")
        for file in (path, *files_beside(path)):
            if file.exists() and any(file.samefile(other) for other in needed):
                raise ValueError(f"{file} belongs to {mesh.name}, and would be overwritten: choose another name")
            if file != path and not path.exists():
                raise ValueError(f"{file} is not of this mesh, and would be overwritten: choose another name")


def check_options(options: argparse.Namespace) -> None:
    """Raises ValueError for options without effect, unknown methods, and invalid counts."""
    if options.faces is not None:
        face_count(options.faces, name="--faces")
    if options.seed < 0:
        raise ValueError(f"--seed {options.seed}: give 0 or more")
    check_name(options.method, [PLAIN])
    freezing = {"--keep": options.keep, "--rings": options.rings, "--shrink": options.shrink or None}
    option = next((name for name, value in freezing.items() if value is not None), None)
    if options.method == PLAIN and (option or options.neighbourhood != SOFT):
        raise ValueError(f"{option or '--neighbourhood'} has no effect with --method {PLAIN}, which freezes nothing")
    if option and options.neighbourhood == SOFT:
        remedy = f"add --neighbourhood {' or '.join(NEIGHBOURHOODS)}, or leave it out"
        raise ValueError(f"{option} has no effect where no faces are frozen: {remedy}")
    if options.attributes and options.backend == "pymeshlab":
        raise ValueError("--attributes has no effect with --backend pymeshlab: choose fast or qslim")
    if options.free_borders and (options.attributes or options.backend == "pymeshlab"):
        option = "--attributes" if options.attributes else "--backend pymeshlab"
        raise ValueError(f"--free-borders has no effect with {option}: leave one of them out")
    if options.rings is not None and options.neighbourhood != "fixed":
        raise ValueError(f"--rings has no effect with --neighbourhood {options.neighbourhood}: it is for fixed")
    if options.keep is not None and options.keep < 1:
        raise ValueError(f"--keep {options.keep}: give 1 or more points; --method {PLAIN} keeps none")
    if options.rings is not None and options.rings < 0:
        raise ValueError(f"--rings {options.rings}: give 0 (the faces that touch a point) or more")
    if options.backend == "pymeshlab":  # the look before its first use may take minutes
        with about("--backend pymeshlab"), from_extra():
            import pymeshlab  # noqa: F401


MIN_EXTENT = 1e-60  # units: areas, and products of two, underflow near 1e-80


def run(argv: Sequence[str]) -> int:
    """Runs the command line `argv`, without the program's name; 1 where a level, or a mesh of a folder, failed."""
    options = parser().parse_args(argv)
    check_paths(options)
    check_options(options)
    files, figures, failed = mesh_files(options.mesh), [], []
    for path, name in zip(files, names_of(files), strict=True):
        try:
            with about(path):
                figures.append(simplify_file(path, name, options))
        except (ValueError, MissingExtra) as error:
            if not options.mesh.is_dir():
                raise
            report(str(error))
            failed.append(path.name)
    if options.json:
        print(json.dumps(figures))
    if failed:  # their reasons stand far above the last lines
        report(f"{len(failed)} of {len(files)} are left out: {', '.join(failed)}")
    return 0 if not failed and all(len(row["levels"]) == len(targets(options)) for row in figures) else 1


def simplify_file(path: Path, name: str, options: Namespace) -> dict[str, Any]:
    """Writes what is asked for of one file; prints its table, unless as JSON, and returns its figures."""
    if not one_file(options):
        check_outputs(
            path, *(level_path(options.out, name, path, target, options.format) for target in targets(options))
        )
    original, mesh = read(path, options.up)
    task, parts = prepare(mesh, options, path.stem), parts_of(path)
    by_target = {target: level for target in targets(options) if (level := reduce(task, options, target)) is not None}
    if not by_target:
        raise ValueError("no level is feasible")
    meshes = list(by_target.values())
    out_paths = [level_path(options.out, name, path, target, options.format) for target in by_target]
    if one_file(options):
        out_paths = [options.out]
    before = existing(*out_paths, *itertools.chain.from_iterable(map(files_beside, out_paths)), options.picture)
    written = []
    for out, level in zip(out_paths, meshes, strict=True):
        written += write_level(out, task, level, original, parts)
    heads, compared = list(by_target) if options.levels else [method_label(options)], [*meshes]
    if not options.levels and options.method != PLAIN and (rival := plain(task, len(meshes[0].faces))):
        heads, compared = [*heads, RIVAL], [*meshes, rival]
    hint_at_pictures(options, mesh)
    report("measuring the errors")
    errors = measure_meshes(task, compared, options.seed, report)
    if not options.json:
        print(summary(task, heads, compared, errors))
    if options.picture:
        draw(task, meshes[0], options.picture)
    report(said_of([path for path in (*written, options.picture) if path], before))
    rows = zip(out_paths, meshes, errors, strict=False)  # the rival's errors come last
    levels = [{"file": str(out), "faces": len(level.faces), **row} for out, level, row in rows]
    return {"mesh": str(path), "faces": len(task.mesh.faces), "levels": levels}


def hint_at_pictures(options: Namespace, mesh: Mesh) -> None:
    """Says once how the error can count a picture that it does not count."""
    counted = options.attributes or options.free_borders or options.backend == "pymeshlab" or "hinted" in options
    if not counted and mesh.texture and max(image.size for image in mesh.texture.images) > 4:
        options.hinted = True
        report("the error counts the shape alone; --attributes uv=1 counts the picture, too: compare the colours")


def write_level(out: Path, task: SimplificationTask, level: Mesh, original: Mesh, parts: Parts) -> list[Path]:
    """Writes one result in the file's coordinates, with the nodes of its scene, upright as its format has it.

    Returns the files that were written.
    """
    restored = task.restored(level)
    upright_mesh, note = upright_for(out, restored)
    written = write_with_files(out, upright_mesh, moved_parts(parts, original, restored))
    if note:
        report(note)
    suffix, texture = out.suffix.lower(), task.source.texture
    if suffix in COLORLESS and (texture or task.source.colors is not None):
        report(f"{out.suffix} files have no colours: write .glb, .obj or .ply to keep them")
    elif (
        suffix != ".glb" and texture and (names := {name for material in texture.materials for name in material or ()})
    ):
        colours = "colours of vertices" if suffix == ".ply" else "the colours of materials"
        report(f"{out.suffix} files have {colours} alone, dropped: {', '.join(sorted(names - COLOURS_OF))}")
    return written


def draw(task: SimplificationTask, level: Mesh, path: Path) -> None:
    """Writes the picture of the mesh before and after."""
    from haptic_glance.lod.mesh_pictures import write_picture

    points = task.points[task.points_kept(level)]
    write_picture(path, task.upright(task.mesh), task.upright(level), task.saliency, points, task.source.up)


def read(path: Path, up: str | None) -> tuple[Mesh, Mesh]:
    """(the mesh of a file, the same repaired), whose axis `up` points up; ValueError where it cannot be used."""
    report(f"reading {path.name}")
    original, note = upright_by(load_unnamed(path), path, up)
    extent = np.ptp(original.vertices, axis=0).max()
    if extent < MIN_EXTENT:
        raise ValueError(f"its extent is {extent:g}: export it in smaller units, or with more digits")
    if loss_note := dropped_from(path, original):
        report(loss_note)
    mesh, notes = repaired(original)
    report(number(len(mesh.faces), "face") + "".join(f"; {note}" for note in [note, *notes]))
    return original, mesh


def dropped_from(path: Path, mesh: Mesh) -> str:
    """The sentence that names the parts of a mesh's file that a Mesh has no place for; empty without such parts."""
    lost_parts = not_read(as_glb(path), mesh.colors is not None) + obj.not_read(path, mesh.colors is not None)
    return f"dropped from {path.name}, since they cannot be carried over: {', '.join(lost_parts)}" if lost_parts else ""


def prepare(mesh: Mesh, options: Namespace, name: str) -> SimplificationTask:
    """The SimplificationTask: saliency, and the points to keep."""
    faces, target = options.faces, len(mesh.faces)
    check_attributes(mesh, options.attributes)
    if faces and face_count(faces, target, "--faces") >= target:
        raise ValueError(f"--faces {faces}: the mesh has only {number(target, 'face')}, there is nothing to simplify")
    rendered = bake_texture(mesh)
    report("looking at it")
    method = "glance" if options.method == PLAIN else options.method
    with WallClock() as watch:
        values = saliency(rendered, method)
    report(f"saliency by {method} in {watch.seconds:.1f} s")
    points = np.zeros(0, dtype=np.int64)
    if options.neighbourhood != SOFT:
        points = find_points(rendered, method, options.keep, seed=options.seed, name=name)
        report(f"the faces around {number(len(points), 'point')} are frozen")
    rule = "fixed" if options.neighbourhood == SOFT else options.neighbourhood
    rings = neighbourhoods(mesh, points, rule, values, RINGS if options.rings is None else options.rings)
    soft = options.neighbourhood == SOFT and options.method != PLAIN
    weights = values if soft else None
    ways = options.backend, options.shrink, options.attributes, options.free_borders
    return SimplificationTask(mesh, values, points, rings, weights, *ways)


def reduce(task: SimplificationTask, options: Namespace, target: str) -> Mesh | None:
    """The Mesh with the face count `target`, or within the tolerance; None, with the reason reported, for a level."""
    report(
        "simplifying" + (f" to {100 * options.tolerance:g} % of the diagonal" if options.tolerance else f" to {target}")
    )
    total = len(task.mesh.faces)
    if options.levels and face_count(target, total) >= total:
        report(f"no level {target}: the mesh has only {number(total, 'face')}")
        return None
    try:
        if options.tolerance is None:
            return task.simplified(face_count(target, total, "--faces"))
        mesh = fewest_faces(task.mesh, task.simplified, task.lowest_target, options.tolerance, options.seed, report)
    except (InfeasibleTarget, SimplifyError) as error:
        if isinstance(error, InfeasibleTarget):
            reason = infeasible(task, error, options.neighbourhood)
        else:
            reason = f"{error}, or {FREE_BORDERS}" if may_free_borders(task) else str(error)
        if not options.levels:
            raise ValueError(reason) from None
        report(f"no level {target}: {reason}")
        return None
    if mesh is task.mesh:
        report("no simplified mesh is within the tolerance: all faces are kept")
    return mesh


def method_label(options: Namespace) -> str:
    """The name of the variant, as the stage `lod` has it."""
    return PLAIN if options.method == PLAIN else f"{options.method}-{options.neighbourhood}"


def plain(task: SimplificationTask, faces: int) -> Mesh | None:
    """The Mesh of as many faces by plain QEM; None, with the reason reported, where none is sound."""
    try:
        return task.plain(faces)
    except (InfeasibleTarget, SimplifyError) as error:
        report(f"no comparison with plain QEM: {error}")
        return None


def summary(task: SimplificationTask, heads: Sequence[str], meshes: Sequence[Mesh], errors: Sequence[dict]) -> str:
    """The table that the command prints: the mesh, and the meshes under their heads; the RIVAL keeps nothing."""
    kept = [None if head == RIVAL else mesh for head, mesh in zip(heads, meshes, strict=True)]
    rows: list[tuple] = [("faces", len(task.mesh.faces), *(len(mesh.faces) for mesh in meshes))]
    if len(task.points):
        rows += [("points kept", len(task.points), *(mesh and int(task.points_kept(mesh).sum()) for mesh in kept))]
    if len(task.border) and not task.free_borders:
        rows += [("border edges kept", len(task.border), *(mesh and task.border_edges_kept(mesh) for mesh in kept))]
    if len(task.points) or len(task.border):
        rows += [("fewest faces that keep them", None, *(mesh and task.smallest_with_borders for mesh in kept))]
    rows += [(NAMES[name], None, *(values[name] for values in errors)) for name in NAMES if name in errors[0]]
    return format_table(["before", *heads], rows)
