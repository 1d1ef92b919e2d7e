"""The glance whose choices never saw the object: what is chosen, and from what."""

import numpy as np
import pandas as pd
import pytest

from haptic_glance.base.files import write_arrays
from haptic_glance.look.weights import fit_fixations, fixation_density
from stages.attention_checks import __main__ as checks
from stages.attention_checks.__main__ import Seen, choose


def objects(count=8):
    """Objects with gaze that one of six features draws, and noise in the others."""
    random, items = np.random.default_rng(0), {}
    for k in range(count):
        features = {f"f{j}": random.normal(size=400) for j in range(6)}
        shares = np.exp(features["f3"])
        items[f"o{k}"] = Seen(features, random.multinomial(200, shares / shares.sum()).astype(float), np.ones(400))
    return items


def around(responses):
    names = tuple(responses["o0"].features)
    amounts = [item.amounts for item in responses.values()]
    return fit_fixations(
        [item.stacked(names) for item in responses.values()], amounts, [np.ones(len(a)) for a in amounts]
    )


def test_the_feature_that_draws_gaze_is_chosen_and_little_else():
    items = objects()
    features, ridge = choose(items, around(items))
    assert "f3" in features and len(features) <= 3 and ridge in checks.RIDGES and ridge < 0.1


def test_pure_noise_is_held_down_by_the_strongest_ridge():
    items = {name: item._replace(amounts=np.roll(item.amounts, 57)) for name, item in objects().items()}
    assert choose(items, around(items))[1] >= 0.1


@pytest.fixture
def judged(tmp_path, monkeypatch):
    """A function from objects to their rows, without meshes to be looked at."""
    monkeypatch.setattr(checks, "FIXED", ("f0", "f3"))

    def rows(responses):
        def saliency(path, weights):
            return fixation_density(responses[path.stem].features, weights)

        monkeypatch.setattr(checks, "_saliency", saliency)
        for name, item in responses.items():
            arrays = {"amounts": item.amounts, "density": item.amounts + 0.01, "areas": np.ones(len(item.amounts))}
            arrays |= {"glance": item.stacked(tuple(item.features)), "glance_names": np.array(list(item.features))}
            write_arrays(
                tmp_path / f"weights/ground_truth/{name}.npz",
                **arrays,
                glance_amounts=item.amounts,
                glance_areas=item.areas,
            )
        return pd.DataFrame(checks.process_nested("glance", tmp_path, tmp_path, list(responses)))

    return rows


def test_an_objects_own_gaze_changes_nothing_that_is_chosen_for_it(judged):
    items = objects(count=5)
    before = judged(items).set_index(["item", "method", "metric"])
    items["o2"] = items["o2"]._replace(amounts=np.roll(items["o2"].amounts, 31))
    after = judged(items).set_index(["item", "method", "metric"])
    chosen = ["features", "ridge"]
    assert before.loc["o2"].loc["glance_nested"].loc[chosen].equals(after.loc["o2"].loc["glance_nested"].loc[chosen])
    assert (
        before.loc[("o2", "glance_nested", "features"), "chosen"]
        == after.loc[("o2", "glance_nested", "features"), "chosen"]
    )
    assert not before.loc["o1"]["value"].equals(after.loc["o1"]["value"])  # of the others it was learned from
    assert before.loc[("o0", "glance_nested", "nss"), "value"] > 0.3
    assert set(before.reset_index()["method"]) == {"glance_once", "glance_nested"}
    assert (before.xs("glance_once", level="method").xs("features", level="metric")["value"] == 2).all()
