"""One mesh on the table, from file and to file, and everything that was found on it, computed when first asked for."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import RLock

import numpy as np

from haptic_glance.base.files import read_mesh
from haptic_glance.cli.saliency import finely, points_of
from haptic_glance.lod.export import write_any
from haptic_glance.lod.weight_files import write_weights
from haptic_glance.look.points import METHODS
from haptic_glance.look.points.find import Looked
from haptic_glance.mesh import normalise, rotate_to_z_up
from haptic_glance.mesh.files import coarse_steps, load_unnamed, mesh_files, parse
from haptic_glance.mesh.headers import MeshError
from haptic_glance.mesh.materials import bake_texture
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.rays import RayScene
from haptic_glance.mesh.repair import RADIUS, centre_and_radius, orient
from haptic_glance.mesh.up import upright_by, upright_for

STORED = ".npz"  # a mesh as the pipeline keeps it in data/SET/meshes
RENDERING = ThreadPoolExecutor(1)  # what renders views: an OpenGL context belongs to one thread


@dataclass(frozen=True)
class Look:
    """The findings of a method: saliency (n,) f8 in 0..1, and the points.

    points: rows of haptic_glance.cli.saliency.COLUMNS, most salient first; positions in the file's coordinates. drawn:
    the mesh and saliency to be drawn, finer than Specimen.mesh where that has long edges.
    """

    method: str
    saliency: np.ndarray
    points: list[tuple]
    drawn: tuple[Mesh, np.ndarray]

    @property
    def vertices(self) -> np.ndarray:
        """(k,) i8 ids of the points."""
        return np.array([row[1] for row in self.points], dtype=np.int64)


@dataclass(frozen=True)
class Hit:
    """A click on the mesh: a face, its corner that is nearest, the position (3,) and the outward normal (3,).

    Position and normal are in the frame of Specimen.mesh.
    """

    face: int
    vertex: int
    position: np.ndarray
    normal: np.ndarray


class Specimen:
    """source: the Mesh in its file's coordinates. note: what is known of its up axis.

    Several threads may ask: each answer is computed once.
    """

    def __init__(self, source: Mesh, name: str, note: str = "") -> None:
        self.source, self.name, self.note = source, name, note
        self.lock = RLock()
        self._looks: dict[tuple, Look] = {}
        self._looked: tuple[str, Looked] | None = None  # of the last method

    @cached_property
    def baked(self) -> Mesh:
        """`source`, its texture turned into colours of the vertices."""
        return bake_texture(self.source)

    @cached_property
    def mesh(self) -> Mesh:
        """The mesh as it is shown and clicked: z up, its bounding sphere 0.5 about 0. Vertex ids are the file's.

        Closed parts face outwards, as for the look and the touch.
        """
        return normalise(rotate_to_z_up(orient(self.baked)[0]))

    @cached_property
    def unit(self) -> float:
        """One unit of `mesh`, in units of the file."""
        return float(centre_and_radius(rotate_to_z_up(self.source))[1]) / RADIUS

    @cached_property
    def rays(self) -> RayScene:
        """`mesh` made ready for rays."""
        return RayScene(self.mesh)

    def pick(self, origin: np.ndarray, direction: np.ndarray) -> Hit | None:
        """The first Hit of a ray from `origin` (3,) along the unit vector `direction` (3,); None where it misses."""
        origin, direction = (np.asarray(vector, dtype=np.float64) for vector in (origin, direction))
        hits = self.rays.cast(origin[None], direction[None])
        if not hits.hit[0]:
            return None
        face, place = int(hits.face[0]), origin + hits.distance[0] * direction
        corners = self.mesh.faces[face]
        nearest = np.linalg.norm(self.mesh.vertices[corners] - place, axis=1).argmin()
        return Hit(face, int(corners[nearest]), place, self.mesh.face_normals[face])

    def look(
        self, method: str = "glance", count: int | None = None, still_wanted: Callable[[], object] = lambda: None
    ) -> Look:
        """The Look of a method of METHODS; count: of points, None for those past the method's own threshold.

        still_wanted() is called before the look is computed, when others have ended, and may raise: a slider that moves
        asks for many looks, of which the last one counts.
        """
        if (method, count) in self._looks:  # without the lock: a click does not wait while another method looks
            return self._looks[method, count]
        with self.lock:
            if (method, count) not in self._looks:
                still_wanted()
                self._looks[method, count] = self._look(method, count)
            return self._looks[method, count]

    def _look(self, method, count):
        if METHODS[method].channels:
            return RENDERING.submit(self._find, method, count).result()
        return self._find(method, count)

    def _find(self, method, count):
        """The Look; another count of the same method needs neither another look nor another mesh to draw."""
        if self._looked is None or self._looked[0] != method:
            self._looked = method, Looked(self.baked, method)
        detection = self._looked[1].detect(count)
        if detection.saliency is None:
            raise ValueError(f"method {method!r} has no saliency: it only places points")
        earlier = next((look.drawn for (name, _), look in self._looks.items() if name == method), None)
        fine_mesh = earlier or finely(self.mesh, detection.saliency, method)
        return Look(method, detection.saliency, points_of(self.source, detection), fine_mesh)


def files_at(place: Path) -> list[Path]:
    """The file itself, or what a folder holds: its meshes, or else those that the pipeline stored there. MeshError."""
    stored_files = sorted(place.glob(f"*{STORED}")) if place.is_dir() else []
    try:
        return mesh_files(place)
    except MeshError:
        if not stored_files:
            raise
        return stored_files


def open_file(path: Path, up: str | None = None) -> Specimen:
    """The Specimen of a mesh, a cloud, a scan, or a mesh of the pipeline (.npz). MeshError, ValueError, OSError."""
    if path.suffix.lower() == STORED:
        return Specimen(read_mesh(path), path.stem, "z up, as the pipeline stores it")
    return _upright(load_unnamed(path), path, up)


def open_content(name: str, content: bytes, up: str | None = None) -> Specimen:
    """The Specimen of an uploaded file; no other file is read, so an OBJ comes without its materials."""
    path = Path(name)
    return _upright(parse(content, path.suffix.lower(), name=path.name), path, up)


def _upright(mesh: Mesh, path: Path, up: str | None) -> Specimen:
    """The Specimen of a mesh as its file has it; the note says what is wrong with it first, then the axis."""
    coarse = coarse_steps(path, mesh)
    mesh, note = upright_by(mesh, path, up)
    return Specimen(mesh, path.stem, f"{coarse}; {note}" if coarse else note)


def turned(specimen: Specimen, up: str) -> Specimen:
    """The same mesh with another axis up; nothing that was found on the old one is kept."""
    return Specimen(replace(specimen.source, up=up), specimen.name, f"{up} up")


def as_bytes(mesh: Mesh, suffix: str, weights: np.ndarray | None = None) -> bytes:
    """The file of a Mesh (.glb, .obj, .ply, .off, .stl), upright as its format has it.

    weights (n,): of the vertices, for the formats of `write_weights` (.ply, .glb, .usda, .npz).

    An OBJ gets the texture's colour at each vertex, since its pictures would be files of their own.
    """
    with TemporaryDirectory() as folder:
        path = Path(folder) / f"mesh{suffix}"
        upright_mesh, _ = upright_for(path, bake_texture(mesh) if suffix == ".obj" else mesh)
        write_any(path, upright_mesh) if weights is None else write_weights(path, upright_mesh, weights)
        return path.read_bytes()
