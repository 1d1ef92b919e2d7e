"""Damage to faces (missing, duplicated, degenerate, inverted, added): functions (mesh, generator) -> Mesh."""

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
    apart = np.linalg.norm(mesh.vertices[mesh.faces].mean(axis=1)[:, None] - centres, axis=2)
    return _without(mesh, (apart < mesh.diagonal * np.array([0.025, 0.05, 0.1])).any(axis=1))


def half(mesh: Mesh, _generator: np.random.Generator) -> Mesh:
    """The upper half of the faces; the cut follows their edges."""
    height = mesh.vertices[mesh.faces][:, :, 2].mean(axis=1)
    return _without(mesh, height < np.median(height))


def fins(mesh: Mesh, generator: np.random.Generator) -> Mesh:
    """Twenty faces are added to edges that already have two: non-manifold edges."""
    chosen = generator.choice(len(mesh.faces), 20)
    corners, normals = mesh.vertices[mesh.faces[chosen]], mesh.face_normals[chosen]
    tips = corners[:, :2].mean(axis=1) + 0.02 * mesh.diagonal * normals
    ids = len(mesh.vertices) + np.arange(20)
    return Mesh(np.r_[mesh.vertices, tips], np.r_[mesh.faces, np.c_[mesh.faces[chosen][:, [1, 0]], ids]])


def burrs(mesh: Mesh, generator: np.random.Generator) -> Mesh:
    """Twenty small tetrahedra each share one vertex with the surface: non-manifold vertices."""
    chosen = generator.choice(np.unique(mesh.faces), 20, replace=False)
    shape = 0.01 * mesh.diagonal * (TETRAHEDRON[1:] - TETRAHEDRON[0])
    tips = mesh.vertices[chosen][:, None] + shape
    ids = len(mesh.vertices) + np.arange(60).reshape(20, 3)
    faces = np.c_[chosen, ids][:, TETRAHEDRON_FACES].reshape(-1, 3)
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
    chosen = mesh.faces[generator.choice(len(mesh.faces), 50)]
    return Mesh(mesh.vertices, np.r_[mesh.faces, chosen[:, [0, 1, 1]]])


def islands(mesh: Mesh, generator: np.random.Generator) -> Mesh:
    """Two hundred small tetrahedra, a two-hundredth of the diagonal in size, float around the object."""
    places = mesh.diagonal * generator.uniform(-0.5, 0.5, (200, 1, 3))
    corners = places + 0.0025 * mesh.diagonal * TETRAHEDRON
    faces = TETRAHEDRON_FACES + 4 * np.arange(200)[:, None, None]
    return _joined(mesh, Mesh(corners.reshape(-1, 3), faces.reshape(-1, 3)))


def mixed_winding(mesh: Mesh, generator: np.random.Generator) -> Mesh:
    """Three in ten faces have the opposite winding."""
    turned = _some(mesh, generator, 0.3)
    return Mesh(mesh.vertices, np.where(turned[:, None], mesh.faces[:, ::-1], mesh.faces))


def everything(mesh: Mesh, generator: np.random.Generator) -> Mesh:
    """Holes, fins, burrs, duplicates, slivers, islands, repeated indices and mixed winding, all on one object."""
    for make in (wide_holes, fins, burrs, duplicate_faces, slivers, islands, repeated_index, mixed_winding):
        mesh = make(mesh, generator)
    return mesh


def _without(mesh, gone):
    return Mesh(mesh.vertices, np.delete(mesh.faces, np.flatnonzero(gone) if gone.dtype == bool else gone, axis=0))


def _some(mesh, generator, share):
    return generator.random(len(mesh.faces)) < share


def _joined(one, other):
    return Mesh(np.r_[one.vertices, other.vertices], np.r_[one.faces, other.faces + len(one.vertices)])


def _split(mesh, generator, share):
    """A hundred faces split in three by a vertex `share` of the way from the first corner to the face's middle."""
    chosen = generator.choice(len(mesh.faces), 100, replace=False)
    (a, b, c), corners = mesh.faces[chosen].T, mesh.vertices[mesh.faces[chosen]]
    ids = len(mesh.vertices) + np.arange(100)
    new = (1 - share) * corners[:, 0] + share * corners.mean(axis=1)
    parts = [np.stack(part, axis=1) for part in ((a, b, ids), (b, c, ids), (c, a, ids))]
    return Mesh(np.r_[mesh.vertices, new], np.r_[np.delete(mesh.faces, chosen, axis=0), *parts])
