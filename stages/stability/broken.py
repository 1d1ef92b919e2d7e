"""The registry of damages: changes of a mesh by scanners, modellers and file formats, each applied to a sound mesh.

Damages of faces are missing, duplicated, degenerate, inverted or added ones; those of vertices displaced, duplicated or
unreferenced ones; unusual surfaces (a sheet, a Moebius strip, one triangle) replace the mesh. To add a damage, write a
function (mesh, generator) -> Mesh and an entry in DAMAGES. Random numbers come from the generator alone.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from haptic_glance.mesh.mesh import Mesh

SLIVER_HEIGHT = 1e-6  # height of a sliver over its length
TETRAHEDRON = np.array([[1.0, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
TETRAHEDRON_FACES = np.array([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])


def pin_holes(mesh: Mesh, generator: np.random.Generator) -> Mesh:
    """Twenty faces drawn at random are missing."""
    return _without(mesh, generator.choice(len(mesh.faces), min(20, len(mesh.faces) // 10), replace=False))


def wide_holes(mesh: Mesh, generator: np.random.Generator) -> Mesh:
    """Three round holes, of 5, 10 and 20 % of the diagonal."""
    centres = mesh.vertices[generator.choice(np.unique(mesh.faces), 3, replace=False)]
    distances = np.linalg.norm(mesh.vertices[mesh.faces].mean(axis=1)[:, None] - centres, axis=2)
    return _without(mesh, (distances < mesh.diagonal * np.array([0.025, 0.05, 0.1])).any(axis=1))


def half(mesh: Mesh, _generator: np.random.Generator) -> Mesh:
    """The upper half of the faces; the cut follows their edges."""
    height = mesh.vertices[mesh.faces][:, :, 2].mean(axis=1)
    return _without(mesh, height < np.median(height))


def fins(mesh: Mesh, generator: np.random.Generator) -> Mesh:
    """Twenty faces are added to edges that already have two: non-manifold edges."""
    face_ids = generator.choice(len(mesh.faces), 20)
    corners, normals = mesh.vertices[mesh.faces[face_ids]], mesh.face_normals[face_ids]
    tips = corners[:, :2].mean(axis=1) + 0.02 * mesh.diagonal * normals
    ids = len(mesh.vertices) + np.arange(20)
    return Mesh(np.r_[mesh.vertices, tips], np.r_[mesh.faces, np.c_[mesh.faces[face_ids][:, [1, 0]], ids]])


def burrs(mesh: Mesh, generator: np.random.Generator) -> Mesh:
    """Twenty small tetrahedra each share one vertex with the surface: non-manifold vertices."""
    vertex_ids = generator.choice(np.unique(mesh.faces), 20, replace=False)
    shape = 0.01 * mesh.diagonal * (TETRAHEDRON[1:] - TETRAHEDRON[0])
    tips = mesh.vertices[vertex_ids][:, None] + shape
    ids = len(mesh.vertices) + np.arange(60).reshape(20, 3)
    faces = np.c_[vertex_ids, ids][:, TETRAHEDRON_FACES].reshape(-1, 3)
    return Mesh(np.r_[mesh.vertices, tips.reshape(-1, 3)], np.r_[mesh.faces, faces])


def interpenetrating(mesh: Mesh, _generator: np.random.Generator) -> Mesh:
    """The mesh and its copy, a fifth of the diagonal away: the two surfaces intersect."""
    return _joined(mesh, Mesh(mesh.vertices + 0.2 * mesh.diagonal * np.array([0.6, 0.0, 0.8]), mesh.faces))


def duplicate_faces(mesh: Mesh, generator: np.random.Generator) -> Mesh:
    """A twentieth of the faces appear twice."""
    return Mesh(mesh.vertices, np.r_[mesh.faces, mesh.faces[_some(mesh, generator, 0.05)]])


def double_layer(mesh: Mesh, _generator: np.random.Generator) -> Mesh:
    """Each face appears a second time with the opposite winding, on the same vertices."""
    return Mesh(mesh.vertices, np.r_[mesh.faces, mesh.faces[:, ::-1]])


def zero_area(mesh: Mesh, generator: np.random.Generator) -> Mesh:
    """A hundred faces each get a further vertex at the position of a corner: two faces without area each."""
    return _split(mesh, generator, 0.0)


def slivers(mesh: Mesh, generator: np.random.Generator) -> Mesh:
    """A hundred faces each get a further vertex a millionth of an edge away from a corner: slivers."""
    return _split(mesh, generator, SLIVER_HEIGHT)


def repeated_index(mesh: Mesh, generator: np.random.Generator) -> Mesh:
    """Fifty faces that name a vertex twice."""
    faces = mesh.faces[generator.choice(len(mesh.faces), 50)]
    return Mesh(mesh.vertices, np.r_[mesh.faces, faces[:, [0, 1, 1]]])


def islands(mesh: Mesh, generator: np.random.Generator) -> Mesh:
    """Two hundred small tetrahedra, a two-hundredth of the diagonal in size, float around the object."""
    places = mesh.diagonal * generator.uniform(-0.5, 0.5, (200, 1, 3))
    corners = places + 0.0025 * mesh.diagonal * TETRAHEDRON
    faces = TETRAHEDRON_FACES + 4 * np.arange(200)[:, None, None]
    return _joined(mesh, Mesh(corners.reshape(-1, 3), faces.reshape(-1, 3)))


def mixed_winding(mesh: Mesh, generator: np.random.Generator) -> Mesh:
    """Three in ten faces have the opposite winding."""
    is_flipped = _some(mesh, generator, 0.3)
    return Mesh(mesh.vertices, np.where(is_flipped[:, None], mesh.faces[:, ::-1], mesh.faces))


def everything(mesh: Mesh, generator: np.random.Generator) -> Mesh:
    """Holes, fins, burrs, duplicates, slivers, islands, repeated indices and mixed winding, all on one object."""
    for make in (wide_holes, fins, burrs, duplicate_faces, slivers, islands, repeated_index, mixed_winding):
        mesh = make(mesh, generator)
    return mesh


def _without(mesh, removed):
    return Mesh(
        mesh.vertices, np.delete(mesh.faces, np.flatnonzero(removed) if removed.dtype == bool else removed, axis=0)
    )


def _some(mesh, generator, share):
    return generator.random(len(mesh.faces)) < share


def _joined(first, second):
    return Mesh(np.r_[first.vertices, second.vertices], np.r_[first.faces, second.faces + len(first.vertices)])


def _split(mesh, generator, share):
    """A hundred faces split in three by a vertex `share` of the way from the first corner to the face's middle."""
    face_ids = generator.choice(len(mesh.faces), 100, replace=False)
    (a, b, c), corners = mesh.faces[face_ids].T, mesh.vertices[mesh.faces[face_ids]]
    ids = len(mesh.vertices) + np.arange(100)
    new = (1 - share) * corners[:, 0] + share * corners.mean(axis=1)
    parts = [np.stack(part, axis=1) for part in ((a, b, ids), (b, c, ids), (c, a, ids))]
    return Mesh(np.r_[mesh.vertices, new], np.r_[np.delete(mesh.faces, face_ids, axis=0), *parts])


def unreferenced(mesh: Mesh, generator: np.random.Generator) -> Mesh:
    """Five hundred vertices that no face uses, listed before and after the others, up to ten diagonals away."""
    strays = 10 * mesh.diagonal * generator.uniform(-1, 1, (500, 3))
    return Mesh(np.r_[strays[:250], mesh.vertices, strays[250:]], mesh.faces + 250)


def soup(mesh: Mesh, _generator: np.random.Generator) -> Mesh:
    """Each face has three vertices of its own, as in an STL file."""
    return Mesh(mesh.vertices[mesh.faces].reshape(-1, 3), np.arange(mesh.faces.size).reshape(-1, 3))


def seam(mesh: Mesh, _generator: np.random.Generator) -> Mesh:
    """Cut in two along edges, with the vertices on the cut duplicated, as at the seam of a texture."""
    left = mesh.vertices[mesh.faces][:, :, 0].mean(axis=1) < np.median(mesh.vertices[:, 0])
    faces = mesh.faces + len(mesh.vertices) * left[:, None]
    vertex_ids, renumbered = np.unique(faces, return_inverse=True)
    return Mesh(mesh.vertices[vertex_ids % len(mesh.vertices)], renumbered.reshape(-1, 3))


def squashed(mesh: Mesh, _generator: np.random.Generator) -> Mesh:
    """Flattened to a plane: a closed surface without volume."""
    return Mesh(mesh.vertices * [1, 1, 0], mesh.faces)


def snapped(mesh: Mesh, _generator: np.random.Generator) -> Mesh:
    """Vertices rounded to a grid of 1/40 of the diagonal: some coincide, and faces lose their area."""
    step = mesh.diagonal / 40
    return Mesh(np.round(mesh.vertices / step) * step, mesh.faces)


def spikes(mesh: Mesh, generator: np.random.Generator) -> Mesh:
    """Five vertices moved away from the origin, by up to three diagonals."""
    vertices = mesh.vertices.copy()
    vertices[generator.choice(np.unique(mesh.faces), 5, replace=False)] *= generator.uniform(2, 6, (5, 1))
    return Mesh(vertices, mesh.faces)


def noisy(sigma: float, mesh: Mesh, generator: np.random.Generator) -> Mesh:
    """Gaussian noise on each coordinate, sigma in diagonals."""
    return Mesh(mesh.vertices + sigma * mesh.diagonal * generator.standard_normal(mesh.vertices.shape), mesh.faces)


def placed(scale: float, offset: float, mesh: Mesh, _generator: np.random.Generator) -> Mesh:
    """Another origin and unit: `offset` (in diagonals) is added to each coordinate; all are then scaled by `scale`."""
    return Mesh(scale * (mesh.vertices + offset * mesh.diagonal), mesh.faces)


def flat_sheet(_mesh: Mesh, _generator: np.random.Generator) -> Mesh:
    """A square of 40 x 40 cells in one plane."""
    return grid(40, 40, lambda u, v: np.c_[u - 0.5, v - 0.5, 0 * u])


def moebius(_mesh: Mesh, _generator: np.random.Generator) -> Mesh:
    """A Moebius strip: one side, one boundary loop, no consistent winding."""

    def place(u: np.ndarray, v: np.ndarray) -> np.ndarray:
        around, across = 2 * np.pi * u, 0.3 * (v - 0.5)
        wide = 0.4 + across * np.cos(around / 2)
        return np.c_[wide * np.cos(around), wide * np.sin(around), across * np.sin(around / 2)]

    return grid(120, 10, place, twisted=True)


def one_triangle(_mesh: Mesh, _generator: np.random.Generator) -> Mesh:
    """A mesh of one triangle."""
    return Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]]))


def grid(columns: int, rows: int, place: Callable[[np.ndarray, np.ndarray], np.ndarray], twisted: bool = False) -> Mesh:
    """A Mesh of columns x rows cells, two faces each. place(u, v) -> (k, 3), u and v in 0..1.

    twisted: the last column is the first one upside down.
    """
    ids = np.arange((columns + 1) * (rows + 1)).reshape(columns + 1, rows + 1)
    u, v = (
        values.ravel() for values in np.meshgrid(*(np.linspace(0, 1, k + 1) for k in (columns, rows)), indexing="ij")
    )
    if twisted:
        ids[-1] = ids[0, ::-1]
    a, b, c, d = ids[:-1, :-1].ravel(), ids[1:, :-1].ravel(), ids[1:, 1:].ravel(), ids[:-1, 1:].ravel()
    faces = np.r_[np.c_[a, b, c], np.c_[a, c, d]]
    return Mesh(place(u, v)[: int(faces.max()) + 1], faces)


@dataclass(frozen=True)
class Damage:
    """A way to break a mesh: make(mesh, generator) -> Mesh.

    moved: how far the damage itself moves the surface, in diagonals.
    """

    make: Callable[[Mesh, np.random.Generator], Mesh]
    moved: float = 0.0


DAMAGES = {
    "sound": Damage(lambda mesh, _: mesh),
    "pin_holes": Damage(pin_holes),
    "wide_holes": Damage(wide_holes),
    "half": Damage(half),
    "fins": Damage(fins),
    "burrs": Damage(burrs),
    "interpenetrating": Damage(interpenetrating),
    "duplicate_faces": Damage(duplicate_faces),
    "double_layer": Damage(double_layer),
    "zero_area": Damage(zero_area),
    "needles": Damage(slivers),
    "repeated_index": Damage(repeated_index),
    "islands": Damage(islands),
    "mixed_winding": Damage(mixed_winding),
    "unreferenced": Damage(unreferenced),
    "soup": Damage(soup),
    "seam": Damage(seam),
    "squashed": Damage(squashed),
    "snapped": Damage(snapped, moved=0.0125),
    "spikes": Damage(spikes),
    "noise_0.001": Damage(partial(noisy, 0.001), moved=0.001),
    "noise_0.003": Damage(partial(noisy, 0.003), moved=0.003),
    "noise_0.01": Damage(partial(noisy, 0.01), moved=0.01),
    "noise_0.03": Damage(partial(noisy, 0.03), moved=0.03),
    "tiny": Damage(partial(placed, 1e-12, 0.0)),
    "huge": Damage(partial(placed, 1e12, 0.0)),
    "far": Damage(partial(placed, 1.0, 1e6)),
    "flat_sheet": Damage(flat_sheet),
    "moebius": Damage(moebius),
    "everything": Damage(everything),
    "one_triangle": Damage(one_triangle),
}
