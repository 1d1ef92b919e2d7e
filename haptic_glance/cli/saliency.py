"""Prints where people look at one mesh, and the places to touch first.

Reads STL, OBJ, PLY, OFF, GLB or glTF, or with the extra `pipeline` a point cloud. Prints the salient points, most
salient first: vertex, position in the file's coordinates, score from 0 to 1 (the saliency around the point, never more
than that of the point before it). The mesh is left as it is; --out writes a copy coloured by saliency. The copy has
more vertices where edges are longer than a tenth of the object.

examples:
  haptic-glance saliency scan.stl
  haptic-glance saliency scan.stl --out look.ply --points points.csv --picture look.png
  haptic-glance saliency chair.glb --count 5 --json
  haptic-glance saliency chair.glb --weights chair_weights.ply
"""

import argparse
import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from scipy.spatial import KDTree

from haptic_glance.base import progress
from haptic_glance.base.extras import about
from haptic_glance.base.files import existing, said_of, write_text
from haptic_glance.base.lazy import trimesh
from haptic_glance.base.timing import WallClock
from haptic_glance.lod.export import FORMATS, write_any
from haptic_glance.lod.mesh_pictures import check_look, coloured, write_look
from haptic_glance.lod.topology import parts_of
from haptic_glance.lod.weight_files import check_suffix, write_weights
from haptic_glance.look.points import Detection, detect
from haptic_glance.look.points import saliency as saliency_of
from haptic_glance.look.points.find import HELP, check_name
from haptic_glance.look.points.methods import PURPOSES, method_for
from haptic_glance.look.weights.weights import GLANCE
from haptic_glance.mesh.files import load_unnamed
from haptic_glance.mesh.materials import bake_texture
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.rays import barycentric
from haptic_glance.mesh.repair import area_share, centre_and_radius, significant_digits
from haptic_glance.mesh.up import add_up, upright_by, upright_for

from .arguments import command_parser
from .simplify import check_outputs, dropped_from

LONG, FINE = 0.1, 0.02  # shares of the diameter: an edge that is long, and the longest of the finer copy
COLUMNS = ("rank", "vertex", "x", "y", "z", "score")


def parser() -> argparse.ArgumentParser:
    """The parser of the command line."""
    command = shared_parser("saliency", __doc__ or "")
    command.add_argument(
        "--out", metavar="FILE", type=Path, help=f"the coloured mesh: {', '.join(FORMATS[:2])} or .ply"
    )
    help_weights = "the mesh with the saliency of each vertex, as weights for other tools: .ply (Blender), .glb, .usda,"
    help_weights += " or .npz (meshoptimizer)"
    command.add_argument("--weights", metavar="FILE", type=Path, help=help_weights)
    command.add_argument("--points", metavar="FILE", type=Path, help="the points, as CSV")
    command.add_argument("--picture", metavar="FILE", type=Path, help="a picture of the saliency with the points")
    return command


def shared_parser(name: str, about: str) -> argparse.ArgumentParser:
    """The options that `saliency` and `points` share; about: the text of --help."""
    command = command_parser(name, about)
    command.set_defaults(name=name)
    command.add_argument("mesh", metavar="MESH", type=Path, help="the file to look at")
    command.add_argument(
        "--count",
        metavar="N",
        type=int,
        help="how many places to visit in turn (default: the peaks past the threshold, which may be other places)",
    )
    help_purpose = "look: where people look (default); touch: where one touch identifies the object best"
    command.add_argument("--purpose", choices=list(PURPOSES), default="look", help=help_purpose)
    command.add_argument("--method", help=HELP)
    add_up(command, "unknown: --method glance_any_pose")
    command.add_argument("--json", action="store_true", help="print the points as JSON")
    return command


def run(argv: Sequence[str]) -> None:
    """Runs the command line `argv`, without the program's name."""
    look_at(parser().parse_args(argv))


def look_at(options: argparse.Namespace) -> None:
    """Prints the points of a mesh and writes what else was asked for."""
    check(options)
    report(options, f"reading {options.mesh.name}")
    before = existing(options.out, options.points, options.picture, options.weights)
    with about(options.mesh):
        mesh, note = upright_by(load_unnamed(options.mesh), options.mesh, options.up)
        area_share(mesh)  # or there would be no points, and no reason
        report(options, "looking at it")
        with WallClock() as watch:
            detection = detect(mesh, options.method, options.count)
    assert detection.saliency is not None  # `check` lets no method pass that has none
    report(options, f"{len(mesh.faces):,} faces in {watch.seconds:.1f} s, {note}")
    rows = points_of(mesh, detection)
    if len(rows) < (options.count or 0):
        report(options, f"{len(rows)} of {options.count} places: the mesh has no more")
    if options.weights:
        upright_mesh, note = upright_for(options.weights, mesh)
        write_weights(options.weights, upright_mesh, detection.saliency, parts_of(options.mesh))
        loss_note = dropped_from(options.mesh, mesh) if options.weights.suffix.lower() == ".glb" else ""
        for text in filter(None, (note, loss_note)):
            report(options, text)
    if options.out or options.picture:
        write(options, *finely(bake_texture(mesh), detection.saliency, options.method), rows)
    elif options.points:
        write(options, mesh, detection.saliency, rows)
    if paths := [path for path in (options.out, options.points, options.picture, options.weights) if path]:
        report(options, said_of(paths, before))  # before the lines, whose reader may close the pipe
    print(json.dumps([dict(zip(COLUMNS, row, strict=True)) for row in rows]) if options.json else as_csv(rows, mesh))


def report(options: argparse.Namespace, text: str) -> None:
    """Prints progress to stderr, apart from the results."""
    progress.report(options.name, text)


def check(options: argparse.Namespace) -> None:
    """Raises ValueError for files that cannot be written, and for methods and counts that cannot be."""
    if options.out and options.out.suffix.lower() not in (".glb", ".obj", ".ply"):
        raise ValueError(f"--out {options.out}: a coloured mesh is written as .glb, .obj or .ply")
    if options.weights:
        check_suffix(options.weights)
    check_outputs(options.mesh, options.out, options.points, options.picture, options.weights)
    if options.picture:
        check_look(options.picture)
    if options.method is not None:
        check_name(options.method)
    options.method = method_for(options.purpose, options.method)
    if options.count is not None and options.count < 1:
        raise ValueError(f"--count {options.count}: give 1 or more")


def points_of(mesh: Mesh, detection: Detection) -> list[tuple]:
    """Rows of COLUMNS in the order of the Detection, with its scores; positions in the file's coordinates."""
    assert detection.scores is not None  # of methods that have a saliency
    rows = zip(
        detection.points.tolist(), mesh.vertices[detection.points].tolist(), detection.scores.tolist(), strict=True
    )
    return [(rank, vertex, *place, score) for rank, (vertex, place, score) in enumerate(rows, 1)]


def finely(mesh: Mesh, saliency: np.ndarray, method: str = GLANCE) -> tuple[Mesh, np.ndarray]:
    """(Mesh, saliency (n,)) to be drawn: the mesh, or a finer copy of one with long edges, as CAD programs write them.

    Values at the ends of a long triangle say nothing of the middle, over which colours would be smeared.
    """
    diameter = 2 * centre_and_radius(mesh)[1]
    ends = mesh.vertices[mesh.faces]
    if np.linalg.norm(ends - np.roll(ends, 1, axis=1), axis=2).max() <= LONG * diameter:
        return mesh, saliency
    vertices, faces, source = trimesh.remesh.subdivide_to_size(  # pyright: ignore[reportAssignmentType] (3, not 2)
        mesh.vertices, mesh.faces, FINE * diameter, max_iter=20, return_index=True
    )
    colors = None if mesh.colors is None else _colours_at(mesh, source, vertices, faces)
    fine = Mesh(vertices, faces, colors, up=mesh.up)
    return fine, saliency_of(fine, method)


def _colours_at(mesh, source, vertices, faces):
    """(n, 3) u1 the colours of a mesh at the vertices (n, 3) of faces (m, 3) that lie in its faces `source` (m,)."""
    colors, has_area = np.zeros((len(vertices), 3), dtype=np.uint8), mesh.face_areas[source] > 0
    faces, owners = faces[has_area], np.repeat(source[has_area], 3)  # a face without area has no coordinates within it
    shares = barycentric(mesh, owners, vertices[faces.ravel()])
    mixed = np.einsum("nk,nkc->nc", shares, mesh.colors[mesh.faces[owners]])
    colors[faces.ravel()] = mixed.round().clip(0, 255)
    return colors


def nearest_vertices(mesh: Mesh, rows: list[tuple]) -> np.ndarray:
    """(k,) i8 the vertices of a mesh at the positions of rows of `points_of`."""
    return np.asarray(
        KDTree(mesh.vertices).query(np.array([row[2:5] for row in rows]).reshape(-1, 3))[1], dtype=np.int64
    )


def as_csv(rows: list[tuple], mesh: Mesh) -> str:
    """The points of a mesh as lines of CSV, under a header: nine digits, and more where it lies far from the origin."""
    digits = significant_digits(mesh, 9)
    lines = (
        f"{rank},{vertex},{x:.{digits}g},{y:.{digits}g},{z:.{digits}g},{value:.6g}"
        for rank, vertex, x, y, z, value in rows
    )
    return "\n".join([",".join(COLUMNS), *lines])


def write(options: argparse.Namespace, mesh: Mesh, saliency: np.ndarray, rows: list[tuple]) -> None:
    """Writes the files that were asked for, but the weights."""
    if options.out:
        upright_mesh, note = upright_for(options.out, coloured(mesh, saliency))
        write_any(options.out, upright_mesh)
        if note:
            report(options, note)
    if options.picture:
        behind = write_look(options.picture, mesh, saliency, nearest_vertices(mesh, rows))
        if behind:
            report(
                options, f"{behind} of {len(rows)} points are behind, where {options.picture.name} does not show them"
            )
    if options.points:
        write_text(options.points, as_csv(rows, mesh) + "\n")
