"""Checks on meshes with human gaze: what is judged, on which objects, from which viewpoints."""

import numpy as np
import pytest
import trimesh

from haptic_glance.base.files import read_json, write_arrays, write_mesh
from haptic_glance.look.glance import samples_of_mesh, standardised
from haptic_glance.mesh import normalise
from haptic_glance.mesh.mesh import Mesh
from stages.attention_checks.__main__ import run
from stages.engine.rows import read_rows
from stages.weights.ground_truth import spread_on_surface


def shape(height):
    solid = trimesh.creation.cone(0.3, height).subdivide().subdivide().subdivide()
    return normalise(Mesh(np.array(solid.vertices), np.array(solid.faces)))


def gaze_at_the_tip(mesh):
    amounts = np.where(mesh.vertices[:, 2] > np.quantile(mesh.vertices[:, 2], 0.9), 1.0, 0.0)
    samples = samples_of_mesh(mesh)
    glance = standardised(samples)
    return {
        "amounts": amounts, "density": spread_on_surface(mesh, amounts, 0.03), "areas": mesh.vertex_areas,
        "glance": np.stack(list(glance.values()), axis=1), "glance_names": np.array(list(glance)),
        "glance_amounts": np.bincount(samples.tree.query(mesh.vertices)[1], amounts, minlength=len(samples.points)),
        "glance_areas": samples.areas,
    }  # fmt: skip


@pytest.fixture
def workspace(make_workspace, monkeypatch):
    monkeypatch.setattr("haptic_glance.look.points.find.VIEW_SIZE", (225, 300))
    workspace = make_workspace({"attention_checks": {"views": ["four"]}})
    for name, height in (("low", 0.5), ("middle", 0.6), ("high", 0.7)):
        mesh = shape(height)
        write_mesh(workspace.data / f"meshes/{name}.npz", mesh)
        write_arrays(workspace.data / f"weights/ground_truth/{name}.npz", **gaze_at_the_tip(mesh))
    return workspace


@pytest.mark.slow
def test_every_check_is_made_on_every_object(workspace):
    run(workspace)
    rows = read_rows(workspace.measurements / "attention_checks.csv.gz")
    assert set(rows["item"]) == {"low", "middle", "high"}
    assert set(rows["method"]) == {"equal", "glance_once", "glance_nested"}
    equal = rows[rows["method"] == "equal"]
    assert set(equal["views"]) == {"four"} and set(equal["metric"]) == {"nss", "auc"} and (equal["seconds"] > 0).all()
    nss = rows[(rows["method"] == "glance_nested") & (rows["metric"] == "nss")]
    assert nss["value"].min() > 0.5  # all three are looked at where they end
    assert set(read_json(workspace.metrics / "attention_checks.json")) == {"equal.four", "glance_once", "glance_nested"}
    for name in ("low", "high"):
        (workspace.data / f"weights/ground_truth/{name}.npz").unlink()
    with pytest.raises(ValueError, match="1 objects with ground truth; two are needed"):
        run(workspace)
