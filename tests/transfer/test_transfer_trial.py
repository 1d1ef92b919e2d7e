"""One training from imprints on disk to rows."""

import numpy as np
import pandas as pd
import pytest
import torch

from haptic_glance.base.files import read_arrays, sha256, write_arrays
from stages.transfer import plan, trial
from stages.transfer.plan import Trial, summary, trial_row
from stages.transfer.touches import read_touches

SIZE = 32
CLASSES = {"ramp": ["low", "steep"], "stripes": ["narrow", "wide"]}
MEMBERS = {"random": CLASSES, "objects": CLASSES}
FROZEN = Trial("imprints32", "mobilenet_v2", "random", "frozen", "random", 0)


@pytest.fixture
def folder(tmp_path):
    """Two classes of two objects that anybody can tell apart, whatever the reflection."""
    generator = np.random.default_rng(0)
    lines = np.arange(SIZE)
    plain = {"low": lines / 96, "steep": lines / 64, "narrow": lines // 2 % 2, "wide": lines // 4 % 2}
    for name, line in plain.items():
        images = np.clip(np.tile(line, (8, SIZE, 1)) + generator.normal(0, 0.05, (8, SIZE, SIZE)), 0, 1)
        images = np.round(images * 255).astype(np.uint8)
        write_arrays(tmp_path / "imprints" / f"{name}.npz", imprints32=images, vertices=np.arange(8))
    return tmp_path


def run(folder, settings, one=FROZEN):
    return trial.process(one.name, folder, folder, MEMBERS, settings, seed=0)


def plain(rows):
    return {row["metric"]: row["value"] for row in rows if "perturbation" not in row and "layer" not in row}


def test_touches_know_their_class_and_object(folder):
    touches = read_touches(folder, CLASSES, "imprints32")
    assert touches.labels.tolist() == [0] * 16 + [1] * 16
    assert touches.ranks.tolist() == ([0] * 8 + [1] * 8) * 2
    assert np.bincount(touches.objects).tolist() == [8, 8, 8, 8]


@pytest.mark.slow
def test_a_trial_gives_equal_files_each_time_and_tidy_rows(folder, small):
    settings, file = small.settings(), f"{FROZEN.name}.npz"
    rows = run(folder, settings)
    first = [sha256(folder / part / file) for part in ("networks", "predictions")]
    assert run(folder, settings)[-1]["value"] == rows[-1]["value"]
    assert first == [sha256(folder / part / file) for part in ("networks", "predictions")]
    values = plain(rows)
    assert values["chance"] == 0.5 and values["trained_parameters"] == 2562 and values["weight_change"] == 0
    assert values["learning_rate"] in settings.frozen_rates and 0 <= values["accuracy"] <= 1
    assert {path.name for path in folder.iterdir()} == {"imprints", "networks", "predictions"}


def test_disturbed_touches_are_rows_of_their_own(folder, small):
    rows = [trial_row(row, {"mobilenet_v2": None}, small.settings()) for row in run(folder, small.settings())]
    disturbed = pd.DataFrame([row for row in rows if row["metric"] == "disturbed_accuracy"])
    asked = [("noise", 0.01), ("noise", 0.5), ("few_touches", 0.5)]
    assert list(zip(disturbed["perturbation"], disturbed["severity"], strict=True)) == asked
    assert disturbed["value"].between(0, 1).all()
    assert not any("layer" in row or "trial" in row for row in rows)
    assert {row["split"] for row in rows} == {"random"} and {row["pretrained"] for row in rows} == {None}


@pytest.mark.slow
def test_a_left_out_object_is_tested_and_a_range_changes_its_other_layers(folder, small):
    one = FROZEN._replace(mode="18:139", split="objects")
    rows = run(folder, small.settings(epochs=1, search_epochs=1), one)
    assert read_arrays(folder / "predictions" / f"{one.name}.npz")["test"].tolist() == [*range(8), *range(16, 24)]
    changes = pd.DataFrame([row for row in rows if "layer" in row]).groupby("part")["value"].mean()
    assert changes["Conv1"] > 0 and changes["block_16"] > 0 and changes["block_2"] == changes["block_15"] == 0
    assert plain(rows)["weight_change"] == pytest.approx(np.mean([row["value"] for row in rows if "layer" in row]))


@pytest.mark.slow
def test_a_trial_killed_in_its_last_training_seeks_no_rate_again(folder, small, monkeypatch):
    settings = small.settings(severities={})
    expected = plain(run(folder, settings))
    train_model = trial.train_model

    def killed(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr(trial, "train_model", killed)
    with pytest.raises(KeyboardInterrupt):
        run(folder, settings)
    monkeypatch.setattr(trial, "train_model", train_model)
    monkeypatch.setattr(trial, "search_rate", killed)
    assert plain(run(folder, settings)) == expected


def test_what_a_network_saw_and_computed_in_stands_in_its_rows(small, monkeypatch):
    settings = small.settings(size=48, touches=9)
    row = {"trial": FROZEN.name, "metric": "accuracy", "value": 1.0}
    found = trial_row(row, {"mobilenet_v2": None}, settings)
    assert (found["size"], found["touches"], found["precision"]) == (48, 9, "float32")
    monkeypatch.setattr(plan, "choose_device", lambda name: torch.device("cuda"))
    assert trial_row(row, {"mobilenet_v2": None}, settings)["precision"] == "float16"


def test_too_little_memory_for_the_cached_features_names_the_remedy(folder, small, monkeypatch):
    def full(*_):
        raise RuntimeError("[enforce fail] DefaultCPUAllocator: can't allocate memory: you tried to allocate 9 bytes")

    monkeypatch.setattr("haptic_glance.deep.modes.torch.stack", full)
    with pytest.raises(ValueError, match="too little memory: .*fewer cached copies .the stage's `batch`, `size`"):
        run(folder, small.settings())


CONVERGED = FROZEN._replace(passes="converged")


def test_a_training_to_convergence_has_its_curve_its_best_pass_and_the_accuracy_on_each_object(folder, small):
    settings = small.settings(most_epochs=60, patience=6, frozen_rates=[0.01], search_epochs=1)
    rows = pd.DataFrame(run(folder, settings, CONVERGED))
    values = rows.drop_duplicates("metric").set_index("metric")["value"]
    curve = rows.dropna(subset=["epoch"]).pivot(index="epoch", columns="metric", values="value")
    assert curve.index.tolist() == list(range(1, int(values["epochs"]) + 1)) and values["epochs"] < 60
    assert values["validation_accuracy"] == curve["curve_validation_accuracy"].max()
    assert values["train_accuracy"] > 0.7
    objects = rows[rows["metric"] == "object_accuracy"]
    assert objects["item"].tolist() == ["low", "steep", "narrow", "wide"]
    assert objects["group"].tolist() == ["ramp", "ramp", "stripes", "stripes"]
    assert objects["value"].mean() == pytest.approx(values["accuracy"])  # as many test touches of each
    assert "disturbed_accuracy" not in set(rows["metric"])


def test_an_object_s_accuracy_is_that_of_its_own_test_touches(folder):
    touches, test = read_touches(folder, CLASSES, "imprints32"), np.array([0, 1, 8, 9, 16, 17])
    found = torch.tensor([[0.9, 0.1], [0.2, 0.8], [0.9, 0.1], [0.8, 0.2], [0.9, 0.1], [0.7, 0.3]])
    rows = list(trial.object_rows(found, touches, test, CLASSES))
    assert [(row["item"], row["value"]) for row in rows] == [("low", 0.5), ("steep", 1.0), ("narrow", 0.0)]


def test_the_printed_training_has_a_training_accuracy_over_all_training_touches(folder, small, monkeypatch):
    learned = []
    train_model = trial.train_model
    monkeypatch.setattr(
        trial, "train_model", lambda *given, **other: learned.append(given[2]) or train_model(*given, **other)
    )
    values = plain(run(folder, small.settings(severities={})))
    run(folder, small.settings(), CONVERGED)
    assert values["epochs"] == 4 and 0 <= values["train_accuracy"] <= 1
    assert [len(ids) for ids in learned] == [24, 16]  # a third of eight touches of each object validates


def test_a_training_that_diverges_is_one_row_with_a_note(folder, small):
    rows = run(folder, small.settings(frozen_rates=[1e38]), CONVERGED)
    assert len(rows) == 1 and rows[0]["value"] is None and "diverged: loss is not finite in pass" in rows[0]["note"]
    assert {path.name for path in folder.iterdir()} == {"imprints"}
    row = trial_row(rows[0], {"mobilenet_v2": None}, small.settings())
    assert row["passes"] == "converged"
    assert summary([row], 0) == {}


def test_a_control_with_the_statistics_it_begins_with_has_other_features(folder, small):
    touches = read_touches(folder, CLASSES, "imprints32")
    features = [
        trial.prepare(one, touches, np.arange(24), small.settings(), 0)[1].inputs(torch.arange(4))
        for one in (FROZEN, FROZEN._replace(weights="random_initial"))
    ]
    assert features[0].std(dim=0).max() > 1e-3 > 1e-6 > features[1].std(dim=0).max() > 0


def test_summary_has_an_interval_over_repetitions_and_none_for_a_single_one():
    known = {"data": "imprints128", "method": "alexnet", "weights": "random", "mode": "frozen", "split": "objects"}
    rows = [known | {"metric": "chance", "value": 0.5}]
    rows += [known | {"metric": "accuracy", "value": value} for value in (0.6, 0.8)]
    found = summary(rows, 0)
    assert found["chance"] == {"objects": 0.5}
    assert found["imprints128"]["objects"]["alexnet"] == {
        "frozen_random": {"mean": 0.7, "low": -0.216817, "high": 1.616817}
    }
    assert summary(rows[:2], 0)["imprints128"]["objects"]["alexnet"] == {"frozen_random": {"mean": 0.6}}
    assert summary([], 0) == {}
