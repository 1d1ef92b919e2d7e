"""The model of gaze whose choices never saw the object: what is chosen, and from what."""

import numpy as np
import pandas as pd
import pytest

from stages.attention_settings import nested
from stages.attention_settings.nested import Seen, choose
from stages.kit import Mesh
from stages.kit.files import write_arrays, write_mesh
from stages.weights import fit_fixations


def objects(count=8, points=400, seed=0):
    """Objects with gaze that one of six features draws, and noise in the others."""
    random, found = np.random.default_rng(seed), {}
    for k in range(count):
        features = {f"f{j}": random.normal(size=points) for j in range(6)}
        shares = np.exp(features["f3"])
        found[f"o{k}"] = Seen(features, random.multinomial(200, shares / shares.sum()).astype(float), np.ones(points))
    return found


def around(found):
    names = tuple(found["o0"].features)
    return fit_fixations(
        [one.stacked(names) for one in found.values()], [one.amounts for one in found.values()],
        [one.areas for one in found.values()],
    )  # fmt: skip


def test_the_feature_that_draws_gaze_is_chosen_and_little_else():
    found = objects()
    features, ridge = choose(found, around(found))
    assert "f3" in features and len(features) <= 3 and ridge in nested.RIDGES and ridge < 0.1


def test_pure_noise_is_held_down_by_the_strongest_ridge():
    found = {name: one._replace(amounts=np.roll(one.amounts, 57)) for name, one in objects().items()}
    assert choose(found, around(found))[1] >= 0.1


@pytest.fixture
def judged(tmp_path, monkeypatch):
    """A function from objects to the rows of the model of vertices, without meshes to be looked at."""
    monkeypatch.setitem(nested.FIXED, "fixations", ("f0", "f3"))

    def rows(found):
        for name, one in found.items():
            arrays = {"amounts": one.amounts, "density": one.amounts + 0.01, "areas": one.areas}
            write_arrays(tmp_path / f"weights/ground_truth/{name}.npz", **arrays)
            features = {f"feature {key}": values for key, values in one.features.items()}
            write_arrays(tmp_path / f"{nested.PICTURES}/{name}.npz", **features)
            write_mesh(tmp_path / f"meshes/{name}.npz", Mesh(np.eye(3), np.array([[0, 1, 2]])))
        return pd.DataFrame(nested.process("fixations", tmp_path, tmp_path, tmp_path, list(found)))

    return rows


def test_an_objects_own_gaze_changes_nothing_that_is_chosen_for_it(judged):
    found = objects(count=5)
    before = judged(found).set_index(["item", "method", "metric"])
    found["o2"] = found["o2"]._replace(amounts=np.roll(found["o2"].amounts, 31))
    after = judged(found).set_index(["item", "method", "metric"])
    chosen = ["features", "ridge"]
    assert (
        before.loc["o2"].loc["fixations_nested"].loc[chosen].equals(after.loc["o2"].loc["fixations_nested"].loc[chosen])
    )
    assert (
        before.loc[("o2", "fixations_nested", "features"), "channels"]
        == after.loc[("o2", "fixations_nested", "features"), "channels"]
    )
    assert not before.loc["o1"]["value"].equals(after.loc["o1"]["value"])  # of the others it was learned from
    assert before.loc[("o0", "fixations_nested", "nss"), "value"] > 0.3
    assert set(before.reset_index()["method"]) == {"fixations_once", "fixations_nested"}
    assert (before.xs("fixations_once", level="method").xs("features", level="metric")["value"] == 2).all()
