"""One training from imprints on disk to rows, and the whole stage on two classes of two small objects."""

import copy
import dataclasses
import json

import numpy as np
import pandas as pd
import pytest
import torch
import trimesh

from haptic_glance.base.files import read_arrays, sha256, write_arrays, write_mesh, write_text
from haptic_glance.deep.network import Network, build
from haptic_glance.mesh.mesh import Mesh
from stages.engine.rows import read_rows
from stages.transfer import __main__ as stage
from stages.transfer import network_training
from stages.transfer.imprint_images import read_touches
from stages.transfer.onnx_export import network_parts, weight_changes
from stages.transfer.plan import Trial, summary, trial_row

pytestmark = pytest.mark.slow

SIZE = 32
CLASSES = {"ramp": ["low", "steep"], "stripes": ["narrow", "wide"]}
MEMBERS = {"random": CLASSES, "objects": CLASSES}
FROZEN = Trial("imprints32", "mobilenet_v2", "random", "frozen", "random", 0)
CONVERGED = FROZEN._replace(passes="converged")


@pytest.fixture(scope="module")
def imprints():
    """{object: images} of two classes of two objects that anybody can tell apart, whatever the reflection."""
    generator, line = np.random.default_rng(0), np.arange(SIZE)
    plain = {"low": line / 96, "steep": line / 64, "narrow": line // 2 % 2, "wide": line // 4 % 2}
    noise = {name: generator.normal(0, 0.05, (8, SIZE, SIZE)) for name in plain}
    return {name: np.round(255 * np.clip(plain[name] + noise[name], 0, 1)).astype(np.uint8) for name in plain}


@pytest.fixture
def folder(imprints, tmp_path):
    for name, images in imprints.items():
        write_arrays(tmp_path / "imprints" / f"{name}.npz", imprints32=images, vertices=np.arange(8))
    return tmp_path


@pytest.fixture
def row_of(small):
    """A function from a row of a training to the row of the stage."""
    return lambda row, **changes: trial_row(row, {"mobilenet_v2": None}, small.settings(**changes))


@pytest.fixture
def trained(monkeypatch):
    """[(how many touches a training learned from, its passes)] of the trainings to come."""
    calls, train_model = [], network_training.train_model

    def listed(task, labels, ids, rate, epochs, **other):
        calls.append((len(ids), epochs))
        return train_model(task, labels, ids, rate, epochs, **other)

    monkeypatch.setattr(network_training, "train_model", listed)
    return calls


def train(folder, settings, training=FROZEN):
    return network_training.process(training.name, folder, folder, MEMBERS, settings, seed=0)


def plain(rows):
    return {row["metric"]: row["value"] for row in rows if "perturbation" not in row and "layer" not in row}


def test_a_trial_gives_tidy_rows_and_after_a_kill_the_same_without_seeking_the_rate(
    folder, small, row_of, trained, monkeypatch
):
    settings = small.settings()

    def killed(*_, **__):
        raise KeyboardInterrupt

    rows = train(folder, settings)
    files = [folder / part / f"{FROZEN.name}.npz" for part in ("networks", "predictions")]
    first, values = [sha256(file) for file in files], plain(rows)
    assert values["chance"] == 0.5 and values["trained_parameters"] == 2562 and values["weight_change"] == 0
    assert values["learning_rate"] in settings.frozen_rates and 0 <= values["accuracy"] <= 1
    assert values["epochs"] == 4 and 0 <= values["train_accuracy"] <= 1
    assert [count for count, _ in trained] == [24]  # the printed training learns from all touches
    assert {path.name for path in folder.iterdir()} == {"imprints", "networks", "predictions"}
    rows = [row_of(row) for row in rows]
    assert not any("layer" in row or "trial" in row for row in rows)
    assert {row["split"] for row in rows} == {"random"} and {row["pretrained"] for row in rows} == {None}
    with monkeypatch.context() as patch, pytest.raises(KeyboardInterrupt):
        patch.setattr(network_training, "train_model", killed)
        train(folder, settings)
    monkeypatch.setattr(network_training, "search_rate", killed)
    assert plain(train(folder, settings)) == values and [sha256(file) for file in files] == first


def test_a_left_out_object_is_tested_and_a_range_changes_its_other_layers(folder, small):
    variant = FROZEN._replace(mode="18:139", split="objects")
    rows = train(folder, small.settings(epochs=1, search_epochs=1), variant)
    assert read_arrays(folder / "predictions" / f"{variant.name}.npz")["test"].tolist() == [*range(8), *range(16, 24)]
    changes = pd.DataFrame([row for row in rows if "layer" in row]).groupby("part")["value"].mean()
    assert changes["Conv1"] > 0 and changes["block_16"] > 0 and changes["block_2"] == changes["block_15"] == 0
    assert plain(rows)["weight_change"] == pytest.approx(np.mean([row["value"] for row in rows if "layer" in row]))


def test_a_training_to_convergence_has_its_curve_its_best_pass_and_the_accuracy_on_each_object(folder, small):
    settings = small.settings(most_epochs=60, patience=6, frozen_rates=[0.01], search_epochs=1)
    rows = pd.DataFrame(train(folder, settings, CONVERGED))
    values = rows.drop_duplicates("metric").set_index("metric")["value"]
    curve = rows.dropna(subset=["epoch"]).pivot(index="epoch", columns="metric", values="value")
    assert curve.index.tolist() == list(range(1, int(values["epochs"]) + 1)) and values["epochs"] < 60
    assert values["validation_accuracy"] == curve["curve_validation_accuracy"].max()
    assert values["train_accuracy"] > 0.7
    objects = rows[rows["metric"] == "object_accuracy"]
    assert objects["item"].tolist() == ["low", "steep", "narrow", "wide"]
    assert objects["group"].tolist() == ["ramp", "ramp", "stripes", "stripes"]
    assert objects["value"].mean() == pytest.approx(values["accuracy"])  # as many test touches of each


def test_a_training_to_convergence_leaves_touches_for_validation_and_may_diverge(folder, small, row_of, trained):
    rows = train(folder, small.settings(frozen_rates=[1e38]), CONVERGED)
    assert [count for count, _ in trained] == [16]  # a third of the training touches of each object validates
    assert len(rows) == 1 and rows[0]["value"] is None and "diverged: loss is not finite in pass" in rows[0]["note"]
    assert {path.name for path in folder.iterdir()} == {"imprints"}
    row = row_of(rows[0])
    assert row["passes"] == "converged" and summary([row], 0) == {}


@pytest.mark.parametrize(("passes", "rates"), [("printed_rate", [0.01, 0.1]), ("printed", [0.02])])
def test_a_rate_without_rivals_is_not_searched(folder, small, monkeypatch, passes, rates):
    monkeypatch.setattr(network_training, "search_rate", None)
    monkeypatch.setattr(network_training, "printed_rate", lambda *_: 0.02)
    rows = train(folder, small.settings(frozen_rates=rates), FROZEN._replace(passes=passes))
    values = {row["metric"]: row["value"] for row in rows}
    assert values["learning_rate"] == 0.02 and "validation_accuracy" not in values and values["epochs"] > 0


def test_an_object_s_accuracy_is_that_of_its_own_test_touches(folder):
    touches, test = read_touches(folder, CLASSES, "imprints32"), np.array([0, 1, 8, 9, 16, 17])
    scores = torch.tensor([[0.9, 0.1], [0.2, 0.8], [0.9, 0.1], [0.8, 0.2], [0.9, 0.1], [0.7, 0.3]])
    rows = network_training.object_rows(scores, touches, test, CLASSES)
    assert [(row["item"], row["value"]) for row in rows] == [("low", 0.5), ("steep", 1.0), ("narrow", 0.0)]


def test_a_control_with_the_statistics_it_begins_with_has_other_features(folder, small):
    touches = read_touches(folder, CLASSES, "imprints32")
    features = [
        network_training.prepare(variant, touches, np.arange(24), small.settings(), 0)[1].inputs(torch.arange(4))
        for variant in (FROZEN, FROZEN._replace(weights="random_initial"))
    ]
    assert features[0].std(dim=0).max() > 1e-3 > 1e-6 > features[1].std(dim=0).max() > 0


def test_summary_has_an_interval_over_repetitions_and_none_for_a_single_one():
    known = {"data": "imprints128", "method": "alexnet", "weights": "random", "mode": "frozen", "split": "objects"}
    rows = [known | {"metric": "chance", "value": 0.5}]
    rows += [known | {"metric": "accuracy", "value": value} for value in (0.6, 0.8)]
    whole, alone = (summary(part, 0) for part in (rows, rows[:2]))
    assert whole["chance"] == {"objects": 0.5}
    assert whole["imprints128"]["objects"]["alexnet"] == {
        "frozen_random": {"mean": 0.7, "low": -0.216817, "high": 1.616817}
    }
    assert alone["imprints128"]["objects"]["alexnet"] == {"frozen_random": {"mean": 0.6}} and summary([], 0) == {}


@pytest.fixture
def network():
    layers = [torch.nn.Conv2d(3, 8, 3), torch.nn.ReLU(), torch.nn.Conv2d(8, 8, 3, groups=8)]
    return Network(torch.nn.Sequential(*layers), 8, 2, dropout=0.0)


@torch.no_grad()
def test_the_change_is_the_mean_squared_difference_of_the_scaled_weights(network):
    other = copy.deepcopy(network)
    assert weight_changes(network, other) == {"convolutions.0": 0.0, "convolutions.2": 0.0}
    other.convolutions[0].weight.mul_(3).add_(0.5)
    for model, values in ((network, [0.0, 1.0, 2.0, 4.0]), (other, [0.0, 1.0, 1.0, 2.0])):
        model.convolutions[2].weight.copy_(torch.tensor(values * 18).view(8, 1, 3, 3))
    changes = weight_changes(network, other)
    assert changes["convolutions.0"] < 1e-12  # scale and shift are no change
    assert changes["convolutions.2"] == pytest.approx((0.25**2 + 0 + 0 + 0) / 4)
    network.convolutions[0].weight.fill_(0.1)
    assert weight_changes(network, network)["convolutions.0"] == 0.0


def test_convolutions_of_mobilenet_v2_belong_to_matlabs_blocks(network):
    parts = list(dict.fromkeys(network_parts(build("mobilenet_v2", 2, "random", 0)).values()))
    assert parts == ["Conv1", "expanded_conv", *(f"block_{i}" for i in range(1, 17)), "Conv_1"]
    assert list(network_parts(network).values()) == ["conv_1", "conv_2"]


SHAPES = {
    "ball": trimesh.creation.icosphere(2), "egg": trimesh.creation.icosphere(2).apply_scale([1, 1, 1.5]),
    "brick": trimesh.creation.box([1, 1, 0.5]).subdivide().subdivide(),
    "plank": trimesh.creation.box([1, 0.5, 0.2]).subdivide().subdivide(),
}  # fmt: skip
SOLIDS = {"round": ["ball", "egg"], "square": ["brick", "plank"]}


@pytest.fixture
def run(make_workspace, small):
    """run({class: objects}, key=value, ...): (workspace, rows) of the stage with those settings."""

    def start(classes=SOLIDS, **changes):
        workspace = make_workspace({"transfer": dataclasses.asdict(small.settings(**changes))})
        for name, shape in SHAPES.items():
            mesh = Mesh(np.array(shape.vertices) / 3, np.array(shape.faces))
            write_mesh(workspace.data / f"meshes/{name}.npz", mesh)
            write_arrays(workspace.data / f"salient_points/{name}.npz", **{"thesis_ssim.points": np.arange(4)})
        rows = [f"{label},{name}" for label, names in classes.items() for name in names]
        write_text(workspace.data / "meshes/classes.csv", "\n".join(["class,object", *rows]))
        stage.run(workspace)
        return workspace, read_rows(workspace.measurements / "transfer.csv.gz")

    return start


def test_a_run_writes_what_the_report_reads_and_one_training_more_repeats_no_other(run, trained):
    short = {"epochs": 2, "search_epochs": 1, "frozen_rates": [0.01]}
    workspace, table = run(**short)
    accuracy = table[table["metric"] == "accuracy"]
    assert sorted(accuracy["split"]) == ["objects", "random"] and (accuracy["seconds"] > 0).all()
    assert {"data", "weights", "pretrained", "mode", "repetition"} <= set(table)
    of_sets = table[table["metric"] != "object_accuracy"]
    assert of_sets[["item", "group", "note"]].isna().all(axis=None) and (table["dataset"] == "toys").all()
    folder = workspace.data / "transfer"
    made = {path.relative_to(folder).parts[0] for path in folder.rglob("*") if path.is_file()}
    assert made == {"imprints", "networks", "predictions"}
    assert set(json.loads((workspace.metrics / "transfer.json").read_text())) == {"chance", "imprints32"}

    trained.clear()
    file = folder / f"networks/{FROZEN.name}.npz"
    before = sha256(file)
    _, more = run(**short, splits={"random": 2, "objects": 1})
    assert [epochs for _, epochs in trained] == [2] and sha256(file) == before
    assert more[more["repetition"] == 0]["value"].tolist() == table["value"].tolist()


def test_one_class_alone_is_a_row_that_says_so(run, capsys):
    _, table = run({"round": ["ball", "egg"]})
    assert len(table) == 1 and np.isnan(table["value"][0])
    assert "two classes or more are needed, got round" in table["note"][0]
    assert "two classes or more are needed" in capsys.readouterr().err
