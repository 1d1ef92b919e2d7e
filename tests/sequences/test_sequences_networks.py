"""The two networks: layers as in the thesis's tables, training that is repeatable and learns."""

import numpy as np
import pytest
import torch

from stages.sequences.networks import (
    ImageInputs,
    ImageNet,
    NormalInputs,
    NormalNet,
    class_probabilities,
    layers,
    train_network,
)


def films(count=60, frames=8, cells=8, classes=3, seed=0):
    """(images, normals, labels): each class has its own bright frame and its own direction, under noise."""
    random = np.random.default_rng(seed)
    labels = np.arange(count) % classes
    images = random.integers(0, 60, (count, frames, cells, cells), dtype=np.uint8)
    images[np.arange(count), 2 * labels + 1] += 150
    normals = random.normal(scale=0.3, size=(count, frames, 3)) + np.eye(3)[labels][:, None]
    return images, normals.astype(np.float32), labels


def outputs(network, *inputs):
    """dict layer -> shape of its output for one sample."""
    return {row["layer"]: row["output"] for row in layers(network, *inputs)}


def test_3d_network_has_the_shapes_of_table_4_7():
    found = outputs(ImageNet(25, (32, 32), 8), torch.zeros(1, 25, 32, 32))
    assert found["conv1"] == "8x5x16x16"  # 25 frames in steps of 5; 32 cells in steps of 2
    assert found["conv2"] == "16x3x14x14"
    assert found["scores"] == "8"


def test_1d_network_has_the_shapes_of_table_4_8():
    found = outputs(NormalNet(25, 8), torch.zeros(1, 25, 3))
    assert (found["conv1"], found["conv2"], found["scores"]) == ("32x21", "32x19", "8")
    assert NormalNet(25, 8).fc1.in_features == 32 * 9  # pooled by two


def test_settings_are_those_of_the_tables():
    network = ImageNet(25, (32, 32), 8)
    assert (network.conv1.kernel_size, network.conv1.padding, network.conv1.stride) == ((5, 5, 5), (2, 2, 2), (5, 2, 2))
    assert (network.conv2.kernel_size, network.conv2.padding) == ((3, 5, 5), (0, 1, 1))
    assert network.drop.p == pytest.approx(0.2)  # 0.8 are kept
    assert NormalNet(25, 8).drop_convolved.p == pytest.approx(0.5)
    assert (ImageInputs.batch, NormalInputs.batch) == (10, 16)


def test_table_of_layers_counts_all_parameters():
    network = ImageNet(25, (32, 32), 8)
    counts = [row["value"] for row in layers(network, torch.zeros(1, 25, 32, 32))]
    assert sum(counts) == sum(p.numel() for p in network.parameters())


@pytest.mark.parametrize(("frames", "cells"), [(13, 32), (25, 16), (25, 8), (13, 8), (8, 5), (1, 5)])
def test_3d_network_takes_shorter_films_and_smaller_imprints(frames, cells):
    assert ImageNet(frames, (cells, cells), 4)(torch.zeros(2, frames, cells, cells)).shape == (2, 4)


def test_too_small_is_named():
    with pytest.raises(ValueError, match="5 x 5"):
        ImageNet(25, (4, 4), 8)
    with pytest.raises(ValueError, match="8 frames"):
        NormalNet(7, 8)
    assert NormalNet(8, 3)(torch.zeros(2, 8, 3)).shape == (2, 3)


@pytest.mark.parametrize("kind", [ImageInputs, NormalInputs])
def test_training_learns_classes_that_differ(kind):
    images, normals, labels = films()
    train, test = np.arange(40), np.arange(40, 60)
    inputs = kind(images if kind is ImageInputs else normals, train)
    chances = class_probabilities(train_network(inputs, labels, train, 3, 30, seed=0), inputs, test)
    np.testing.assert_allclose(chances.sum(axis=1), 1, rtol=1e-5)
    assert (chances.argmax(axis=1) == labels[test]).mean() > 0.9


def test_training_is_repeatable_and_leaves_the_caller_s_chance_alone():
    images, _, labels = films()
    inputs = ImageInputs(images, np.arange(40))
    torch.manual_seed(5)
    before = torch.rand(1)
    torch.manual_seed(5)
    first = train_network(inputs, labels, np.arange(40), 3, 2, seed=1)
    assert torch.rand(1) == before
    torch.manual_seed(99)
    again = train_network(inputs, labels, np.arange(40), 3, 2, seed=1)
    for one, other in zip(first.parameters(), again.parameters(), strict=True):
        assert torch.equal(one, other)
    assert not torch.equal(first.fc1.weight, train_network(inputs, labels, np.arange(40), 3, 2, seed=2).fc1.weight)


def test_nothing_of_the_test_part_leaks_into_training():
    images, normals, labels = films()
    train, changed, bent = np.arange(40), images.copy(), normals.copy()
    changed[40:], bent[40:] = 255, 100.0
    for kind, usual, other in ((ImageInputs, images, changed), (NormalInputs, normals, bent)):
        one, two = (train_network(kind(values, train), labels, train, 3, 1, seed=0) for values in (usual, other))
        assert torch.equal(one.fc1.weight, two.fc1.weight)


def test_inputs_are_standardised_by_the_training_part():
    images, normals, _ = films()
    train = np.arange(30)
    standard = ImageInputs(images, train)(train)
    assert float(standard.mean()) == pytest.approx(0, abs=1e-4) and float(standard.std()) == pytest.approx(1, abs=1e-3)
    moved = NormalInputs(normals, train)(train)
    np.testing.assert_allclose(moved.mean(dim=(0, 1)), 0, atol=1e-5)
    np.testing.assert_allclose(moved.std(dim=(0, 1)), 1, rtol=1e-2)


def test_constant_inputs_are_finite():
    train = np.arange(4)
    assert torch.isfinite(ImageInputs(np.full((4, 8, 8, 8), 7, dtype=np.uint8), train)(train)).all()
    assert torch.isfinite(NormalInputs(np.ones((4, 8, 3), dtype=np.float32), train)(train)).all()


def test_network_that_ran_away_says_nothing():
    _, normals, labels = films()
    inputs = NormalInputs(normals, np.arange(40))
    network = inputs.network(3).eval()
    with torch.no_grad():
        network.scores.bias[0] = float("nan")
    np.testing.assert_allclose(class_probabilities(network, inputs, np.arange(5)), 1 / 3)
