"""Shapes whose salient places are known, for the glance and the detectors that it is measured against."""

import functools

import numpy as np
import pytest
import trimesh

from haptic_glance.mesh.mesh import Mesh


def as_mesh(shape: trimesh.Trimesh) -> Mesh:
    return Mesh(shape.vertices, shape.faces)


@functools.cache
def ball_mesh(subdivisions=4, radius=1.0):
    shape = trimesh.creation.icosphere(subdivisions=subdivisions, radius=radius)
    return Mesh(shape.vertices, shape.faces)


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


def raised_ball(tops, widths, heights, subdivisions=5):
    """The unit ball raised round each top (a unit vector) by height * exp(-distance^2 / (2 width^2))."""
    ball = ball_mesh(subdivisions)
    squared = 2 - 2 * ball.vertices @ np.array(tops, dtype=float).T
    height = np.exp(-squared / (2 * np.array(widths) ** 2)) @ np.array(heights)
    return Mesh(ball.vertices * (1 + height[:, None]), ball.faces)


@pytest.fixture(scope="session")
def sphere():
    """A function: Mesh of a sphere of the given subdivisions and radius."""
    return ball_mesh


@pytest.fixture(scope="session")
def raised():
    """A function: Mesh of the unit ball with bumps of the given tops, widths and heights; it keeps the ball's order."""
    return raised_ball


@pytest.fixture(scope="session")
def grid():
    """A function: (vertices, faces) of a flat grid of rows x columns vertices, one apart."""

    def make(rows, columns):
        vertices = np.stack([*np.mgrid[:rows, :columns].reshape(2, -1), np.zeros(rows * columns)], axis=1).astype(float)
        first = np.flatnonzero((vertices[:, 0] < rows - 1) & (vertices[:, 1] < columns - 1))
        corners = [first, first + columns, first + columns + 1, first, first + columns + 1, first + 1]
        return vertices, np.stack(corners, axis=1).reshape(-1, 3)

    return make


@pytest.fixture(scope="session")
def cube():
    """A function: Mesh of the unit cube, its faces halved so many times."""

    def make(times):
        box = trimesh.creation.box()
        for _ in range(times):
            box = box.subdivide()
        return Mesh(box.vertices, box.faces)

    return make


@pytest.fixture(scope="session")
def bump_and_swell():
    """A bump of 2 % of the diagonal at +x and a swell of 14 % at -x."""
    return raised_ball([[1, 0, 0], [-1, 0, 0]], [0.08, 0.5], [0.06, 0.12])


@pytest.fixture(scope="session")
def saliency_of():
    """A function (rival, mesh): rival.saliency(mesh), worked out once for all tests."""

    @functools.cache
    def remembered(rival, mesh):
        values = rival.saliency(mesh)
        values.flags.writeable = False
        return values

    return remembered
