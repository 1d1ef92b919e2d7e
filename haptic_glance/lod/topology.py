"""Topology of a surface (loops, components, genus), faults that a simplification must not add, and nodes of a GLB."""

import io
import re
from dataclasses import astuple, dataclass
from pathlib import Path

import numpy as np

from haptic_glance.base.lazy import trimesh
from haptic_glance.mesh.gltf import SUFFIXES, as_glb
from haptic_glance.mesh.mesh import Mesh, next_half_edge, unit
from haptic_glance.mesh.nearest import SurfaceIndex

from .attributes import faces_under
from .kernels.mesh import count_faults, face_components, opposites, signed_volumes, split_fans

FOLD = -0.99  # cosine between neighbouring normals: folded back within 8 degrees of flat
THIN = 1e-7  # height of a face over the bounding-box diagonal, below which it counts as degenerate


@dataclass(frozen=True)
class Topology:
    """Counts of a surface: boundary edges and loops, components (joined by edges), closed ones of them, genus."""

    boundary_edges: int
    boundary_loops: int
    components: int
    closed_components: int
    genus: int


@dataclass(frozen=True)
class Faults:
    """Counts of degenerate faces, folded pairs of neighbours, half-edges on non-manifold edges, and closed components
    that are inside out."""

    degenerate: int
    folded: int
    non_manifold: int
    inverted: int

    def added(self, before: "Faults") -> str:
        """The faults in excess of `before`, in words; empty when there are none."""
        names = (
            "degenerate faces",
            "folded pairs of faces",
            "half-edges on non-manifold edges",
            "components inside out",
        )
        ours, theirs = astuple(self), astuple(before)
        return ", ".join(f"{a - b} new {name}" for name, a, b in zip(names, ours, theirs, strict=True) if a > b)


NONE = Faults(degenerate=0, folded=0, non_manifold=0, inverted=0)


def faults(mesh: Mesh) -> Faults:
    """The Faults of a mesh."""
    if len(mesh.faces) == 0:
        return NONE
    ids, opposite, non_manifold = half_edges(mesh.faces)
    degenerate, folded = count_faults(mesh.vertices, ids, opposite, THIN * mesh.diagonal, FOLD)
    inverted = int((signed_volumes(mesh.vertices, ids, opposite) < -THIN * mesh.diagonal**3).sum())
    return Faults(degenerate, folded, non_manifold, inverted)


def topology(faces: np.ndarray) -> Topology:
    """The Topology of the surface made of faces (m, 3).

    Components that touch only in a vertex or in a non-manifold edge count as separate.
    """
    ids, opposite, _ = half_edges(faces)
    fan, n = split_fans(ids, opposite)
    component, count = face_components(opposite)
    boundary = np.flatnonzero(opposite < 0)
    open_components = len(np.unique(component[boundary // 3]))
    loops = face_components(_joined_ends(fan[np.stack([boundary, next_half_edge(boundary)], axis=1)]))[1]
    euler = n - (len(ids) + len(boundary)) // 2 + len(faces)
    genus = max((2 * count - loops - euler) // 2, 0)
    return Topology(len(boundary), loops, count, count - open_components, genus)


def _joined_ends(fans):
    """Like `opposites`, with edges in the place of faces: the boundary edges of fans (b, 2) joined end to end.

    An open fan of faces has two such ends, so that sorted by fan they are in pairs.
    """
    pairs = np.argsort(fans, axis=None).reshape(-1, 2)
    pairs += pairs // 2  # the ends of edge e become 3 e and 3 e + 1
    partners = np.full(3 * len(fans), -1, dtype=np.int32)
    partners[pairs] = pairs[:, ::-1]
    return partners


def half_edges(faces: np.ndarray) -> tuple[np.ndarray, np.ndarray, int]:
    """Faces (3 m,) i4, the opposite of each half-edge (3 m,) i4, and how many half-edges lie on non-manifold edges.

    Half-edge 3 f + k runs from corner k of face f to the next. Its opposite is -1 unless exactly two faces share it.
    """
    ids = faces.astype(np.int32).ravel()
    opposite, non_manifold = opposites(ids, int(faces.max(initial=-1)) + 1, False)
    return ids, opposite, non_manifold


def split_nonmanifold_vertices(faces: np.ndarray) -> np.ndarray:
    """Faces (m, 3) with new vertex ids: one vertex per fan of faces where several fans touch in a vertex.

    Non-manifold edges become boundary edges.
    """
    ids, opposite, _ = half_edges(faces)
    return split_fans(ids, opposite)[0].reshape(-1, 3).astype(np.int64)


CREASE = 0.5 + 1e-6  # cosine between two faces that meet at 60 degrees or more, but for rounding: an edge to be seen


def shading(mesh: Mesh) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(faces (m, 3), vertices (k,), normals (k, 3)) to shade a mesh smoothly but for its creases.

    The corners of a vertex share one vertex unless a crease or a non-manifold edge or vertex divides them. The first n
    vertices are the mesh's own, then come the copies; vertices: the id of each in the mesh. The normals, of length 1,
    are means of those of the faces by area, or (0, 0, 1) where faces have none. A degenerate face makes no crease.
    """
    ids, opposite, _ = half_edges(mesh.faces)
    inner = np.flatnonzero(opposite >= 0)
    normals = _facing(mesh, opposite)
    sharp = np.einsum("ij,ij->i", normals[inner // 3], normals[opposite[inner] // 3]) < CREASE
    opposite[inner[sharp]] = -1
    fans, count = split_fans(ids, opposite)
    vertex = np.zeros(count, dtype=np.int64)
    vertex[fans] = ids
    new, first = np.full(count, -1), np.unique(vertex, return_index=True)[1]
    new[first] = vertex[first]
    copies = np.flatnonzero(new < 0)
    new[copies] = len(mesh.vertices) + np.arange(len(copies))
    corners, vertices = new[fans], np.r_[np.arange(len(mesh.vertices)), vertex[copies]]
    total = np.stack(
        [np.bincount(corners, np.repeat(column, 3), len(vertices)) for column in mesh.face_crosses.T], axis=1
    )
    total[~total.any(axis=1)] = [0.0, 0.0, 1.0]
    return corners.reshape(-1, 3), vertices, unit(total)


def _facing(mesh, opposite):
    """(m, 3) unit normals; a degenerate face has that of its neighbour across the longest edge, or zero at a border."""
    corners, normals = mesh.vertices[mesh.faces], mesh.face_normals.copy()
    lengths = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
    flat = np.flatnonzero(2 * mesh.face_areas <= THIN * mesh.diagonal * lengths.max(axis=1))
    beside = opposite[3 * flat + lengths[flat].argmax(axis=1)] // 3
    normals[flat] = np.where(beside[:, None] < 0, 0, normals[beside])
    return normals


Parts = dict[str, np.ndarray]  # name of a node -> (k,) ids of faces
RANDOM_END = re.compile("_[0-9a-f]{6}$")  # trimesh adds it to the node's name for each of several primitives


def parts_of(path: Path) -> Parts:
    """The Parts of a file's mesh, as `haptic_glance.mesh.files` joins them; empty unless it is a GLB or .gltf."""
    if path.suffix.lower() not in SUFFIXES:
        return {}
    content, beside = io.BytesIO(as_glb(path)), trimesh.resolvers.FilePathResolver(str(path))
    loaded = trimesh.load(content, file_type="glb", resolver=beside, process=False, skip_materials=True)
    dumped = loaded.dump() if isinstance(loaded, trimesh.Scene) else []
    parts, start = {}, 0
    for part in dumped:
        count = len(part.faces) if isinstance(part, trimesh.Trimesh) else 0
        if count:
            name = str(part.metadata.get("node", path.stem))
            if part.metadata.get("from_gltf_primitive"):
                name = RANDOM_END.sub("", name)
            parts[name] = np.r_[parts.get(name, np.zeros(0, dtype=np.int64)), start : start + count]
        start += count
    return parts


def moved_parts(parts: Parts, mesh: Mesh, simplified: Mesh) -> Parts:
    """The Parts of a simplified mesh: each of its faces goes where the closest face of `mesh` belongs, which `parts`
    are of. Nodes without a face are left out.
    """
    if len(parts) < 2:
        return {name: np.arange(len(simplified.faces)) for name in parts}
    names = list(parts)
    owner = np.zeros(len(mesh.faces), dtype=np.int64)
    for number, name in enumerate(names):
        owner[parts[name]] = number
    _, face = faces_under(SurfaceIndex(mesh), simplified)
    faces_by_part = {name: np.flatnonzero(owner[face] == number) for number, name in enumerate(names)}
    return {name: ids for name, ids in faces_by_part.items() if len(ids)}
