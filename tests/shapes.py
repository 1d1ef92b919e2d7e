"""Meshes that several folders test with."""

import functools

import numpy as np
import trimesh

from haptic_glance.mesh.mesh import Mesh


def mesh_of(shape: trimesh.Trimesh) -> Mesh:
    """The Mesh of a shape of trimesh."""
    return Mesh(shape.vertices, shape.faces)


@functools.cache
def ball_mesh(subdivisions=4, radius=1.0):
    """A closed ball of 20 * 4 ** subdivisions faces."""
    return mesh_of(trimesh.creation.icosphere(subdivisions=subdivisions, radius=radius))


def raised_ball(tops, widths, heights, subdivisions=4):
    """The ball_mesh raised round each top (a unit vector) by height * exp(-distance^2 / (2 width^2))."""
    ball = ball_mesh(subdivisions)
    squared = 2 - 2 * ball.vertices @ np.array(tops, dtype=float).T
    height = np.exp(-squared / (2 * np.array(widths) ** 2)) @ np.array(heights)
    return Mesh(ball.vertices * (1 + height[:, None]), ball.faces)


@functools.cache
def flat_grid(rows, columns):
    """A flat grid of rows x columns vertices, one apart; vertex i lies at (i // columns, i % columns)."""
    vertices = np.stack([*np.mgrid[:rows, :columns].reshape(2, -1), np.zeros(rows * columns)], axis=1).astype(float)
    first = np.flatnonzero((vertices[:, 0] < rows - 1) & (vertices[:, 1] < columns - 1))
    corners = [first, first + columns, first + columns + 1, first, first + columns + 1, first + 1]
    return Mesh(vertices, np.stack(corners, axis=1).reshape(-1, 3))


@functools.cache
def lopsided():
    """A blob with bumps of different size in no symmetric order."""
    source = trimesh.creation.icosphere(subdivisions=4)
    v = source.vertices.copy()
    for direction, height, width in (((1, 0.2, 0), 1.2, 0.3), ((-0.3, 1, 0.5), 0.7, 0.2), ((0.1, -0.4, -1), 0.9, 0.5)):
        towards = np.array(direction) / np.linalg.norm(direction)
        v *= 1 + height * np.exp(-(1 - v @ towards / np.linalg.norm(v, axis=1)) / width**2)[:, None]
    v -= (v.max(axis=0) + v.min(axis=0)) / 2
    return Mesh(v / (2 * np.linalg.norm(v, axis=1).max()), source.faces)


def together(*meshes):
    """Several meshes as one, each of its own vertices."""
    offsets = np.cumsum([0] + [len(mesh.vertices) for mesh in meshes[:-1]])
    faces = [mesh.faces + offset for mesh, offset in zip(meshes, offsets, strict=True)]
    return Mesh(np.concatenate([mesh.vertices for mesh in meshes]), np.concatenate(faces))
