"""Closed solids whose tops are known functions, with vertices exactly below the cells of an array."""

from types import SimpleNamespace

import numpy as np
import pytest

from haptic_glance.mesh.mesh import Mesh


def solid(top, half=24, spacing=0.005, depth=0.5):
    """(closed mesh, id of the vertex at x = y = 0): the top is z = top(x, y) on a grid, the bottom lies flat."""
    side = 2 * half + 1
    line = (np.arange(side) - half) * spacing
    x, y = (grid.ravel() for grid in np.meshgrid(line, line, indexing="ij"))
    upper = np.c_[x, y, np.broadcast_to(top(x, y), x.shape)]
    lower = np.c_[x, y, np.full_like(x, upper[:, 2].min() - depth)]
    ids = np.arange(side * side).reshape(side, side)
    a, b, c, d = (part.ravel() for part in (ids[:-1, :-1], ids[1:, :-1], ids[1:, 1:], ids[:-1, 1:]))
    cover = np.r_[np.c_[a, b, c], np.c_[a, c, d]]
    rim = np.r_[ids[:, 0], ids[-1, 1:], ids[-2::-1, -1], ids[0, -2:0:-1]]
    after, n = np.roll(rim, -1), side * side
    walls = np.r_[np.c_[rim, rim + n, after + n], np.c_[rim, after + n, after]]
    return Mesh(np.r_[upper, lower], np.r_[cover, cover[:, ::-1] + n, walls]), int(ids[half, half])


def cell_places(cells, pitch):
    """(x (rows, cols), y (rows, cols)) of the cells on a plane with normal +z: columns to +x, rows down along -y."""
    rows, columns = cells
    x = (np.arange(columns) - (columns - 1) / 2) * pitch
    y = ((rows - 1) / 2 - np.arange(rows)) * pitch
    return np.broadcast_to(x, cells), np.broadcast_to(y[:, None], cells)


def sphere(x, y):
    """The top of a sphere of radius 0.3."""
    return np.sqrt(0.3**2 - x**2 - y**2)


def turned(mesh, rotation, shift=0.0, scale=1.0):
    """The mesh turned by a rotation matrix, scaled and shifted."""
    return Mesh(scale * mesh.vertices @ np.asarray(rotation).T + shift, mesh.faces)


@pytest.fixture(scope="session")
def shapes():
    """The functions above, for the tests of this folder."""
    return SimpleNamespace(solid=solid, cell_places=cell_places, sphere=sphere, turned=turned)
