"""Is a simplified mesh sound? Asked of trimesh and numpy, not of the functions that simplifiers ask themselves."""

import numpy as np
import point_cloud_utils as pcu
import trimesh

from .surface import FLAT, Surface

COUNTS = {  # of a Surface, that may not grow
    "flat_faces": "faces without area", "folds": "folds", "copies": "copies of faces", "crowded": "crowded edges",
    "pinches": "pinches",
}  # fmt: skip
SAMPLES = 2000  # points on each surface: the mean error within 3 %


def complaints(old, found, faces, kept_vertices, kept_faces):
    """What a result owes and has not, in words: [] when it is sound.

    old: Surface; found: Mesh; faces: what was asked for; kept_vertices (k,) ids and kept_faces (j, 3), which must have
    survived bit for bit. A simplifier may first throw out copies of faces and faces that name a vertex twice: boundary
    and pieces are held against the mesh with or without them.
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
    if new.border not in (old.border, old.tidy.border):
        said.append(f"boundary changed in {len(new.border ^ old.border)} edges")
    if new.pieces not in (old.pieces, old.tidy.pieces):
        said.append(f"{new.pieces} pieces, were {old.pieces}")
    for name, words in COUNTS.items():
        more = np.min(getattr(new, name) - getattr(old, name))  # folds: new in both ways of counting
        if more > 0:
            said.append(f"{more} new {words}")
    if old.closed and not new.closed:
        said.append("no more closed")
    elif old.closed and old.volume * new.volume < 0:
        said.append("inside out")
    return said


def surface_error(before, found):
    """The mean distance of two surfaces, the larger of both directions, over the diagonal of the first (T3.1.4).

    Of points drawn evenly by area; of the corners where a mesh has no area.
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
    """How many of the rows (k, d) are not among the others, bit for bit."""
    have = {row.tobytes() for row in np.ascontiguousarray(among)}
    return sum(row.tobytes() not in have for row in np.ascontiguousarray(rows))


def _triples(corners):
    """(j, 9) of the corners (j, 3, 3) of triangles, in the order of their places: equal for equal triangles."""
    order = np.lexsort(corners.transpose(2, 0, 1)[::-1], axis=-1)
    return np.take_along_axis(corners, order[:, :, None], axis=1).reshape(-1, 9)
