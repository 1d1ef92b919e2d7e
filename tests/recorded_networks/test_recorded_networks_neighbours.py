"""The classifier beside the networks: the same numbers as in the stage `recorded`."""

import numpy as np
import pandas as pd
import pytest

from stages.classification.recorded import ELECTRODES, PALMS, Grasps
from stages.recorded.biotac_grasps import Model
from stages.recorded.biotac_grasps import process as grasp_rows
from stages.recorded.pressure_images import class_sets, describe
from stages.recorded.pressure_images import process as image_rows
from stages.recorded_networks import data
from stages.recorded_networks.data import neighbour_rows


@pytest.fixture
def images():
    random = np.random.default_rng(0)
    return {name: random.random((16, 16)) + 0.5 * random.random((12, 16, 16)) for name in "abcdef"}


@pytest.fixture
def grasps():
    random, names = np.random.default_rng(0), np.repeat([f"o{k:02}" for k in range(12)], 30)
    electrodes = random.normal(size=(len(names), len(ELECTRODES)))
    slipped = random.random(len(names)) + 0.2 * electrodes[:, 0] < 0.5
    return Grasps(electrodes, names, np.tile(PALMS, len(names) // 3), slipped, names >= "o08")


def values(rows, **where):
    frame = pd.DataFrame(rows)
    for column, wanted in where.items():
        frame = frame[frame[column] == wanted]
    return frame["value"].tolist()


@pytest.mark.slow
@pytest.mark.parametrize("split", ["random", "blocks"])
def test_pressure_images(images, split, monkeypatch, tmp_path):
    monkeypatch.setattr(data, "read_pressure_images", lambda path: images)
    found = neighbour_rows("pressure_images", tmp_path, 2, seed=0)
    touches = describe(images)
    same = image_rows(class_sets(touches, 2, 0)["all"], tmp_path, touches, 0)
    where = {"classifier": "knn", "method": "all", "metric": "accuracy", "split": split, "scaling": "training"}
    assert values(found, split=split) == values(same, **where) and len(values(found, split=split)) == 2
    assert {row["method"] for row in found} == {"features_knn"}


def test_grasps(grasps, monkeypatch, tmp_path):
    monkeypatch.setattr(data, "read_grasps", lambda path: grasps)
    found = pd.DataFrame(neighbour_rows("biotac_grasps", tmp_path, 1, seed=0))
    same = pd.DataFrame(grasp_rows(Model("knn", None), tmp_path, grasps, 1, 0))
    same = same[same["scaled"] == "training"]
    slips = same[(same["split"] == "test_objects") & (same["palm"] == "all")]
    mine = found[found["data"] == "grasps_slip"]
    assert (
        mine["value"].tolist()[:-1] == slips["value"].tolist() and mine["item"].tolist()[:-1] == slips["item"].tolist()
    )
    assert mine["value"].iloc[-1] == pytest.approx(np.average(slips["value"], weights=slips["count"]))
    recognised = same.loc[same["task"] == "recognition", "value"].tolist()
    assert found.loc[found["data"] == "grasps_object", "value"].tolist() == recognised


def test_pictures_of_cameras_have_no_such_features(tmp_path):
    assert neighbour_rows("vitac", tmp_path, 2, seed=0) == []
