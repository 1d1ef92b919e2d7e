"""What learns in each mode, and that it learns."""

import numpy as np
import pytest
import torch

from stages.kit.files import sha256, write_arrays
from stages.kit.repeatable import repeatable
from stages.networks.images import normalise, to_images
from stages.networks.modes import MODES
from stages.networks.network import Network, build, parameters, settle
from stages.networks.training import accuracy, learn, scores, search
from stages.transfer import trial
from stages.transfer.__main__ import none_to_tell_apart, present
from stages.transfer.schema import Params

SIZE = 32
LABELS = np.arange(32) % 2


@pytest.fixture(scope="module")
def imprints():
    """Two classes that anybody can tell apart, whatever the reflection: stripes and a faint ramp."""
    generator = np.random.default_rng(0)
    ramp = np.tile(np.linspace(0, 0.5, SIZE), (SIZE, 1))
    stripes = np.tile((np.arange(SIZE) // 4 % 2).astype(float), (SIZE, 1))
    plain = np.where(LABELS[:, None, None] == 1, stripes, ramp)
    return np.clip(plain + generator.normal(0, 0.05, plain.shape), 0, 1).astype(np.float32)


def as_inputs(imprints):
    images = to_images(imprints, SIZE)
    return lambda ids: normalise(images[ids])


def untrained(imprints, mode, classes=2):
    """A network from random weights with statistics of the imprints, and its task."""
    network = build("mobilenet_v2", classes, "random", 0)
    settle(network, as_inputs(imprints), np.arange(24))
    return network, MODES[mode](network, imprints, SIZE, 1)


def trained(imprints, mode, epochs, rate=0.01):
    with repeatable(0):
        network, task = untrained(imprints, mode)
        before = {key: value.clone() for key, value in network.state_dict().items()}
        model = learn(task, LABELS, np.arange(24), rate, epochs, batch=8, momentum=0.9)
        return network, task, before, model


def test_frozen_mode_changes_no_convolution_and_no_statistic(imprints):
    network, task, before, model = trained(imprints, "frozen", 3)
    assert all(torch.equal(value, before[key]) for key, value in network.state_dict().items())
    assert not torch.equal(model[1].weight, before["head.1.weight"])
    assert parameters(model, trained=True) == 1280 * 2 + 2


def test_finetuned_mode_changes_every_convolution(imprints):
    network, task, before, model = trained(imprints, "finetuned", 1)
    layers = {key: value for key, value in model.state_dict().items() if value.ndim == 4}
    assert len(layers) == 52
    assert all(not torch.equal(value, before[key]) for key, value in layers.items())
    assert parameters(model, trained=True) == parameters(network)


def test_training_leaves_the_tasks_own_model_alone(imprints):
    network, task, before, model = trained(imprints, "finetuned", 1)
    weights = [key for key, value in before.items() if value.ndim == 4]
    assert all(torch.equal(network.state_dict()[key], before[key]) for key in weights)


def small():
    """A network so small that it learns the toy problem in a second."""
    layers = [torch.nn.Conv2d(3, 8, 5, stride=2), torch.nn.BatchNorm2d(8), torch.nn.ReLU()]
    layers += [torch.nn.Conv2d(8, 16, 3, stride=2), torch.nn.BatchNorm2d(16), torch.nn.ReLU()]
    return Network(torch.nn.Sequential(*layers), 16, 2, dropout=0.0)


@pytest.mark.parametrize("mode", list(MODES))
def test_two_visibly_different_classes_are_learned(imprints, mode):
    with repeatable(0):
        network = small()
        settle(network, as_inputs(imprints), np.arange(24))
        task = MODES[mode](network, imprints, SIZE, 1)
        model = learn(task, LABELS, np.arange(24), 0.03, epochs=12, batch=8, momentum=0.9)
    unseen = np.arange(24, 32)
    assert accuracy(scores(model, task, unseen), LABELS[unseen]) >= 0.8


def test_same_seed_same_weights_whatever_the_threads(imprints):
    first = trained(imprints, "finetuned", 1)[3].state_dict()
    threads = torch.get_num_threads()
    torch.set_num_threads(3 - min(threads, 2))
    torch.rand(7)
    again = trained(imprints, "finetuned", 1)[3].state_dict()
    torch.set_num_threads(threads)
    assert all(torch.equal(first[key], again[key]) for key in first)


def test_repeatable_puts_everything_back():
    torch.manual_seed(5)
    expected, threads = torch.rand(1), torch.get_num_threads()
    torch.manual_seed(5)
    with repeatable(0):
        torch.rand(3)
        assert torch.get_num_threads() == 1
    assert torch.equal(torch.rand(1), expected)
    assert torch.get_num_threads() == threads
    assert not torch.are_deterministic_algorithms_enabled()


def test_augmented_inputs_differ_and_plain_ones_do_not(imprints):
    ids = torch.arange(8)
    for mode in MODES:
        with repeatable(0):
            _, task = untrained(imprints, mode)
            assert torch.equal(task.inputs(ids), task.inputs(ids))
            drawn = [task.training_inputs(ids) for _ in range(4)]
            assert any(not torch.equal(drawn[0], other) for other in drawn[1:])


def test_settled_statistics_give_an_untrained_network_features_that_differ(imprints):
    inputs, ids = as_inputs(imprints), np.arange(32)
    network = build("mobilenet_v2", 2, "random", 0)
    with torch.no_grad():
        assert network.features(inputs(ids)).std(dim=0).max() < 1e-6
        settle(network, inputs, ids)
        assert network.features(inputs(ids)).std(dim=0).mean() > 1e-2


def test_settling_changes_no_weight_and_takes_any_number_of_images(imprints):
    network = build("mobilenet_v2", 2, "random", 0)
    before = [value.clone() for value in network.parameters()]
    settle(network, as_inputs(imprints), np.arange(9), batch=8)
    assert all(torch.equal(a, b) for a, b in zip(before, network.parameters(), strict=True))
    assert {layer.momentum for layer in network.modules() if isinstance(layer, torch.nn.BatchNorm2d)} == {0.1}


def test_search_takes_the_rate_that_learns(imprints):
    with repeatable(0):
        task = MODES["finetuned"](small(), imprints, SIZE, 0)
        rates = [1e-9, 0.03]
        part, validation = np.arange(20), np.arange(20, 32)
        rate, found = search(task, LABELS, part, validation, rates, epochs=10, batch=8, momentum=0.9)
    assert rate == 0.03
    assert found >= 0.8


def test_scores_that_are_not_finite_count_as_wrong():
    found = torch.tensor([[0.9, 0.1], [float("nan"), float("nan")]])
    assert accuracy(found, [0, 0]) == 0.5


@pytest.mark.parametrize("change", [{"name": "lenet"}, {"weights": "mars"}, {"classes": 1}])
def test_unknown_networks_are_refused(change):
    with pytest.raises(ValueError):
        build(**({"name": "mobilenet_v2", "weights": "random", "classes": 2, "seed": 0} | change))


@pytest.fixture
def settings():
    return Params(
        class_set="two", classes=["a", "b"], touches=16, detector="enhanced", cells=SIZE, pitch=0.01,
        network="mobilenet_v2", weights=["random"], source="package", modes=["frozen"], frozen_size=SIZE,
        finetuned_size=SIZE, copies=1, train_share=0.75, validation_share=0.25, frozen_rates=[0.003, 0.01],
        finetuned_rates=[0.01], search_epochs=2, epochs=4, batch=8, momentum=0.9, repetitions=1,
    )  # fmt: skip


def run_trial(folder, imprints, settings):
    for label, name in enumerate(settings.classes):
        images = np.round(imprints[label == LABELS] * 255).astype(np.uint8)
        write_arrays(folder / "imprints" / f"{name}.npz", images=images, vertices=np.arange(len(images)))
    return trial.process("random-frozen-0", folder, settings, settings.classes, seed=0)


def test_a_trial_gives_equal_files_each_time_and_tidy_rows(tmp_path, imprints, settings):
    rows = run_trial(tmp_path / "one", imprints, settings)
    run_trial(tmp_path / "two", imprints, settings)
    for part in ("networks", "predictions"):
        file = f"{part}/random-frozen-0.npz"
        assert sha256(tmp_path / "one" / file) == sha256(tmp_path / "two" / file)
    values = {row["metric"]: row["value"] for row in rows}
    assert values["chance"] == 0.5
    assert values["trained_parameters"] == 2562
    assert values["learning_rate"] in settings.frozen_rates
    table = trial.confusion(tmp_path / "one", ["random-frozen-0"], settings.classes)
    assert table["count"].sum() == 8
    assert table.query("true == predicted")["count"].sum() == round(values["accuracy"] * 8)


def test_summary_has_an_interval_over_repetitions_and_none_for_a_single_one():
    known = {"weights": "random", "mode": "frozen"}
    rows = [known | {"metric": "chance", "value": 0.5}]
    rows += [known | {"metric": "accuracy", "value": value} for value in (0.6, 0.8)]
    assert trial.summary(rows, 0)["frozen_random"]["accuracy"] == {"value": 0.7, "low": 0.6, "high": 0.8}
    assert trial.summary(rows[:2], 0) == {"chance": 0.5, "frozen_random": {"accuracy": {"value": 0.6}}}


def test_classes_that_cannot_serve_are_named_and_less_than_two_give_a_row_that_says_so(capsys, settings):
    assert present(["cup", "cow", "hand", "cube", "cup"], {"cup": 50, "hand": 20, "cube": 8}, 20) == ["cup", "hand"]
    said = capsys.readouterr().err
    assert "no mesh of cow" in said and "cube has 8 vertices, fewer than 20" in said
    row = none_to_tell_apart(settings, ["teapot", "train"])
    assert row["value"] is None and "transfer.classes to some of teapot, train" in row["note"]


def test_trials_name_what_is_not_known(settings):
    assert trial.trials(settings) == ["random-frozen-0"]
    settings.modes = ["frozen", "boiled"]
    with pytest.raises(ValueError, match="transfer.modes: boiled not known"):
        trial.trials(settings)
