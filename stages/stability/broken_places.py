"""Vertices in the wrong place, more than once, or in no face at all: functions (mesh, generator) -> Mesh."""

import numpy as np

from stages.kit import Mesh


def unreferenced(mesh, generator):
    """Five hundred vertices in no face, before and behind the others, up to ten diagonals away."""
    strays = 10 * mesh.diagonal * generator.uniform(-1, 1, (500, 3))
    return Mesh(np.r_[strays[:250], mesh.vertices, strays[250:]], mesh.faces + 250)


def soup(mesh, _generator):
    """Each face with three vertices of its own, as an STL file has them."""
    return Mesh(mesh.vertices[mesh.faces].reshape(-1, 3), np.arange(mesh.faces.size).reshape(-1, 3))


def seam(mesh, _generator):
    """Cut in two along the faces, the vertices on the cut doubled, as the seam of a texture is."""
    left = mesh.vertices[mesh.faces][:, :, 0].mean(axis=1) < np.median(mesh.vertices[:, 0])
    faces = mesh.faces + len(mesh.vertices) * left[:, None]
    used, renumbered = np.unique(faces, return_inverse=True)
    return Mesh(mesh.vertices[used % len(mesh.vertices)], renumbered.reshape(-1, 3))


def squashed(mesh, _generator):
    """Pressed flat: a closed surface without volume, front upon back."""
    return Mesh(mesh.vertices * [1, 1, 0], mesh.faces)


def snapped(mesh, _generator):
    """On a grid of 1/40 of the diagonal: corners fall together, faces lose their area."""
    step = mesh.diagonal / 40
    return Mesh(np.round(mesh.vertices / step) * step, mesh.faces)


def spikes(mesh, generator):
    """Five vertices flung away, by up to three diagonals."""
    vertices = mesh.vertices.copy()
    vertices[generator.choice(np.unique(mesh.faces), 5, replace=False)] *= generator.uniform(2, 6, (5, 1))
    return Mesh(vertices, mesh.faces)


def noisy(sigma, mesh, generator):
    """Gaussian noise on each coordinate, sigma in diagonals."""
    return Mesh(mesh.vertices + sigma * mesh.diagonal * generator.standard_normal(mesh.vertices.shape), mesh.faces)


def placed(scale, offset, mesh, _generator):
    """Another unit, another origin: coordinates plus `offset` (in diagonals) in each axis, times `scale`."""
    return Mesh(scale * (mesh.vertices + offset * mesh.diagonal), mesh.faces)
