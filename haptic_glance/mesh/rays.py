"""Ray casting against a triangle mesh, on embree."""

from dataclasses import dataclass

import numpy as np
from embreex import rtcore_scene
from embreex.mesh_construction import TriangleMesh

from .mesh import Mesh

FAR = 10.0  # of its longest side: farther from the origin a mesh is moved to it, or single precision would bend it


@dataclass(frozen=True)
class Hits:
    """First hits of k rays: distance (k,) f8, inf where missed; face (k,) i8, -1 where missed."""

    distance: np.ndarray
    face: np.ndarray

    @property
    def hit(self) -> np.ndarray:
        """(k,) boolean: the ray met the mesh."""
        return self.face >= 0


class RayScene:
    """A mesh made ready for rays; build it once per mesh, never send it to another process (embree cannot pickle).

    Distances are refined in double precision against the hit face's plane (Moeller and Trumbore 1997, T [221]), since
    embree itself works in single precision.
    """

    def __init__(self, mesh: Mesh) -> None:
        self.mesh = mesh
        self._scene = rtcore_scene.EmbreeScene(robust=True)  # pyright: ignore[reportAttributeAccessIssue] (no stub)
        corners = mesh.vertices[mesh.faces]
        self._middle = _far_middle(corners.reshape(-1, 3))
        triangles = (corners - self._middle).astype(np.float32)
        self._geometry = TriangleMesh(self._scene, triangles) if len(triangles) else None
        offsets = np.einsum("ij,ij->i", mesh.face_normals, mesh.vertices[mesh.faces[:, 0]])
        self._planes = np.column_stack([mesh.face_normals, offsets])  # one gather per hit instead of three

    def cast(self, origins: np.ndarray, directions: np.ndarray) -> Hits:
        """First hits of rays from origins (k, 3) along unit directions (k, 3), both sides of a face counted."""
        origins = np.ascontiguousarray(origins, dtype=np.float64)
        directions = np.ascontiguousarray(directions, dtype=np.float64)
        if self._geometry is None or len(origins) == 0:
            return Hits(np.full(len(origins), np.inf), np.full(len(origins), -1, dtype=np.int64))
        near = (origins - self._middle).astype(np.float32)
        face = self._scene.run(near, directions.astype(np.float32)).astype(np.int64)
        distance = np.full(len(origins), np.inf)
        hit = np.flatnonzero(face >= 0)
        planes = self._planes[face[hit]]
        along = np.einsum("ij,ij->i", planes[:, :3], directions[hit])
        height = planes[:, 3] - np.einsum("ij,ij->i", planes[:, :3], origins[hit])
        # A ray in the plane of its face has no single crossing point: it counts as a miss.
        grazing = np.abs(along) <= 1e-12
        face[hit[grazing]] = -1
        distance[hit[~grazing]] = height[~grazing] / along[~grazing]
        return Hits(distance, face)


def _far_middle(points):
    """The middle of the points, or 0 where they are near the origin."""
    if not len(points):
        return np.zeros(3)
    low, high = points.min(axis=0), points.max(axis=0)
    middle = (low + high) / 2
    return middle if np.abs(middle).max() > FAR * (high - low).max() else np.zeros(3)


def barycentric(mesh: Mesh, faces: np.ndarray, points: np.ndarray) -> np.ndarray:
    """(k, 3) barycentric coordinates of points (k, 3), each in the plane of its face of faces (k,)."""
    a, b, c = mesh.vertices[mesh.faces[faces]].transpose(1, 0, 2)
    normal = mesh.face_crosses[faces]
    square = np.maximum(np.einsum("ij,ij->i", normal, normal), np.finfo(float).tiny)
    wb = np.einsum("ij,ij->i", np.cross(points - a, c - a), normal) / square
    wc = np.einsum("ij,ij->i", np.cross(b - a, points - a), normal) / square
    return np.stack([1 - wb - wc, wb, wc], axis=1)
