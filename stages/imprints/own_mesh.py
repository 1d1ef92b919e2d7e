"""A person's own mesh, ready to be touched, and the places on it that were asked for."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from stages.kit import Mesh
from stages.meshes import clean, load, normalise, turn_up
from stages.meshes.normalise import RADIUS, TO_Z_UP, frame
from stages.salient_points import find_points

from .frame import sensor_normals, touchable
from .options import COUNT
from .place import OFF, place
from .surface import Surface


@dataclass(frozen=True)
class Places:
    """Where the array is put: vertices (k,) i8, -1 where it is at none; positions, normals (k, 3) in the mesh's frame.

    note: what a person should know of the choice, or nothing.
    """

    vertices: np.ndarray
    positions: np.ndarray
    normals: np.ndarray
    note: str = ""


@dataclass(frozen=True)
class OwnMesh:
    """given: the Mesh in the file's units and axes, cleaned; up: its axis that points up; name: the file's stem."""

    given: Mesh
    up: str
    name: str

    @cached_property
    def mesh(self):
        """The mesh upright, centred, its bounding sphere 1 unit across: what the array touches."""
        found = normalise(turn_up(self.given, self.up))
        return Mesh(found.vertices, found.faces, found.colors)

    @cached_property
    def surface(self):
        """The Surface of `mesh`."""
        return Surface(self.mesh)

    @property
    def unit(self):
        """One unit of the array's pitch, in units of the file."""
        return frame(self.given)[1] / RADIUS

    @property
    def digits(self):
        """Significant digits of the file's coordinates that tell places a 100,000th of the object apart."""
        far = np.abs(frame(self.given)[0]).max() / self.unit
        return min(6 + int(np.ceil(np.log10(max(far, 1)))), 17)

    def to_file(self, positions):
        """Positions (k, 3) of the mesh's frame in the file's coordinates."""
        return self.to_file_directions(positions) * self.unit + frame(self.given)[0]

    def to_file_directions(self, directions):
        """Directions (k, 3) of the mesh's frame along the file's axes."""
        return directions @ TO_Z_UP[self.up]

    def from_file(self, positions):
        """Positions (k, 3) in the file's coordinates in the mesh's frame."""
        return (positions - frame(self.given)[0]) / self.unit @ TO_Z_UP[self.up].T

    def places(self, at, count=None, method=None, seed=0):
        """The Places of the words behind --at: `salient`, `random`, ids of vertices, positions x,y,z of the file."""
        if at[0] in ("salient", "random"):
            method = (method or "enhanced") if at[0] == "salient" else "random"
            return self._chosen(method, count or COUNT, seed)
        found = [self._at_point(word) if "," in word else self._at_vertex(word) for word in at]
        vertices, positions, normals = zip(*found, strict=True)
        return Places(np.array(vertices), np.concatenate(positions), np.concatenate(normals))

    def _chosen(self, method, count, seed):
        vertices = find_points(self.mesh, method, count, seed=seed, name=self.name)
        found, vertices = len(vertices), vertices[touchable(self.mesh, vertices)]
        note = f"{len(vertices)} of {count} places: the mesh has no more" if found < count else ""
        note = f"{len(vertices)} of {count} places: the others have no normal" if len(vertices) < found else note
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
            raise ValueError(f"--at {word}: it has no such vertex, its {count:,} are 0 to {count - 1}")
        return vertex, self.mesh.vertices[[vertex]], sensor_normals(self.mesh, [vertex])

    def _at_point(self, word):
        try:
            given = np.array([[float(part) for part in word.split(",")]])
        except ValueError:
            given = np.zeros((1, 0))
        if given.shape != (1, 3) or not np.isfinite(given).all():
            raise ValueError(f"--at {word.strip()}: a position is three numbers x,y,z without blanks")
        wanted = self.from_file(given)
        positions, normals = place(self.surface, wanted, tolerance=np.inf)
        off, most = np.linalg.norm(positions - wanted), OFF * self.mesh.diagonal
        if off > most:
            nearest = ",".join(f"{value:.{self.digits}g}" for value in self.to_file(positions)[0])
            raise ValueError(
                f"--at {word.strip()} is off the mesh, by {off * self.unit:.4g} in the file's units (at most "
                f"{most * self.unit:.4g} is taken for on it); the nearest place is --at {nearest}"
            )
        return -1, positions, normals


def read(path, up):
    """(OwnMesh, notes) of a file; up: its axis that points up, None for y in a GLB and z elsewhere."""
    if not path.is_file():
        raise ValueError("is a folder, not a mesh" if path.is_dir() else "no such file")
    mesh, notes = clean(load(path))
    return OwnMesh(mesh, up or ("y" if path.suffix.lower() == ".glb" else "z"), path.stem), notes
