"""Warming up, the files of imprints, and the stage on two small solids."""

import numba
import numpy as np
import pytest

from haptic_glance.base.files import write_arrays, write_mesh
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import press, touchable
from haptic_glance.touch.kernels import faces
from stages.engine.rows import read_rows
from stages.imprints import __main__ as stage
from stages.imprints.imprints import Imprints, read_imprints, write_imprints
from tests.touch.conftest import solid, sphere


def test_files_keep_methods_images_and_places(tmp_path):
    imprints = Imprints(np.ones((2, 4, 4), "f4"), np.array([3, 1]), np.zeros((2, 3), "f4"), 0.02)
    write_imprints(tmp_path / "a.npz", {"random": imprints, "Vis.Att": imprints})
    write_imprints(tmp_path / "b.npz", {"Vis.Att": imprints, "random": imprints})
    back = read_imprints(tmp_path / "a.npz")
    assert list(back) == ["Vis.Att", "random"] and back["random"].vertices.tolist() == [3, 1]
    assert back["random"].width == 0.08
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()


@pytest.mark.slow
def test_stage_presses_every_method_and_counts_what_it_refuses(make_workspace):
    settings = {"methods": ["itti", "random", "glance"], "cells": [15, 15], "pitch": 0.01, "contact": "tangent"}
    workspace = make_workspace({"imprints": settings})
    mesh, vertex = solid(sphere)
    mesh = Mesh(np.r_[mesh.vertices, [[1, 1, 1]]], mesh.faces)
    lone = len(mesh.vertices) - 1
    write_mesh(workspace.data / "meshes/ball.npz", mesh)
    points = {"random": np.array([vertex, lone]), "itti": np.array([vertex]), "glance": np.zeros(0, "i8")}
    arrays = {f"{method}.points": ids for method, ids in points.items()}
    arrays |= {f"{method}.strong": np.int64(len(ids)) for method, ids in points.items()}
    write_arrays(workspace.data / "salient_points/ball.npz", **arrays)
    stage.run(workspace)
    rows = read_rows(workspace.measurements / "imprints.csv.gz")
    value = rows.set_index(["method", "metric"])["value"]
    assert value["random", "imprints"] == 1 and value["random", "refused"] == 1 and np.isnan(value["glance", "relief"])
    assert value["itti", "relief"] == pytest.approx(0.3 - sphere(0.07, 0.07), rel=1e-5) and value["itti", "missed"] == 0
    written = read_imprints(workspace.data / "imprints/ball.npz")
    assert np.array_equal(written["itti"].images[0], press(mesh, vertex, (15, 15), 0.01))
    assert np.allclose(written["itti"].positions, mesh.vertices[[vertex]])
    assert not touchable(mesh, [lone])[0]


def test_a_kernel_leaves_the_folder_of_other_kernels_as_it_was(monkeypatch):
    numba.config.reload_config()  # numba reads the environment again when it compiles after a test changed it
    monkeypatch.setattr(numba.config, "CACHE_DIR", "elsewhere")
    assert faces.kernel(abs_of)(-2.0) == 2.0
    assert numba.config.CACHE_DIR == "elsewhere"


def abs_of(value):
    """A function to compile."""
    return abs(value)
