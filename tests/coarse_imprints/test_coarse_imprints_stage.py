"""Frozen filters on coarse imprints: what a variant changes, and a run on two classes."""

import numpy as np
import pandas as pd
import pytest
import torch
import trimesh

from haptic_glance.base.files import read_arrays, write_arrays, write_mesh, write_table
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import Skin
from stages.coarse_imprints.__main__ import VARIANTS, run
from stages.compose import compose
from stages.engine.rows import read_rows

pytestmark = pytest.mark.slow

SETTINGS = {
    "variants": ["random_weights"], "detector": "thesis_ssim", "touches": 8, "width": 0.16, "repetitions": 2,
    "epochs": 4, "search_epochs": 1, "batch": 8, "momentum": 0.9,
}  # fmt: skip
IMPRINTS = np.random.default_rng(0).random((2, 16, 16)).astype(np.float32)


def test_imprints_are_red_alone_or_grey():
    plain, grey = VARIANTS["plain"].images(IMPRINTS), VARIANTS["three_channels"].images(IMPRINTS)
    assert plain.shape == grey.shape == (2, 3, 80, 80)
    assert (plain[:, 1:] == 0).all() and torch.equal(grey[:, 1], plain[:, 0])


def test_blocks_are_of_equal_pixels():
    blocks, plain = (VARIANTS[name].images(IMPRINTS)[0, 0, :5, :5] for name in ("blocks", "plain"))
    assert torch.unique(blocks).numel() == 1 < torch.unique(plain).numel()


def test_each_variant_differs_from_the_plain_one():
    assert len(set(map(repr, VARIANTS.values()))) == len(VARIANTS) and VARIANTS["plain"].skin == Skin()


def test_the_settings_name_all_variants():
    assert compose(["experiment=coarse_imprints"])["furniture"]["coarse_imprints"]["variants"] == list(VARIANTS)


@pytest.fixture
def workspace(make_workspace):
    workspace = make_workspace({"coarse_imprints": SETTINGS})
    solids = {"ball": trimesh.creation.icosphere(3, radius=0.4), "cube": trimesh.creation.box((0.5, 0.5, 0.5))}
    for name, solid in solids.items():
        for number in (1, 2):
            turned = solid.subdivide() if name == "ball" else solid.subdivide().subdivide().subdivide()
            mesh = Mesh(np.array(turned.vertices * (1 - 0.1 * number)), np.array(turned.faces))
            write_mesh(workspace.data / f"meshes/{name}{number}.npz", mesh)
            points = {"thesis_ssim.points": np.arange(4), "thesis_ssim.strong": np.int64(4)}
            write_arrays(workspace.data / f"salient_points/{name}{number}.npz", **points)
    pairs = [(name, f"{name}{number}") for name in solids for number in (1, 2)]
    write_table(workspace.data / "meshes/classes.csv", pd.DataFrame(pairs, columns=["class", "object"]))
    return workspace


def test_a_run_trains_each_variant_on_every_split_and_refuses_a_detector_without_points(workspace, make_workspace):
    run(workspace)
    rows = read_rows(workspace.measurements / "coarse_imprints.csv.gz")
    assert rows["repetition"].tolist() == [0, 1] and set(rows["split"]) == {"random"} and set(rows["chance"]) == {0.5}
    assert rows["value"].between(0, 1).all() and set(rows["weights"]) == {"random"}
    pressed = read_arrays(workspace.data / "coarse_imprints/imprints/ball1.npz")
    assert {cells: images.shape for cells, images in pressed.items()} == {"16": (8, 16, 16), "vertices": (8,)}
    with pytest.raises(ValueError, match="detector=glance is not one of thesis_ssim"):
        run(make_workspace({"coarse_imprints": SETTINGS | {"detector": "glance"}}))
