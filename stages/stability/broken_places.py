"""Damage to vertices (displaced, duplicated, unreferenced): functions (mesh, generator) -> Mesh."""

import numpy as np

from haptic_glance.mesh.mesh import Mesh


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
    used, renumbered = np.unique(faces, return_inverse=True)
    return Mesh(mesh.vertices[used % len(mesh.vertices)], renumbered.reshape(-1, 3))


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
