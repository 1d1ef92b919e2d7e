"""Meshes for the studio."""

import numpy as np
import pytest
import trimesh

from haptic_glance.mesh.mesh import Mesh

viser = pytest.importorskip("viser", reason="the studio needs viser: pip install 'haptic-glance[studio]'")


def ball(subdivisions: int = 3, knob: float = 0.3) -> trimesh.Trimesh:
    """A ball of 20 * 4^subdivisions faces with a knob at +x."""
    shape = trimesh.creation.icosphere(subdivisions)
    near = np.exp((shape.vertices[:, 0] - 1) / 0.05)
    shape.vertices = shape.vertices * (1 + knob * near[:, None])
    return shape


@pytest.fixture
def mesh() -> Mesh:
    shape = ball()
    return Mesh(shape.vertices, shape.faces)


@pytest.fixture
def knob_file(tmp_path):
    path = tmp_path / "knob.ply"
    ball().export(path)
    return path
