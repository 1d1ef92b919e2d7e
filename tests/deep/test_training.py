"""What learns in each mode, and that it learns."""

import numpy as np
import pytest
import torch

from haptic_glance.deep.device import repeatable
from haptic_glance.deep.images import normalise, to_images
from haptic_glance.deep.modes import MODES, finetuned_except, frozen_modules, mode_named
from haptic_glance.deep.network import Network, build, count_parameters, recalibrate
from haptic_glance.deep.training import accuracy, predict_probabilities, search_rate, train_model

pytestmark = pytest.mark.slow

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


def settled(network, imprints):
    """The network with statistics of the imprints."""
    images = to_images(imprints, SIZE)
    recalibrate(network, lambda ids: normalise(images[ids]), np.arange(24))
    return network


def train(imprints, mode, epochs=1):
    """(network, its state before, the trained copy) of an untrained MobileNetV2."""
    with repeatable(0):
        network = settled(build("mobilenet_v2", 2, "random", 0), imprints)
        before = {key: value.clone() for key, value in network.state_dict().items()}
        task = mode_named(mode)(network, imprints, SIZE, 1)
        return network, before, train_model(task, LABELS, np.arange(24), 0.01, epochs, batch=8, momentum=0.9)


@pytest.fixture(scope="module")
def finetuned(imprints):
    return train(imprints, "finetuned")


def test_frozen_mode_changes_no_convolution_and_no_statistic(imprints):
    network, before, model = train(imprints, "frozen", 3)
    assert all(torch.equal(value, before[key]) for key, value in network.state_dict().items())
    assert not torch.equal(model.head[1].weight, before["head.1.weight"])
    assert count_parameters(model, trained=True) == 1280 * 2 + 2


def test_finetuned_mode_changes_every_convolution_and_not_the_tasks_own_model(finetuned):
    network, before, model = finetuned
    layers = {key: value for key, value in model.state_dict().items() if value.ndim == 4}
    assert len(layers) == 52
    assert all(not torch.equal(value, before[key]) for key, value in layers.items())
    assert all(torch.equal(network.state_dict()[key], before[key]) for key in layers)
    assert count_parameters(model, trained=True) == count_parameters(network)


def test_a_range_of_layers_keeps_its_weights_and_statistics_and_all_others_learn(imprints):
    network, before, model = train(imprints, "18:139")
    after, frozen = model.state_dict(), frozen_modules("18:139", network)
    values = [key for key in before if not key.endswith("num_batches_tracked")]
    kept = {key for key in values if key.rpartition(".")[0] in frozen}
    assert {key for key in values if torch.equal(before[key], after[key])} == kept
    untrained = sum(before[key].numel() for key in kept if key.endswith(("weight", "bias")))
    assert count_parameters(model, trained=True) == count_parameters(network) - untrained


def test_same_seed_same_weights_whatever_the_threads(imprints, finetuned):
    threads = torch.get_num_threads()
    torch.set_num_threads(3 - min(threads, 2))
    torch.rand(7)
    again = train(imprints, "finetuned")[2].state_dict()
    torch.set_num_threads(threads)
    assert all(torch.equal(value, again[key]) for key, value in finetuned[2].state_dict().items())


def small():
    """A network so small that it learns the toy problem in a second."""
    layers = [torch.nn.Conv2d(3, 8, 5, stride=2), torch.nn.BatchNorm2d(8), torch.nn.ReLU()]
    layers += [torch.nn.Conv2d(8, 16, 3, stride=2), torch.nn.BatchNorm2d(16), torch.nn.ReLU()]
    return Network(torch.nn.Sequential(*layers), 16, 2, dropout=0.0)


@pytest.mark.parametrize("mode", list(MODES))
def test_two_visibly_different_classes_are_learned_from_augmented_inputs(imprints, mode):
    with repeatable(0):
        task = MODES[mode](settled(small(), imprints), imprints, SIZE, 1)
        model = train_model(task, LABELS, np.arange(24), 0.03, epochs=12, batch=8, momentum=0.9)
        ids = torch.arange(8)
        assert torch.equal(task.inputs(ids), task.inputs(ids))
        augmented = [task.training_inputs(ids) for _ in range(4)]
        assert any(not torch.equal(augmented[0], other) for other in augmented[1:])
    unseen = np.arange(24, 32)
    assert accuracy(predict_probabilities(model, task.inputs, unseen), LABELS[unseen]) >= 0.8


def test_the_layers_inside_a_fixed_module_keep_their_statistics(imprints):
    network = small()
    network.convolutions = torch.nn.Sequential(network.convolutions[:3], network.convolutions[3:])
    before = {key: value.clone() for key, value in network.state_dict().items()}
    task = finetuned_except(network, to_images(imprints, SIZE), torch.nn.Identity(), ("convolutions.0",))
    after = train_model(task, LABELS, np.arange(24), 0.01, 1, batch=8, momentum=0.9).state_dict()
    statistics = [key for key in before if "running" in key]
    unchanged = [key for key in statistics if torch.equal(before[key], after[key])]
    assert unchanged == [key for key in statistics if key.startswith("convolutions.0.")]


def test_a_model_in_training_mode_predicts_as_in_evaluation_mode(imprints):
    images = normalise(to_images(imprints, SIZE))
    network = small().train()
    first = predict_probabilities(network, lambda ids: images[ids], np.arange(8))
    assert torch.equal(first, network.eval()(images[:8]).softmax(dim=1).detach())


@pytest.mark.parametrize(("ids", "batch"), [(np.arange(0), 8), (np.arange(24), 0)])
def test_a_training_without_touches_or_a_batch_is_refused(imprints, ids, batch):
    task = MODES["finetuned"](small(), imprints, SIZE, 1)
    with pytest.raises(ValueError, match=f"got {len(ids)} touches, batch {batch}"):
        train_model(task, LABELS, ids, 0.01, 1, batch=batch, momentum=0.9)
    with pytest.raises(ValueError, match="no learning rate to try"):
        search_rate(task, LABELS, ids, np.arange(8), [], epochs=1, batch=batch, momentum=0.9)


def test_search_takes_the_rate_that_learns(imprints):
    with repeatable(0):
        task, (part, validation) = MODES["finetuned"](small(), imprints, SIZE, 0), np.split(np.arange(32), [20])
        rate, reached = search_rate(task, LABELS, part, validation, [1e-9, 0.03], epochs=10, batch=8, momentum=0.9)
    assert rate == 0.03 and reached >= 0.8


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


def test_scores_that_are_not_finite_count_as_wrong():
    assert accuracy(torch.tensor([[0.9, 0.1], [float("nan"), float("nan")]]), [0, 0]) == 0.5
