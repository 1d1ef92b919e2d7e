"""The stage on one object, and on a data set to which an object is added."""

import dataclasses

import numpy as np
import pytest

from haptic_glance.base.files import read_arrays, sha256, write_arrays, write_mesh, write_table
from haptic_glance.look.points.options import Detection
from haptic_glance.look.views import TWELVE
from stages.salient_points import Params
from stages.salient_points import __main__ as stage
from stages.salient_points.measure import (
    mean_spacing,
    measurement_rows,
    read_points,
    read_saliency,
    read_strong_points,
    summary,
)
from stages.weights.training import weight_table

METHODS = ["glance", "itti", "random"]
SETTINGS = Params(METHODS, 30, "suppression", 0.058, 0.02)


@pytest.fixture
def workspace(ball, spot, make_maps, make_workspace):
    """A data set of one object, without ground truth."""
    workspace = make_workspace({"salient_points": dataclasses.asdict(SETTINGS)})
    maps = make_maps(ball, spot)
    write_mesh(workspace.data / "meshes/ball.npz", ball)
    stacked = np.stack(list(maps.values()), axis=1).astype(np.float16)
    names = {"viewpoints": np.array([v.name for v in TWELVE]), "channels": np.array(list(maps))}
    write_arrays(workspace.data / "conspicuity/ball.npz", maps=stacked, mask=stacked[:, 0] > 0, **names)
    write_table(workspace.data / "weights/weights.csv", weight_table({}, "gaze"))
    return workspace


@pytest.mark.slow
def test_stage_writes_the_contract_the_same_bytes_twice_and_measures_every_method(workspace, tmp_path, ball):
    rows = stage.process("ball", tmp_path / "out", data=workspace.data, settings=SETTINGS, seed=0)
    stage.process("ball", tmp_path / "again", data=workspace.data, settings=SETTINGS, seed=0)
    path = tmp_path / "out/ball.npz"
    assert sha256(path) == sha256(tmp_path / "again/ball.npz")
    stored = read_arrays(path)
    kinds = {f"{method}.{kind}" for method in METHODS for kind in ("points", "strong", "saliency")}
    assert set(stored) == kinds - {"random.saliency"}
    for method in METHODS:
        assert stored[f"{method}.points"].shape == (30,) and stored[f"{method}.points"].dtype == np.int64
    assert stored["glance.saliency"].shape == (len(ball.vertices),)
    assert stored["glance.saliency"].dtype == np.float32
    points, strong = read_points(path), read_strong_points(path)
    assert list(points) == METHODS and list(read_saliency(path)) == ["glance", "itti"]
    assert len(strong["random"]) == len(strong["glance"]) == stored["glance.strong"]
    assert (points["itti"][: len(strong["itti"])] == strong["itti"]).all()
    assert {(row["method"], row["metric"]) for row in rows} == {
        (method, metric) for method in METHODS for metric in ("points_strong", "points", "spread", "saliency_at_points")
    }
    assert all(row["item"] == "ball" and row["seconds"] > 0 for row in rows)
    means = summary(rows)
    assert means["glance.points"] == 30
    assert means["glance.saliency_at_points"] > means["random.saliency_at_points"]


def test_what_does_not_apply_stays_out_of_the_summary_and_the_spread_of_a_unit_grid_is_one(ball):
    blind = Detection(np.array([0, 5]), 1, None)
    kinds = {"random.points", "random.points_strong", "random.spread"}
    assert set(summary(measurement_rows("ball", "random", blind, ball, None, 0.1))) == kinds
    assert mean_spacing(np.stack(np.meshgrid(range(3), range(4), [0]), axis=-1).reshape(-1, 3)) == 1
    assert np.isnan(mean_spacing(np.zeros((1, 3))))
