"""The stage on two small objects: maps, measurements, and one object more costs one object."""

import numpy as np
import pytest
import trimesh

from haptic_glance.base.files import read_json, write_mesh
from haptic_glance.mesh.mesh import Mesh
from stages.conspicuity import __main__ as stage
from stages.conspicuity.measure import read_maps
from stages.engine.rows import read_rows
from stages.views.__main__ import run as run_views

VIEWS = {"viewpoints": "four", "size": [90, 120], "renderer": "raster", "background": "black",
         "compare_sets": False}  # fmt: skip
SECTION = {"channels": ["intensity", "symmetry_radial", "edge"], "size": [45, 60], "background": "filled",
           "symmetry": "perceived", "formulas": "ours", "compare_background": True}  # fmt: skip


def write_object(workspace, name, size):
    shape = trimesh.creation.box(size, trimesh.transformations.euler_matrix(0.3, 0.4, 0.5))
    write_mesh(workspace.data / "meshes" / f"{name}.npz", Mesh(shape.vertices, shape.faces))
    run_views(workspace)


@pytest.fixture
def workspace(make_workspace):
    workspace = make_workspace({"views": VIEWS, "conspicuity": SECTION})
    write_object(workspace, "brick", (0.2, 0.4, 0.6))
    return workspace


@pytest.mark.slow
def test_maps_of_all_views_and_their_measurements_and_one_object_more_costs_one_object(workspace, monkeypatch):
    stage.run(workspace)
    maps, mask, viewpoints, channels = read_maps(workspace.data / "conspicuity" / "brick.npz")
    assert maps.shape == (4, 3, 45, 60) and mask.shape == (4, 45, 60) and channels == SECTION["channels"]
    assert maps[:, 2].max() > 0 and not maps[~np.broadcast_to(mask[:, None], maps.shape)].any()
    assert not maps[:, 1].any()  # a brick has no axis that people see
    rows = read_rows(workspace.measurements / "conspicuity.csv.gz")
    counts = rows.groupby(["item", "metric"]).size().to_dict()
    assert counts == {("brick", "silhouette_share"): 12, ("brick", "silhouette_share_unfilled"): 3}
    shares = rows[rows.metric == "silhouette_share"]
    assert shares.viewpoint.unique().tolist() == [viewpoint.name for viewpoint in viewpoints]
    seen = shares[shares.method != "symmetry_radial"]
    assert seen.value.notna().all() and (shares.seconds > 0).all() and set(shares.method) == set(channels)
    metrics = read_json(workspace.metrics / "conspicuity.json")
    assert metrics == {"maps": 12, "silhouette_share": pytest.approx(shares.value.mean(), rel=1e-5)}

    measured, measure = [], stage.measured_maps
    monkeypatch.setattr(stage, "measured_maps", lambda *args: measured.append(args) or measure(*args))
    write_object(workspace, "plate", (0.6, 0.6, 0.1))
    stage.run(workspace)
    assert len(measured) == 4
    assert set(read_rows(workspace.measurements / "conspicuity.csv.gz").item) == {"brick", "plate"}


def shares_of(workspace):
    rows = read_rows(workspace.measurements / "conspicuity.csv.gz").set_index(["metric", "viewpoint", "method"])
    return rows["value"]


@pytest.mark.slow
def test_a_background_that_is_kept_is_filtered_with_the_object_and_the_strongest_axis_has_a_map(
    workspace, make_workspace
):
    shares = {}
    for background in ("filled", "kept"):
        section = SECTION | {"background": background, "symmetry": "strongest"}
        stage.run(make_workspace({"views": VIEWS, "conspicuity": section}))
        shares[background] = shares_of(workspace)
    assert read_maps(workspace.data / "conspicuity" / "brick.npz")[0][:, 1].any()
    unfilled = shares["filled"]["silhouette_share_unfilled"].dropna()
    kept, filled = (shares[background]["silhouette_share"][unfilled.index] for background in ("kept", "filled"))
    assert len(unfilled) and kept.to_numpy() == pytest.approx(unfilled.to_numpy()) and (filled != unfilled).any()
