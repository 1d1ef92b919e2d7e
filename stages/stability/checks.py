"""Whether a simplified mesh is sound, checked by trimesh and numpy and not by the simplifiers' own functions."""

import numpy as np
import point_cloud_utils as pcu
import trimesh

from haptic_glance.mesh.mesh import Mesh

from .surface import FLAT, Surface

COUNTS = {  # counts of a Surface that simplification must not increase -> their names in messages
    "degenerate_faces": "faces without area",
    "folds": "folds",
    "duplicate_faces": "duplicate faces",
    "non_manifold_edges": "non-manifold edges",
    "non_manifold_vertices": "non-manifold vertices",
}
SAMPLES = 2000  # points on each surface: the mean error is then exact to 3 %


def find_faults(old: Surface, found: Mesh, faces: int, kept_vertices: np.ndarray, kept_faces: np.ndarray) -> list[str]:
    """The faults of a simplified mesh as phrases, [] when it is sound.

    old: the surface before simplification; found: the result; faces: the number of faces asked for; kept_vertices (k,)
    ids and kept_faces (j, 3): what must survive bit for bit. A simplifier may first remove duplicate faces and faces
    that name a vertex twice: boundary and connected components may be those of the mesh with or without them.
    """
    if len(found.faces) == 0:
        return ["no face left"]
    before, new, said = old.mesh, Surface(found), []
    if len(found.faces) > faces:
        said.append(f"{len(found.faces)} faces, {faces} asked")
    lost = _missing(before.vertices[kept_vertices], found.vertices[np.unique(found.faces)])
    if lost:
        said.append(f"{lost} kept vertices lost")
    lost = _missing(_triples(before.vertices[kept_faces]), _triples(found.vertices[found.faces]))
    if lost:
        said.append(f"{lost} kept faces lost")
    if new.boundary_edges not in (old.boundary_edges, old.deduplicated.boundary_edges):
        said.append(f"boundary changed in {len(new.boundary_edges ^ old.boundary_edges)} edges")
    if new.components not in (old.components, old.deduplicated.components):
        said.append(f"{new.components} connected components instead of {old.components}")
    for name, words in COUNTS.items():
        more = np.min(getattr(new, name) - getattr(old, name))  # folds are counted in two ways
        if more > 0:
            said.append(f"{more} new {words}")
    if old.closed and not new.closed:
        said.append("no longer closed")
    elif old.closed and old.volume * new.volume < 0:
        said.append("inside out")
    return said


def surface_error(before: Mesh, found: Mesh) -> float:
    """The mean distance of two surfaces, the larger of both directions, over the diagonal of the first (T3.1.4).

    Measured at points drawn uniformly by area, or at the corners of the faces where a mesh has no area.
    """
    place, size = before.vertices[before.faces[0, 0]], before.diagonal or 1.0
    one, other = (
        trimesh.Trimesh((mesh.vertices - place) / size, mesh.faces, process=False) for mesh in (before, found)
    )
    return max(_mean_distance(one, other), _mean_distance(other, one))


def _mean_distance(one, other):
    has_area = one.area > FLAT**2
    points = trimesh.sample.sample_surface(one, SAMPLES, seed=0)[0] if has_area else one.triangles.reshape(-1, 3)
    faces = np.ascontiguousarray(other.faces, dtype=np.int64)
    apart = pcu.closest_points_on_mesh(np.ascontiguousarray(points), np.ascontiguousarray(other.vertices), faces)[0]
    return float(np.mean(apart))


def _missing(rows, among):
    """How many of the rows (k, d) are not bit for bit among the others."""
    have = {row.tobytes() for row in np.ascontiguousarray(among)}
    return sum(row.tobytes() not in have for row in np.ascontiguousarray(rows))


def _triples(corners):
    """(j, 9): the corners (j, 3, 3) of each triangle sorted by position, so that equal triangles give equal rows."""
    order = np.lexsort(corners.transpose(2, 0, 1)[::-1], axis=-1)
    return np.take_along_axis(corners, order[:, :, None], axis=1).reshape(-1, 9)
