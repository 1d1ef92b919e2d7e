"""The ground truth of an object of any collection."""

import hashlib
import sys
from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np
from scipy.spatial import KDTree

from haptic_glance.mesh.files import parse
from haptic_glance.mesh.mesh import Mesh
from stages.meshes.sources import FIXATION_MAPS, GAZE, GAZE_CLOUDS, INTEREST_POINTS, collection_files, match_files

from .annotations import annotations_on_vertices, marked_files
from .fixations import fixation_files, fixations_on_vertices
from .gaze import gaze_on_vertices, match_rows, read_cloud_gaze, read_gaze
from .interest_points import read_interest_points

PUBLISHED = (
    "gaze",
    "gaze_clouds",
    "interest_points",
    "fixation_maps",
)  # the sources whose collection holds ground truth

Files = list[tuple[str, Callable[[], bytes]]]  # (path, function that reads the bytes) of each


def ground_truth_amounts(name: str, source: str, mesh: Mesh, files: Files) -> np.ndarray | None:
    """(n,) f8 amounts at the vertices of the normalised mesh of an object, or None if it has no ground truth.

    name, source: the object, and the setting meshes.source that it was read with. files: of ground_truth_files. The
    amounts are seconds of gaze (source gaze), marks of the users (interest_points), densities of fixations by area
    (fixation_maps), or the number of annotators who marked a vertex (any other source).
    `spread_on_surface` turns them into a density. Raises ValueError when the ground truth does not fit the mesh.
    """
    if not files:
        return None
    amounts = READERS.get(source, _marks)(files, mesh)
    if len(amounts) != len(mesh.vertices):
        raise ValueError(f"{name}: the published mesh has {len(amounts)} vertices, this one {len(mesh.vertices)}")
    return amounts


def ground_truth_files(
    meshes: Iterable[tuple[str, Mesh]], source: str, published: str | Path, marks: Path
) -> dict[str, Files]:
    """{object: the files that its ground truth comes from} of the objects that have ground truth, in their order.

    meshes: (name, normalised mesh) of each; published: meshes.folder; marks: the folder of annotations.
    """
    if source not in PUBLISHED:
        return dict(marked_files(meshes, marks))
    files = published_files(source, published)
    return {name: files[name] for name, _ in meshes if name in files}


def digest(files: Files) -> str:
    """The hash of the content of files."""
    return hashlib.sha256(b"".join(hashlib.sha256(read()).digest() for _, read in files)).hexdigest()


def published_files(source: str, folder: str | Path) -> dict[str, Files]:
    """{object: the published files that its ground truth comes from}; {} for a source that has none.

    folder: meshes.folder. Raises FetchError when the collection is missing.
    """
    if source not in PUBLISHED:
        return {}
    if source == "interest_points":
        points = match_files(collection_files(folder, *INTEREST_POINTS), r"GROUND_TRUTH_B/([^/]+)\.mat")
        return {name: [file] for name, file in points.items()}
    if source == "fixation_maps":
        return fixation_files(collection_files(folder, *FIXATION_MAPS))
    if source == "gaze_clouds":
        clouds = match_files(collection_files(folder, *GAZE_CLOUDS), r"([^/]+)\.txt")
        return {name: [file] for name, file in clouds.items()}
    files = collection_files(folder, *GAZE)
    tables, models = match_files(files, r"dataset_[^/]+/([^/]+)\.txt"), match_files(files, r"Models_3D/([^/]+)\.obj")
    return {name: [tables[name], models[name]] for name in tables if name in models}


def _gaze(files, _):
    (path, table), (_, model) = files
    # Coordinates agree exactly only with the mesh as published; normalising keeps the order of the vertices.
    mesh = parse(model(), ".obj")
    positions, _, seconds = _named(path, read_gaze, table())
    vertex, distance = match_rows(mesh, positions)
    unmatched = np.flatnonzero(vertex < 0)
    amounts = gaze_on_vertices(mesh, positions, seconds)
    if len(unmatched):
        off, lines = distance[unmatched] / mesh.diagonal, ", ".join(str(row + 1) for row in unmatched[:3])
        print(
            f"{path}: {len(unmatched)} of {len(positions)} rows match no vertex and are left out, with"
            f" {seconds[unmatched].sum():.0f} of {seconds.sum():.0f} s of gaze; they are {off.min():.2%} to"
            f" {off.max():.2%} of the diagonal off; lines {lines}{', ...' if len(unmatched) > 3 else ''}",
            file=sys.stderr,
        )
    return amounts


def _gaze_clouds(files, _):
    ((path, content),) = files
    rows, surface = _named(path, read_cloud_gaze, content()), parse(content(), ".xyz")
    nearest = KDTree(surface.vertices).query(rows[:, :3])[1]
    return np.bincount(nearest, rows[:, 6], minlength=len(surface.vertices))


def _named(path, read, content):
    """What `read` makes of the bytes; its ValueError gets the name of the file."""
    try:
        return read(content)
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None


def _marks(files, mesh):
    ((path, content),) = files
    return annotations_on_vertices(mesh, path, content())


def _interest_points(files, mesh):
    ((path, content),), count = files, len(mesh.vertices)
    vertices, marks = _named(path, read_interest_points, content())
    if vertices.max(initial=-1) >= count:
        raise ValueError(f"{path} names vertex {vertices.max()}, the mesh has {count}")
    return np.bincount(vertices, marks, minlength=count)


READERS = {
    "gaze": _gaze,
    "gaze_clouds": _gaze_clouds,
    "interest_points": _interest_points,
    "fixation_maps": fixations_on_vertices,
}
