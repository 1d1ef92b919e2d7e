"""A mesh of a user, which the commands read from a file."""

import numpy as np
import pytest
import trimesh

from haptic_glance.cli.simplify import run
from haptic_glance.lod import measures
from haptic_glance.lod.export import write_any
from haptic_glance.mesh import load
from haptic_glance.mesh.mesh import Mesh

PLACE, SIZE = np.array([120.0, -40.0, 7.0]), 25.0


def bumpy():
    """A closed ball with bumps, of 1,280 faces, far from the origin and some fifty units wide."""
    ball = trimesh.creation.icosphere(subdivisions=3)
    x, y, z = ball.vertices.T
    radius = 1 + 0.08 * np.sin(5 * x) * np.cos(4 * y) + 0.15 * np.exp(-8 * ((z - 1) ** 2 + x**2))
    return Mesh(PLACE + SIZE * radius[:, None] * ball.vertices, ball.faces)


def bowl():
    """The ball open at its lower third, and the number of its open edges."""
    mesh = bumpy()
    mesh = Mesh(mesh.vertices, mesh.faces[(mesh.vertices[mesh.faces][..., 2] > PLACE[2] - SIZE / 3).all(axis=1)])
    return mesh, int((mesh.edge_counts[1] == 1).sum())


@pytest.fixture
def file(tmp_path):
    """The ball in a file that says which axis is up."""
    write_any(tmp_path / "ball.obj", bumpy())
    return tmp_path / "ball.obj"


@pytest.fixture
def simplified(file, tmp_path, capsys, monkeypatch):
    """Function: simplifies with options and returns (Mesh that was written, standard output, standard error)."""
    monkeypatch.setattr(measures, "SIZE", (60, 80))

    def work(*options, source=file, out="out.obj"):
        run([str(source), "--method", "height", "--out", str(tmp_path / out), *map(str, options)])
        captured = capsys.readouterr()
        return load(tmp_path / out), captured.out, captured.err

    return work
