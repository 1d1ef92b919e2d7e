"""One mesh of the gallery: looked at once, and from that look simplified and touched."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial import KDTree

from haptic_glance.base.files import write_arrays, write_text
from haptic_glance.cli.saliency import as_csv, finely, nearest_vertices, points_of
from haptic_glance.cli.simplify import dropped_from
from haptic_glance.cli.touch import ARRAYS, TABLE, places_rows, saved_arrays
from haptic_glance.cli.touch import as_csv as places_csv
from haptic_glance.lod import InfeasibleTarget, SimplifyError, vertex_errors
from haptic_glance.lod.export import face_count, level_path, write_any
from haptic_glance.lod.mesh_pictures import coloured, look
from haptic_glance.lod.simplify import BACKEND
from haptic_glance.lod.task import SimplificationTask, infeasible, repaired
from haptic_glance.lod.topology import moved_parts, parts_of
from haptic_glance.look.points import detect
from haptic_glance.look.points import saliency as saliency_of
from haptic_glance.mesh.files import load_unnamed
from haptic_glance.mesh.materials import bake_texture
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.up import upright_by, upright_for
from haptic_glance.touch import normalise as as_images
from haptic_glance.touch import sensor_axes, touchable
from haptic_glance.touch.distances import distances_at
from haptic_glance.touch.places import UserMesh
from haptic_glance.touch.press import as_shown

CELLS, PITCH = (16, 16), 0.01  # as of `haptic-glance touch`


@dataclass(frozen=True)
class Level:
    """A simplified mesh in the frame of `haptic_glance.mesh.repair`, and the file that holds it in the file's own.

    error: (n,) distance of each vertex of the mesh to it, in % of the diagonal.
    """

    mesh: Mesh
    error: np.ndarray
    file: Path


@dataclass(frozen=True)
class Exhibit:
    """The findings on one mesh.

    touched: the mesh, repaired; note: up axis, repairs, and what levels lack. saliency (n,). points: rows of
    haptic_glance.cli.saliency.COLUMNS, most salient first. levels: finest first; missing: {level: why there is none}.
    touches: rows of places.csv, in the order of the points; images (k, rows, cols) in 0..1, 0 pressed first. picture:
    (h, w, 3) u1, coloured by saliency with the points numbered. units: of its lengths and positions.
    """

    name: str
    file: Path
    folder: Path
    touched: UserMesh
    note: str
    saliency: np.ndarray
    points: list[tuple]
    levels: list[Level]
    missing: dict[str, str]
    touches: list[dict[str, Any]]
    images: np.ndarray
    picture: np.ndarray
    units: str = "the file's units"


def exhibit(
    file: Path, name: str, folder: Path, up: str | None, count: int, levels: Sequence[str]
) -> Exhibit:  # fmt: skip
    """The Exhibit of a mesh file, its files written into a folder. ValueError where the file holds no usable mesh."""
    original, note = upright_by(load_unnamed(file), file, up)
    mesh, notes = repaired(original)  # before the first file: a mesh that cannot be repaired leaves none
    detection = detect(bake_texture(original), count=count)
    assert detection.saliency is not None  # glance has one
    points = points_of(original, detection)
    finer, shades = finely(original, detection.saliency)
    picture = look(finer, shades, nearest_vertices(finer, points))
    folder.mkdir(parents=True, exist_ok=True)
    write_any(folder / "saliency.ply", coloured(finer, shades))
    write_text(folder / "points.csv", as_csv(points, original))

    keeps_vertices = len(mesh.vertices) == len(original.vertices)
    values = detection.saliency if keeps_vertices else saliency_of(bake_texture(mesh))
    ladder, missing = simplified(mesh, values, levels, folder, file, name, original)
    user_mesh = UserMesh(mesh, name)
    touches, images = touch(user_mesh, points, folder)
    text = "; ".join(filter(None, [note, *notes, dropped_from(file, original)]))
    return Exhibit(name, file, folder, user_mesh, text, values, points, ladder, missing, touches, images, picture)


def simplified(
    mesh: Mesh, values: np.ndarray, levels: Sequence[str], folder: Path, file: Path, name: str, original: Mesh
) -> tuple[list[Level], dict[str, str]]:
    """(the Levels, written into the folder, {level: why there is none}) of a mesh by its saliency (n,)."""
    no_points = np.zeros(0, dtype=np.int64)
    task, parts = SimplificationTask(mesh, values, no_points, no_points, values, BACKEND, False), parts_of(file)
    ladder, missing = [], {}
    for target in levels:
        try:
            level = _reduced(task, face_count(target, len(mesh.faces), "--levels"))
        except InfeasibleTarget as error:
            missing[target] = infeasible(replace(task, free_borders=True), error)
            continue
        except SimplifyError as error:
            missing[target] = str(error)
            continue
        path, restored = level_path(folder, name, file, target), task.restored(level)
        write_any(path, upright_for(path, restored)[0], moved_parts(parts, original, restored))
        ladder.append(Level(level, 100 * vertex_errors(level, task.mesh) / task.mesh.diagonal, path))
    return ladder, missing


def _reduced(task, faces):
    """The task's level; where its frozen boundary leaves too many faces, that is simplified, too."""
    try:
        return task.simplified(faces)
    except InfeasibleTarget:
        return replace(task, free_borders=True).simplified(faces)


def touch(
    user_mesh: UserMesh, points: Sequence[tuple], folder: Path
) -> tuple[list[dict[str, Any]], np.ndarray]:  # fmt: skip
    """(rows of places.csv, images (k, rows, cols) as shown) of the array at those of the points that have a normal.

    Both are written into the folder; the index of a row is the rank of its point.
    """
    place = KDTree(user_mesh.source.vertices)
    vertices = np.asarray(place.query(np.array([row[2:5] for row in points]))[1])  # repairs may renumber them
    is_touchable = touchable(user_mesh.mesh, vertices)
    if not is_touchable.any():
        raise ValueError("no salient point has a normal, so nothing can be touched: does the mesh have an area?")
    places = user_mesh.places([str(vertex) for vertex in vertices[is_touchable]])
    axes = sensor_axes(places.normals)
    raw = distances_at(user_mesh.surface, places.positions, axes, CELLS, PITCH)
    images, rows = as_images(raw, PITCH), places_rows(user_mesh, places, raw)
    for row, rank in zip(rows, np.flatnonzero(is_touchable) + 1, strict=True):
        row["index"] = int(rank)
    write_arrays(folder / ARRAYS, **saved_arrays(user_mesh, places, axes, raw, images, PITCH))
    write_text(folder / TABLE, places_csv(rows, user_mesh.digits))
    return rows, as_shown(images, [row["relief"] for row in rows], PITCH)
