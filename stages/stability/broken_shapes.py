"""Unusual surfaces (a sheet, a Moebius strip, one triangle) that replace the given mesh."""

from collections.abc import Callable

import numpy as np

from haptic_glance.mesh.mesh import Mesh


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
    at = np.arange((columns + 1) * (rows + 1)).reshape(columns + 1, rows + 1)
    u, v = (
        values.ravel() for values in np.meshgrid(*(np.linspace(0, 1, k + 1) for k in (columns, rows)), indexing="ij")
    )
    if twisted:
        at[-1] = at[0, ::-1]
    a, b, c, d = at[:-1, :-1].ravel(), at[1:, :-1].ravel(), at[1:, 1:].ravel(), at[:-1, 1:].ravel()
    faces = np.r_[np.c_[a, b, c], np.c_[a, c, d]]
    return Mesh(place(u, v)[: int(faces.max()) + 1], faces)
