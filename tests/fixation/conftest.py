"""Shapes whose kind is known."""

import numpy as np
import pytest
import trimesh

from haptic_glance.mesh.mesh import Mesh
from tests.shapes import mesh_of


@pytest.fixture(scope="session")
def shapes():
    """dict name -> Mesh of a ball, a long ellipsoid, a torus, a fine cylinder wall and a flat grid."""
    ball = trimesh.creation.icosphere(4, 0.5)
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 60, endpoint=False), np.linspace(-0.4, 0.4, 30), indexing="ij")
    tube = np.stack([0.3 * np.cos(u), 0.3 * np.sin(u), v], axis=2).reshape(-1, 3)
    flat = np.stack([u / (2 * np.pi), v, 0 * v], axis=2).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(60), np.arange(29), indexing="ij")
    corner, along, around = (i * 30 + j).ravel(), (i * 30 + j + 1).ravel(), ((i + 1) % 60 * 30 + j).ravel()
    diagonal = ((i + 1) % 60 * 30 + j + 1).ravel()
    faces = np.concatenate([np.stack([corner, around, diagonal], 1), np.stack([corner, diagonal, along], 1)])
    inside = faces[(faces // 30).max(axis=1) - (faces // 30).min(axis=1) <= 1]
    return {
        "ball": mesh_of(ball),
        "egg": Mesh(ball.vertices * [1, 0.3, 0.3], ball.faces),
        "torus": mesh_of(trimesh.creation.torus(0.35, 0.12, major_sections=64, minor_sections=32)),
        "tube": Mesh(tube, faces),
        "flat": Mesh(flat, inside),
    }
