"""The benchmark of real touches: what is held out, what is left out, and how objects are laid on the array."""

import numpy as np
import pandas as pd
import pytest
import trimesh

from benchmarks import _grasps, _recorded, _simulated
from benchmarks._grasps import drift_rows, grasp_rows
from stages.classification.recorded import ELECTRODES, PALMS, Grasps
from stages.kit import Mesh
from stages.kit.files import write_mesh, write_table


def touches(classes=7, count=12, noise=0.2, seed=0):
    """{class: (count, 16, 16)}: a bar at a place of its own, with noise."""
    random, found = np.random.default_rng(seed), {}
    for k in range(classes):
        bar = np.zeros((16, 16))
        bar[2 * k : 2 * k + 2] = 1
        found["abcdefghij"[k]] = np.clip(bar + noise * random.random((count, 16, 16)), 0, 1)
    return found


def quick(monkeypatch):
    monkeypatch.setattr(_recorded, "REPETITIONS", 2)
    monkeypatch.setattr(_recorded, "DRAWN", 1)
    monkeypatch.setattr(_recorded, "CLASSIFIERS", ["knn"])


def test_a_block_holds_out_neighbours_of_each_class():
    labels = np.repeat(["a", "b"], [20, 12])
    train, test = _recorded.blocked(labels, 3)
    assert sorted([*train, *test]) == list(range(32))
    for one, count in (("a", 5), ("b", 3)):
        own = np.sort(test[labels[test] == one])
        assert len(own) == count and (np.diff(own) == 1).all()
    assert len({tuple(_recorded.blocked(labels, number)[1]) for number in range(9)}) > 3


def test_bars_at_places_of_their_own_are_told_apart_and_none_is_left_out(monkeypatch):
    quick(monkeypatch)
    rows = pd.DataFrame(_recorded.recognition(touches(noise=0.01)))
    assert rows.loc[rows["metric"] == "accuracy_holdout", "value"].min() > 0.5  # chance is a quarter at most
    assert (rows.loc[rows["metric"] == "share_similar", "value"] == 0).all()
    assert set(rows["object"]) == {"all", *(f"{n}{end}" for n in ("six", "four") for end in ("", "_alike", "_drawn"))}
    assert rows.loc[rows["object"] == "four", "chosen"].dropna().tolist() == ["a b c d"]


def test_touches_that_resemble_another_class_leave_training_or_the_whole_set(monkeypatch):
    quick(monkeypatch)
    images = touches(noise=0.1, count=24)
    images["a"][::2], images["b"][::2] = images["a"][::2].transpose(0, 2, 1), images["a"][1::2].transpose(0, 2, 1)
    rows = pd.DataFrame(_recorded.recognition(images))
    whole = rows[(rows["object"] == "all") & (rows["metric"] == "accuracy_holdout")].set_index("method")
    assert whole.loc["selected", "test"].max() < whole.loc["all", "test"].min()  # the test part shrinks as well
    assert set(whole.loc["selected_training", "test"]) == set(whole.loc["all", "test"])
    assert whole.loc["selected_training", "train"].max() < whole.loc["all", "train"].min()
    alike = rows[(rows["object"] == "four_alike") & (rows["metric"] == "share_similar")]
    assert alike["chosen"].str.startswith("a b").all() and alike["value"].item() > 0.2


def test_a_set_of_which_too_little_is_left_says_so(monkeypatch):
    quick(monkeypatch)
    images = touches()
    images["b"] = images["a"]
    rows = pd.DataFrame(_recorded.recognition(images))
    selected = rows[(rows["object"] == "all") & (rows["method"] == "selected")]
    assert selected["value"].isna().all() and selected["note"].tolist() == ["a keeps 0 touches, 10 are needed"]


def test_repeated_poses_show_as_correlation_of_neighbours():
    random = np.random.default_rng(0)
    slow = np.repeat(random.random((6, 16, 16)), 4, axis=0)
    rows = pd.DataFrame(_recorded.neighbours({"a": slow})).set_index("metric")["value"]
    assert rows["neighbour_correlation"] > rows["pair_correlation"] + 0.3


def grasps(shift=0.0):
    """Twelve objects of which the last four are tests; the first electrode tells whether it slips."""
    random, names = np.random.default_rng(0), np.repeat([f"o{k:02}" for k in range(12)], 30)
    slipped = random.random(len(names)) < 0.5
    electrodes = random.normal(size=(len(names), len(ELECTRODES)))
    electrodes[:, :20] += 3 * slipped[:, None]
    test = names >= "o08"
    electrodes[test] += shift
    return Grasps(electrodes, names, np.tile(PALMS, len(names) // 3), slipped, test)


@pytest.fixture
def two_classifiers(monkeypatch):
    monkeypatch.setattr(_grasps, "REPETITIONS", 1)
    monkeypatch.setattr(_grasps, "GROUPS", 2)
    for name in ("svm", "decision_tree", "deep_learning"):
        monkeypatch.delitem(_simulated.CLASSIFIERS, name)  # one dict for all benchmarks


def test_slip_of_unseen_objects_is_learned_and_scaling_each_part_undoes_a_drift(two_classifiers):
    steady, drifted = pd.DataFrame(grasp_rows(grasps())), pd.DataFrame(grasp_rows(grasps(shift=40)))

    def unseen(rows, scaled):
        chosen = (rows["split"] == "unseen") & (rows["classifier"] == "knn") & (rows["palm"] == "all")
        return rows[chosen & (rows["scaled"] == scaled)]

    assert unseen(steady, "training")["value"].mean() > 0.9 and set(unseen(steady, "own")["object"]) == {
        "o08", "o09", "o10", "o11"}  # fmt: skip
    assert unseen(drifted, "training")["value"].mean() < 0.7 < 0.9 < unseen(drifted, "own")["value"].mean()
    left_out = steady[(steady["split"] == "left_out") & (steady["classifier"] == "knn")]
    assert set(left_out["object"]) == {f"o{k:02}" for k in range(8)} and left_out["value"].mean() > 0.9


@pytest.mark.parametrize("shift, beyond", [(0.0, False), (40.0, True)])
def test_a_drift_between_recordings_is_beyond_what_other_objects_bring(shift, beyond):
    rows = pd.DataFrame(drift_rows(grasps(shift=shift))).pivot(index="palm", columns="metric", values="value")
    assert ((rows["drift"] > 3 * rows["drift_drawn"]) == beyond).all()


def test_drift_is_told_in_deviations_of_the_objects():
    rows = [pd.DataFrame(drift_rows(grasps(shift))) for shift in (0, 40)]
    shares = [one.loc[one["metric"] == "drift", "value"].min() for one in rows]
    assert shares[0] < 3 < 30 < shares[1]


def store(folder, mesh, size, name="brick"):
    solid = Mesh(np.asarray(mesh.vertices, dtype=np.float64), np.asarray(mesh.faces, dtype=np.int64))
    write_mesh(folder / f"{name}.npz", solid)
    write_table(folder / "manifest.csv", pd.DataFrame({"object": [name], "size": [size]}))


def test_an_object_lies_on_the_array_at_its_true_size(monkeypatch, tmp_path):
    store(tmp_path, trimesh.creation.box((0.8, 0.4, 0.05)), size=0.038)  # 38 x 19 mm, flat: lies on its large sides
    monkeypatch.setattr(_simulated, "COUNTERPARTS", {"brick": ["brick"]})
    monkeypatch.setattr(_simulated, "ASIDE", 0.0)
    found = _simulated.simulate("resting", tmp_path, (28, 50))["brick"]
    assert found.shape == (_simulated.TOUCHES, 28, 50)
    cells = 38 * 19 / _simulated.PITCH**2
    assert np.median((found > 0.5).sum(axis=(1, 2))) == pytest.approx(cells, rel=0.1)
    smaller = _simulated.simulate("resting_small", tmp_path, (28, 50))["brick"]
    shrunk = cells * (_simulated.PITCH / _simulated.LARGE_PITCH) ** 2
    assert np.median((smaller > 0.5).sum(axis=(1, 2))) == pytest.approx(shrunk, rel=0.15)


@pytest.mark.parametrize("kind", _simulated.SIMULATIONS)
def test_simulated_touches_are_pressures_and_the_same_in_every_run(kind, monkeypatch, tmp_path):
    store(tmp_path, trimesh.creation.icosphere(2, radius=0.5), size=0.04)
    monkeypatch.setattr(_simulated, "COUNTERPARTS", {"brick": ["brick"]})
    monkeypatch.setattr(_simulated, "TOUCHES", 4)
    found, again = (_simulated.simulate(kind, tmp_path, (28, 50))["brick"] for _ in range(2))
    assert np.array_equal(found, again) and found.min() >= 0 and found.max() <= 1
    assert (found.max(axis=(1, 2)) > 0.25).all() and found[:, 0, 0].max() < 0.5


def test_simulation_of_the_same_objects_helps_and_alignment_is_told(monkeypatch, tmp_path, two_classifiers):
    store(tmp_path, trimesh.creation.icosphere(2, radius=0.5), size=0.04, name="a")
    for name in ("ball", "cube"):
        mesh = trimesh.creation.icosphere(2, radius=0.5) if name == "ball" else trimesh.creation.box((0.5, 0.5, 0.5))
        write_mesh(tmp_path / f"{name}.npz", Mesh(np.array(mesh.vertices), np.array(mesh.faces)))
    write_table(tmp_path / "manifest.csv", pd.DataFrame({"object": ["ball", "cube"], "size": [0.04, 0.03]}))
    monkeypatch.setattr(_simulated, "COUNTERPARTS", {"ball": ["ball"], "box": ["cube"]})
    monkeypatch.setattr(_simulated, "SIMULATIONS", {"resting": _simulated.SIMULATIONS["resting"]})
    monkeypatch.setattr(_simulated, "REPETITIONS", 2)
    monkeypatch.setattr(_simulated, "REAL", (0, 7))
    real = _simulated.simulate("resting", tmp_path, (28, 50), seed=1)  # other touches of the same objects
    rows = pd.DataFrame(_simulated.transfer_rows(real, tmp_path))
    knn = rows[(rows["classifier"] == "knn") & (rows["object"] == "all")]
    assert knn.loc[knn["training"] == "simulated", "value"].min() > 0.9
    assert set(knn["training"]) == {"real", "simulated", "both"} and set(knn["aligned"].dropna()) == {True, False}
    assert set(rows["object"]) == {"all", "ball", "box"}
