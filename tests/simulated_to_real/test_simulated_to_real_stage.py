"""Objects laid on the array, and the stage on two objects whose other imprints stand for the real touches."""

import numpy as np
import pandas as pd
import pytest
import trimesh
from PIL import Image

from haptic_glance.base.files import read_arrays, write_mesh, write_table
from haptic_glance.mesh.mesh import Mesh
from stages.engine.rows import read_rows
from stages.simulated_to_real import __main__ as stage
from stages.simulated_to_real.__main__ import LARGE_PITCH, PITCH, SIMULATIONS, run, shares, simulate

SOLIDS = {"sphere": trimesh.creation.icosphere(2, radius=0.5), "cube": trimesh.creation.box((0.5, 0.5, 0.5))}
MEMBERS = {"ball": "sphere", "box": "cube"}
SIZES = {"sphere": 0.04, "cube": 0.03}
CELLS = (28, 50)
SETTINGS = {"simulations": ["resting"], "simulated": 24, "real": [0, 7], "repetitions": 2}


def mesh_of(solid):
    return Mesh(np.asarray(solid.vertices, dtype=np.float64), np.asarray(solid.faces, dtype=np.int64))


@pytest.fixture
def workspace(make_workspace, tmp_path):
    """Meshes of two classes, and an archive of 24 imprints of each."""
    recorded = {"kind": "pressure_images", "folder": "archive", "repetitions": 1}
    workspace = make_workspace({"simulated_to_real": SETTINGS, "recorded": recorded})
    meshes = workspace.data / "meshes"
    for name, object_name in MEMBERS.items():
        mesh = mesh_of(SOLIDS[object_name])
        write_mesh(meshes / f"{object_name}.npz", mesh)
        pressed = simulate("resting", mesh, 24, CELLS, SIZES[object_name], np.random.default_rng(1))
        (tmp_path / "archive/Images" / name).mkdir(parents=True)
        for k, picture in enumerate(pressed):
            path = tmp_path / f"archive/Images/{name}/{name}{k}.jpg"
            Image.fromarray(np.round(255 * picture).astype(np.uint8)).save(path, quality=95)
    write_table(meshes / "manifest.csv", pd.DataFrame({"object": list(SIZES), "size": list(SIZES.values())}))
    write_table(meshes / "classes.csv", pd.DataFrame({"class": list(MEMBERS), "object": list(MEMBERS.values())}))
    return workspace


@pytest.mark.slow
def test_simulation_of_the_same_objects_helps_and_alignment_is_said(workspace):
    run(workspace)
    rows = read_rows(workspace.measurements / "simulated_to_real.csv.gz")
    knn = rows[(rows["classifier"] == "knn") & (rows["group"] == "all")]
    assert knn.loc[knn["training"] == "simulated", "value"].min() > 0.9
    assert set(knn["training"]) == {"real", "simulated", "both"} and set(knn["aligned"].dropna()) == {True, False}
    assert set(rows["group"]) == {"all", "ball", "box"} and set(rows["split"]) == {"blocks"}
    pressed = read_arrays(workspace.data / "simulated_to_real/cube.npz")
    assert {kind: images.shape for kind, images in pressed.items()} == {"resting": (24, 28, 50)}


def test_the_objects_of_a_class_share_its_imprints():
    assert shares({"ball": ["a", "b", "c"], "box": ["d"]}, 48) == {"a": 16, "b": 16, "c": 16, "d": 48}
    assert sum(shares({"ball": ["a", "b", "c"]}, 10).values()) == 10


def test_an_object_lies_on_the_array_at_its_true_size(monkeypatch):
    brick = mesh_of(trimesh.creation.box((0.8, 0.4, 0.05)))  # 38 x 19 mm, flat: lies on its large sides
    monkeypatch.setattr(stage, "ASIDE", 0.0)
    touches = simulate("resting", brick, 48, CELLS, 0.038, np.random.default_rng(0))
    assert touches.shape == (48, *CELLS)
    cells = 38 * 19 / PITCH**2
    assert np.median((touches > 0.5).sum(axis=(1, 2))) == pytest.approx(cells, rel=0.1)
    smaller = simulate("resting_small", brick, 48, CELLS, 0.038, np.random.default_rng(0))
    shrunk = cells * (PITCH / LARGE_PITCH) ** 2
    assert np.median((smaller > 0.5).sum(axis=(1, 2))) == pytest.approx(shrunk, rel=0.15)


@pytest.mark.slow
@pytest.mark.parametrize("kind", SIMULATIONS)
def test_simulated_touches_are_pressures_and_the_same_in_every_run(kind):
    ball = mesh_of(SOLIDS["sphere"])
    touches, again = (simulate(kind, ball, 4, CELLS, 0.04, np.random.default_rng(0)) for _ in range(2))
    assert np.array_equal(touches, again) and touches.min() >= 0 and touches.max() <= 1
    assert (touches.max(axis=(1, 2)) > 0.25).all() and touches[:, 0, 0].max() < 0.5
