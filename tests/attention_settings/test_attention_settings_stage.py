"""The model of gaze from few pictures: what is measured, left out and counted."""

import numpy as np
import pytest
import trimesh

from stages.attention_settings.__main__ import choices_of, run
from stages.attention_settings.judge import CHOICES, cost, left_out
from stages.attention_settings.measure import measure, parse
from stages.attention_settings.schema import Params
from stages.conspicuity import CHANNELS
from stages.kit import Mesh
from stages.kit.files import read_json, write_arrays, write_mesh
from stages.kit.rows import read_rows
from stages.meshes import normalise
from stages.views import TWELVE
from stages.weights.agreement import GroundTruth
from stages.weights.ground_truth import spread_on_surface

SETTINGS = {"pictures": ["two-48", "one-48"], "full": ["two-48"], "channels": ["none", "symmetry"]}


def shape(height):
    solid = trimesh.creation.cone(0.3, height)
    solid = solid.subdivide().subdivide().subdivide()
    return normalise(Mesh(np.array(solid.vertices), np.array(solid.faces)))


def gaze_at_the_tip(mesh):
    amounts = np.where(mesh.vertices[:, 2] > np.quantile(mesh.vertices[:, 2], 0.9), 1.0, 0.0)
    return {"amounts": amounts, "density": spread_on_surface(mesh, amounts, 0.03), "areas": mesh.vertex_areas}


@pytest.fixture
def workspace(make_workspace):
    workspace = make_workspace({"attention_settings": SETTINGS})
    for name, height in (("low", 0.5), ("middle", 0.6), ("high", 0.7)):
        mesh = shape(height)
        write_mesh(workspace.data / f"meshes/{name}.npz", mesh)
        write_arrays(workspace.data / f"weights/ground_truth/{name}.npz", **gaze_at_the_tip(mesh))
    return workspace


@pytest.mark.slow
def test_every_choice_is_judged_on_every_object(workspace):
    run(workspace)
    rows = read_rows(workspace.measurements / "attention_settings.csv.gz").fillna({"channels": "none"})
    full = rows[rows["views"] == "two"]
    assert set(full["channels"]) == set(CHOICES) and set(rows.loc[rows["views"] == "one", "channels"]) == {
        "none", "symmetry"}  # fmt: skip
    assert set(rows["item"]) == {"low", "middle", "high"} and set(rows["metric"]) == {"nss", "auc"}
    assert "equal" not in set(full.loc[full["channels"] == "none", "method"])
    model = full[(full["method"] == "fixations") & (full["channels"] == "none") & (full["metric"] == "nss")]
    assert model["value"].min() > 0.5  # all three are looked at where they end
    nine = full.loc[(full["channels"] == "nine") & (full["method"] == "fixations"), "seconds"].mean()
    assert nine > full.loc[full["channels"] == "none", "seconds"].mean() > 0
    assert "two-48.nine" in read_json(workspace.metrics / "attention_settings.json")
    assert not list((workspace.data / "attention_settings").iterdir())


def test_an_object_is_not_learned_from_itself():
    features = {name: {"a": np.arange(4.0), "b": np.ones(4)} for name in "xyz"}
    truths = {name: GroundTruth(np.arange(4.0), np.arange(4.0) / 6, np.ones(4)) for name in "xyz"}
    before = left_out(features, truths, ["a", "b"])
    truths["x"] = GroundTruth(np.arange(4.0)[::-1].copy(), np.arange(4.0)[::-1] / 6, np.ones(4))
    after = left_out(features, truths, ["a", "b"])
    assert np.array_equal(before["x"], after["x"]) and not np.array_equal(before["y"], after["y"])


def test_without_channels_no_picture_is_paid_for():
    _, _, seconds = measure(shape(0.5), TWELVE[:1], 48)
    assert set(seconds) == {"pictures", "facing", "view_maps", "features", *CHANNELS}
    assert cost(seconds, (), "fixations") == seconds["facing"] + seconds["features"]
    assert cost(seconds, ("edge",), "equal") == seconds["pictures"] + seconds["view_maps"] + seconds["edge"]


@pytest.mark.parametrize("picture", ["three-900", "twelve", "twelve-many"])
def test_a_strange_set_of_pictures_is_named(picture):
    with pytest.raises(ValueError, match=f"'{picture}' is not VIEWS-ROWS"):
        parse(picture)


def test_a_strange_choice_of_channels_is_named():
    with pytest.raises(ValueError, match="'colour' is not one of none, symmetry"):
        choices_of(Params(["two-48"], [], ["colour"]))
