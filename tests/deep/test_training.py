"""What learns in each mode, and that it learns."""

from dataclasses import replace

import numpy as np
import pytest
import torch

from haptic_glance.deep.device import choose_device
from haptic_glance.deep.images import normalise, to_images
from haptic_glance.deep.modes import MODES, frozen_modules, mode_named
from haptic_glance.deep.network import Network, build, count_parameters, recalibrate
from haptic_glance.deep.repeatable import repeatable
from haptic_glance.deep.training import accuracy, predict_probabilities, search_rate, train_model

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
    recalibrate(network, as_inputs(imprints), np.arange(24))
    return network, MODES[mode](network, imprints, SIZE, 1)


def trained(imprints, mode, epochs, rate=0.01):
    with repeatable(0):
        network, task = untrained(imprints, mode)
        before = {key: value.clone() for key, value in network.state_dict().items()}
        model = train_model(task, LABELS, np.arange(24), rate, epochs, batch=8, momentum=0.9)
        return network, task, before, model


def test_frozen_mode_changes_no_convolution_and_no_statistic(imprints):
    network, task, before, model = trained(imprints, "frozen", 3)
    assert all(torch.equal(value, before[key]) for key, value in network.state_dict().items())
    assert not torch.equal(model.head[1].weight, before["head.1.weight"])
    assert count_parameters(model, trained=True) == 1280 * 2 + 2


@pytest.mark.slow
def test_finetuned_mode_changes_every_convolution(imprints):
    network, task, before, model = trained(imprints, "finetuned", 1)
    layers = {key: value for key, value in model.state_dict().items() if value.ndim == 4}
    assert len(layers) == 52
    assert all(not torch.equal(value, before[key]) for key, value in layers.items())
    assert count_parameters(model, trained=True) == count_parameters(network)


@pytest.mark.slow
def test_training_leaves_the_tasks_own_model_alone(imprints):
    network, task, before, model = trained(imprints, "finetuned", 1)
    weights = [key for key, value in before.items() if value.ndim == 4]
    assert all(torch.equal(network.state_dict()[key], before[key]) for key in weights)


def small():
    """A network so small that it learns the toy problem in a second."""
    layers = [torch.nn.Conv2d(3, 8, 5, stride=2), torch.nn.BatchNorm2d(8), torch.nn.ReLU()]
    layers += [torch.nn.Conv2d(8, 16, 3, stride=2), torch.nn.BatchNorm2d(16), torch.nn.ReLU()]
    return Network(torch.nn.Sequential(*layers), 16, 2, dropout=0.0)


@pytest.mark.slow
@pytest.mark.parametrize("mode", list(MODES))
def test_two_visibly_different_classes_are_learned(imprints, mode):
    with repeatable(0):
        network = small()
        recalibrate(network, as_inputs(imprints), np.arange(24))
        task = MODES[mode](network, imprints, SIZE, 1)
        model = train_model(task, LABELS, np.arange(24), 0.03, epochs=12, batch=8, momentum=0.9)
    unseen = np.arange(24, 32)
    assert accuracy(predict_probabilities(model, task.inputs, unseen), LABELS[unseen]) >= 0.8


@pytest.mark.slow
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


@pytest.mark.slow
def test_settled_statistics_give_an_untrained_network_features_that_differ(imprints):
    inputs, ids = as_inputs(imprints), np.arange(32)
    network = build("mobilenet_v2", 2, "random", 0)
    with torch.no_grad():
        assert network.features(inputs(ids)).std(dim=0).max() < 1e-6
        recalibrate(network, inputs, ids)
        assert network.features(inputs(ids)).std(dim=0).mean() > 1e-2


@pytest.mark.slow
def test_settling_changes_no_weight_and_takes_any_number_of_images(imprints):
    network = build("mobilenet_v2", 2, "random", 0)
    before = [value.clone() for value in network.parameters()]
    recalibrate(network, as_inputs(imprints), np.arange(9), batch=8)
    assert all(torch.equal(a, b) for a, b in zip(before, network.parameters(), strict=True))
    assert {layer.momentum for layer in network.modules() if isinstance(layer, torch.nn.BatchNorm2d)} == {0.1}


def test_search_takes_the_rate_that_learns(imprints):
    with repeatable(0):
        task = MODES["finetuned"](small(), imprints, SIZE, 0)
        rates = [1e-9, 0.03]
        part, validation = np.arange(20), np.arange(20, 32)
        rate, found = search_rate(task, LABELS, part, validation, rates, epochs=10, batch=8, momentum=0.9)
    assert rate == 0.03
    assert found >= 0.8


def test_scores_that_are_not_finite_count_as_wrong():
    found = torch.tensor([[0.9, 0.1], [float("nan"), float("nan")]])
    assert accuracy(found, [0, 0]) == 0.5


@pytest.mark.parametrize("change", [{"name": "lenet"}, {"weights": "mars"}, {"classes": 1}])
def test_unknown_networks_are_refused(change):
    with pytest.raises(ValueError):
        build(**({"name": "mobilenet_v2", "weights": "random", "classes": 2, "seed": 0} | change))


@pytest.mark.slow
@pytest.mark.parametrize("layer_range", ["18:139", "1:134"])
def test_a_range_of_layers_keeps_its_weights_and_statistics_and_all_others_learn(imprints, layer_range):
    with repeatable(0):
        network = build("mobilenet_v2", 2, "random", 0)
        recalibrate(network, as_inputs(imprints), np.arange(24))
        task = mode_named(layer_range)(network, imprints, SIZE, 0)
        model = train_model(task, LABELS, np.arange(24), 0.01, 1, batch=8, momentum=0.9)
    before, after = network.state_dict(), model.state_dict()
    same = {key for key in before if torch.equal(before[key], after[key])}
    kept = {key for key in before if key.rpartition(".")[0] in frozen_modules(layer_range, network)}
    assert same - {key for key in before if key.endswith("num_batches_tracked")} == {
        key for key in kept if not key.endswith("num_batches_tracked")
    }
    assert count_parameters(model, trained=True) == count_parameters(network) - sum(
        before[key].numel() for key in kept if key.endswith(("weight", "bias"))
    )


def test_an_unknown_mode_names_the_known_ones():
    with pytest.raises(ValueError, match="frozen, finetuned, and ranges of layers such as 18:139"):
        mode_named("boiled")


@pytest.mark.slow
def test_too_little_memory_names_the_setting(imprints):
    network, task = untrained(imprints, "finetuned")

    def too_much(ids):
        raise torch.OutOfMemoryError("CUDA out of memory")

    with pytest.raises(ValueError, match="smaller batch"):
        train_model(replace(task, training_inputs=too_much), LABELS, np.arange(24), 0.01, 1, batch=8, momentum=0.9)
    with pytest.raises(ValueError, match="smaller batch"):
        predict_probabilities(network, too_much, np.arange(8))


def test_a_device_that_is_not_there_is_named(monkeypatch):
    monkeypatch.setattr(torch.cuda, "is_available", lambda: False)
    assert choose_device("auto").type == choose_device("cpu").type == "cpu"
    with pytest.raises(ValueError, match="take auto or cpu"):
        choose_device("cuda")
    with pytest.raises(ValueError, match="unknown device 'abacus'"):
        choose_device("abacus")
