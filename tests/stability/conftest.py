"""The stage on one small object, run for all tests of the stage."""

from types import SimpleNamespace

import numpy as np
import pytest
import trimesh

from haptic_glance.base.files import write_mesh, write_table
from haptic_glance.mesh import normalise
from stages.stability import Params
from stages.stability.__main__ import process
from stages.weights.training import weight_table
from tests.shapes import raised_ball

SEVERITIES = {"vertex_order": [1.0], "noise": [0.001, 0.02], "light": [60.0], "missing_faces": [0.9, 1.0]}


@pytest.fixture(scope="session")
def settings():
    return Params(
        objects=["pear"], most=1, methods=["itti", "harris", "random"], count=8, size=[120, 160],
        perturbations=list(SEVERITIES), severities=SEVERITIES,
    )  # fmt: skip


@pytest.fixture(scope="session")
def pear():
    """A bumpy ball."""
    tops = trimesh.util.unitize(np.array([[1.0, 0.2, 0.1], [-0.3, 1, 0.4], [0.1, -0.6, -1]]))
    return normalise(raised_ball(tops, [0.2, 0.25, 0.3], [0.5, 0.4, 0.6], subdivisions=3))


@pytest.fixture(scope="session")
def disturbed(tmp_path_factory, pear, settings):
    """root: its folder, with the inputs and the file of the pear below data/test; rows: of the pear."""
    root = tmp_path_factory.mktemp("stability")
    data = root / "data/test"
    write_mesh(data / "meshes/pear.npz", pear)
    write_table(data / "weights/weights.csv", weight_table({}, "gaze"))
    return SimpleNamespace(root=root, rows=process("pear", data / "stability", data, settings, 0))
