"""A mesh file prepared for touching, and the requested places on it."""

from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from haptic_glance.look.points import find_points
from haptic_glance.mesh import clean, normalise, rotate_to_z_up
from haptic_glance.mesh.axes import to_z_up
from haptic_glance.mesh.files import load_unnamed
from haptic_glance.mesh.mesh import Mesh, unit
from haptic_glance.mesh.repair import RADIUS, centre_and_radius, significant_digits
from haptic_glance.mesh.up import upright_by

from .section import MAX_OFFSET, snap_to_surface
from .surface import CANCELLED, Surface, mean_vertex_normals, sensor_normals, touchable

DEFAULT_COUNT = 6  # of the salient or random places, where a person names none


@dataclass(frozen=True)
class Places:
    """Places of the array: vertices (k,) i8, -1 if not at a vertex; positions, normals (k, 3) in the mesh's frame.

    note: a remark on the choice for the user, or empty.
    """

    vertices: np.ndarray
    positions: np.ndarray
    normals: np.ndarray
    note: str = ""


NEAR = 0.01  # units, one cell of the default array: within it a point belongs to its vertex


def place_at(surface: Surface, points: np.ndarray, faces: np.ndarray) -> Places:
    """Places of points (k, 3) that lie in faces (k,).

    A point within NEAR of a corner of its face is moved to this vertex, with the normal that `press` has there. A
    single face of a fine scan is no guide to how an array lies on it. On a large face the normal is the face's own.
    """
    mesh, rows = surface.mesh, np.arange(len(points))
    corners = mesh.faces[faces]
    distances = np.linalg.norm(mesh.vertices[corners] - points[:, None], axis=2)
    nearest = distances.argmin(axis=1)
    vertices = corners[rows, nearest]
    averages = mean_vertex_normals(mesh)[vertices]
    at_vertex = (distances[rows, nearest] <= NEAR) & (np.linalg.norm(averages, axis=1) > CANCELLED)
    return Places(
        np.where(at_vertex, vertices, -1),
        np.where(at_vertex[:, None], mesh.vertices[vertices], points),
        np.where(at_vertex[:, None], unit(averages), mesh.face_normals[faces]),
    )


@dataclass(frozen=True)
class UserMesh:
    """source: the Mesh in the file's units and axes, cleaned; name: the file's stem."""

    source: Mesh
    name: str

    @cached_property
    def upright(self) -> Mesh:
        """The mesh turned to z up, in the file's units."""
        return rotate_to_z_up(self.source)

    @cached_property
    def mesh(self) -> Mesh:
        """The mesh that the array touches: upright, centred, its bounding sphere 1 unit across."""
        return replace(normalise(self.upright), texture=None)

    @cached_property
    def surface(self) -> Surface:
        """The Surface of `mesh`."""
        return Surface(self.mesh)

    @property
    def unit(self) -> float:
        """One unit of the mesh, in units of the file."""
        return centre_and_radius(self.upright)[1] / RADIUS

    @property
    def digits(self) -> int:
        """Significant digits of the file's coordinates that resolve a 100,000th of the object."""
        return significant_digits(self.source, 6)

    def to_file(self, positions: np.ndarray) -> np.ndarray:
        """Positions (k, 3) in the mesh's frame, converted to the file's coordinates."""
        return self.to_file_directions(positions * self.unit + centre_and_radius(self.upright)[0])

    def to_file_directions(self, directions: np.ndarray) -> np.ndarray:
        """Directions (k, 3) in the mesh's frame, converted to the file's axes."""
        return directions @ to_z_up(self.source.up)

    def from_file(self, positions: np.ndarray) -> np.ndarray:
        """Positions (k, 3) in the file's coordinates, converted to the mesh's frame."""
        return (positions @ to_z_up(self.source.up).T - centre_and_radius(self.upright)[0]) / self.unit

    def places(self, at: list[str], count: int | None = None, method: str | None = None, seed: int = 0) -> Places:
        """The Places for the arguments of --at: `salient`, `random`, ids of vertices, positions x,y,z of the file."""
        if at[0] in ("salient", "random"):
            method = (method or "glance") if at[0] == "salient" else "random"
            return self._selected(method, count or DEFAULT_COUNT, seed)
        placed = [self._at_point(word) if "," in word else self._at_vertex(word) for word in at]
        vertices, positions, normals = zip(*placed, strict=True)
        return Places(np.array(vertices), np.concatenate(positions), np.concatenate(normals))

    def _selected(self, method, count, seed):
        vertices = find_points(self.source, method, count, seed=seed)
        placed, vertices = len(vertices), vertices[touchable(self.mesh, vertices)]
        note = f"{len(vertices)} of {count} places: the mesh has no more" if placed < count else ""
        note = f"{len(vertices)} of {count} places: the others have no normal" if len(vertices) < placed else note
        if len(vertices) == 0:
            raise ValueError(f"{method} finds no place that can be touched: give ids of vertices, or positions")
        return Places(vertices, self.mesh.vertices[vertices], sensor_normals(self.mesh, vertices), note)

    def _at_vertex(self, word):
        try:
            vertex = int(word)
        except ValueError:
            remedy = "write salient, random, the id of a vertex, or a position x,y,z"
            raise ValueError(f"--at {word}: {remedy}") from None
        count = len(self.mesh.vertices)
        if not 0 <= vertex < count:
            raise ValueError(f"--at {word}: no such vertex; the mesh has 0 to {count - 1}")
        return vertex, self.mesh.vertices[[vertex]], sensor_normals(self.mesh, [vertex])

    def _at_point(self, word):
        try:
            source = np.array([[float(part) for part in word.split(",")]])
        except ValueError:
            source = np.zeros((1, 0))
        if source.shape != (1, 3) or not np.isfinite(source).all():
            raise ValueError(f"--at {word.strip()}: a position is three numbers x,y,z without spaces")
        target = self.from_file(source)
        positions, normals = snap_to_surface(self.surface, target, tolerance=np.inf)
        distance, limit = np.linalg.norm(positions - target), MAX_OFFSET * self.mesh.diagonal
        if distance > limit:
            nearest = ",".join(f"{value:.{self.digits}g}" for value in self.to_file(positions)[0])
            raise ValueError(
                f"--at {word.strip()} is off the mesh, by {distance * self.unit:.4g} in the file's units (the limit "
                f"is {limit * self.unit:.4g}); the nearest place is --at {nearest}"
            )
        return -1, positions, normals


def read_user_mesh(path: Path, up: str | None) -> tuple[UserMesh, list[str]]:
    """(UserMesh, notes, the first on the axis that points up) of a file; up: that axis, None for what the file says."""
    mesh, note = upright_by(load_unnamed(path), path, up)
    mesh, notes = clean(mesh)
    return UserMesh(mesh, path.stem), [note, *notes]
