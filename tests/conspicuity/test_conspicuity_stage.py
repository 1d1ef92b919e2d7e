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
SECTION = {"channels": ["intensity", "edge"], "size": [45, 60], "background": "filled", "symmetry": "perceived",
           "formulas": "ours", "compare_background": True}  # fmt: skip


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
def test_maps_of_all_views_and_their_measurements(workspace):
    stage.run(workspace)
    maps, mask, viewpoints, channels = read_maps(workspace.data / "conspicuity" / "brick.npz")
    assert maps.shape == (4, 2, 45, 60) and mask.shape == (4, 45, 60) and channels == SECTION["channels"]
    assert maps[:, 1].max() > 0 and not maps[~np.broadcast_to(mask[:, None], maps.shape)].any()
    rows = read_rows(workspace.measurements / "conspicuity.csv.gz")
    counts = rows.groupby(["item", "metric"]).size().to_dict()
    assert counts == {("brick", "silhouette_share"): 8, ("brick", "silhouette_share_unfilled"): 2}
    found = rows[rows.metric == "silhouette_share"]
    assert found.viewpoint.unique().tolist() == [viewpoint.name for viewpoint in viewpoints]
    assert found.value.notna().all() and (found.seconds > 0).all() and set(found.method) == set(channels)
    metrics = read_json(workspace.metrics / "conspicuity.json")
    assert metrics == {"maps": 8, "silhouette_share": pytest.approx(found.value.mean(), rel=1e-5)}


@pytest.mark.parametrize(("setting", "shown"), [("perceived", False), ("strongest", True)])
def test_a_brick_has_a_radial_map_where_its_strongest_axis_counts(make_workspace, setting, shown):
    section = SECTION | {"channels": ["symmetry_radial"], "symmetry": setting}
    workspace = make_workspace({"views": VIEWS, "conspicuity": section})
    write_object(workspace, "brick", (0.2, 0.4, 0.6))
    stage.run(workspace)
    assert read_maps(workspace.data / "conspicuity" / "brick.npz")[0].any() == shown


def test_one_object_more_costs_one_object(workspace, monkeypatch):
    stage.run(workspace)
    measured = []
    measure = stage.measured_maps

    def noted(*arguments):
        measured.append(arguments)
        return measure(*arguments)

    monkeypatch.setattr(stage, "measured_maps", noted)
    write_object(workspace, "plate", (0.6, 0.6, 0.1))
    stage.run(workspace)
    assert len(measured) == 4 and set(read_rows(workspace.measurements / "conspicuity.csv.gz").item) == {
        "brick",
        "plate",
    }


@pytest.mark.slow
def test_a_background_that_is_kept_is_filtered_with_the_object(workspace, make_workspace):
    found = {}
    for background in ("filled", "kept"):
        stage.run(make_workspace({"views": VIEWS, "conspicuity": SECTION | {"background": background}}))
        rows = read_rows(workspace.measurements / "conspicuity.csv.gz").set_index(["metric", "viewpoint", "method"])
        found[background] = rows["value"]
    unfilled = found["filled"]["silhouette_share_unfilled"]
    assert found["kept"]["silhouette_share"][unfilled.index].to_numpy() == pytest.approx(unfilled.to_numpy())
    assert (found["filled"]["silhouette_share"][unfilled.index] != unfilled).any()


def test_an_unknown_channel_is_named(make_workspace):
    with pytest.raises(ValueError, match="glitter"):
        stage.run(make_workspace({"conspicuity": SECTION | {"channels": ["glitter"]}}))
    with pytest.raises(ValueError, match="conspicuity.background='green': choose one of filled, kept"):
        stage.run(make_workspace({"conspicuity": SECTION | {"background": "green"}}))
