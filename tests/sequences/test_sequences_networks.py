"""Series along a contour and their features; the two networks: layers as in the thesis's tables, and training."""

import numpy as np
import pytest
import pywt
import torch
from scipy import stats

from stages.sequences.contourlet import directional_std
from stages.sequences.networks import (
    HALVINGS,
    ImageInputs,
    ImageNet,
    NormalInputs,
    NormalNet,
    class_probabilities,
    layers,
    train_network,
)
from stages.sequences.sequence_trials import CHANNELS, FEATURES, sequence_features, series

pytestmark = pytest.mark.slow

KINDS = [(ImageInputs, "images"), (NormalInputs, "normals")]
TRAIN, TEST = np.arange(40), np.arange(40, 60)


@pytest.fixture
def films():
    """{images, normals, labels}: each class has its own bright frame and its own direction, under noise."""
    random = np.random.default_rng(0)
    labels = np.arange(60) % 3
    images = random.integers(0, 60, (60, 8, 8, 8), dtype=np.uint8)
    images[np.arange(60), 2 * labels + 1] += 150
    normals = random.normal(scale=0.3, size=(60, 8, 3)) + np.eye(3)[labels][:, None]
    return {"images": images, "normals": normals.astype(np.float32), "labels": labels}


def test_networks_have_the_shapes_of_tables_4_7_and_4_8_and_all_parameters_are_counted():
    network = ImageNet(25, (32, 32), 8)
    rows = layers(network, torch.zeros(1, 25, 32, 32))
    outputs = {row["layer"]: row["output"] for row in rows}
    assert outputs["conv1"] == "8x5x16x16"  # 25 frames in steps of 5; 32 cells in steps of 2
    assert (outputs["conv2"], outputs["scores"]) == ("16x3x14x14", "8")
    assert sum(row["value"] for row in rows) == sum(p.numel() for p in network.parameters())
    outputs = {row["layer"]: row["output"] for row in layers(NormalNet(25, 8), torch.zeros(1, 25, 3))}
    assert (outputs["conv1"], outputs["conv2"], outputs["scores"]) == ("32x21", "32x19", "8")
    assert NormalNet(25, 8).fc1.in_features == 32 * 9  # pooled by two
    assert (ImageInputs.batch, NormalInputs.batch) == (10, 16)


@pytest.mark.parametrize(("frames", "cells"), [(13, 32), (25, 8), (8, 5), (1, 5)])
def test_networks_take_shorter_films_and_smaller_imprints_and_name_what_is_too_small(frames, cells):
    assert ImageNet(frames, (cells, cells), 4)(torch.zeros(2, frames, cells, cells)).shape == (2, 4)
    assert NormalNet(8, 3)(torch.zeros(2, 8, 3)).shape == (2, 3)
    with pytest.raises(ValueError, match="5 x 5"):
        ImageNet(25, (4, 4), 8)
    with pytest.raises(ValueError, match="8 frames"):
        NormalNet(7, 8)


@pytest.mark.parametrize(("kind", "name"), KINDS)
def test_training_learns_classes_that_differ(films, kind, name):
    inputs, labels = kind(films[name], TRAIN), films["labels"]
    chances = class_probabilities(train_network(inputs, labels, TRAIN, 3, 30, seed=0).network, inputs, TEST)
    np.testing.assert_allclose(chances.sum(axis=1), 1, rtol=1e-5)
    assert (chances.argmax(axis=1) == labels[TEST]).mean() > 0.9


@pytest.mark.parametrize(("kind", "name"), KINDS)
def test_training_is_repeatable_from_the_training_part_alone_and_leaves_the_caller_s_chance(films, kind, name):
    changed = films[name].copy()
    changed[40:] = 100
    torch.manual_seed(5)
    before = torch.rand(1)
    torch.manual_seed(5)
    first, again, other = (
        train_network(kind(values, TRAIN), films["labels"], TRAIN, 3, 1, seed=seed).network
        for values, seed in ((films[name], 1), (changed, 1), (films[name], 2))
    )
    assert torch.rand(1) == before
    assert all(torch.equal(a, b) for a, b in zip(first.parameters(), again.parameters(), strict=True))
    assert not torch.equal(first.fc1.weight, other.fc1.weight)


def test_training_ends_when_its_loss_falls_no_more_and_says_so(films, monkeypatch):
    inputs, few, last = NormalInputs(films["normals"], TRAIN), films["labels"], 400
    free = train_network(inputs, few, TRAIN, 3, last, seed=0)
    assert free.settled and 3 * HALVINGS <= free.passes < last
    cut = train_network(inputs, few, TRAIN, 3, free.passes - 1, seed=0)
    assert not cut.settled and cut.passes == free.passes - 1
    monkeypatch.setattr("stages.sequences.networks.HALVINGS", HALVINGS + 8)
    longer = train_network(inputs, few, TRAIN, 3, last, seed=0)
    shares = [class_probabilities(training.network, inputs, TEST) for training in (free, longer)]
    np.testing.assert_allclose(*shares, atol=0.02)  # a longer training would not have moved it
    assert longer.passes >= free.passes + 3 * 8


def test_inputs_are_standardised_by_the_training_part_and_constant_ones_are_finite(films):
    standard = ImageInputs(films["images"], TRAIN)(TRAIN)
    assert float(standard.mean()) == pytest.approx(0, abs=1e-4) and float(standard.std()) == pytest.approx(1, abs=1e-3)
    moved = NormalInputs(films["normals"], TRAIN)(TRAIN)
    np.testing.assert_allclose(moved.mean(dim=(0, 1)), 0, atol=1e-5)
    np.testing.assert_allclose(moved.std(dim=(0, 1)), 1, rtol=1e-2)
    few = np.arange(4)
    assert torch.isfinite(ImageInputs(np.full((4, 8, 8, 8), 7, dtype=np.uint8), few)(few)).all()
    assert torch.isfinite(NormalInputs(np.ones((4, 8, 3), dtype=np.float32), few)(few)).all()


def test_network_that_ran_away_says_nothing(films):
    inputs = NormalInputs(films["normals"], TRAIN)
    network = inputs.network(3).eval()
    with torch.no_grad():
        network.scores.bias[0] = float("nan")
    np.testing.assert_allclose(class_probabilities(network, inputs, np.arange(5)), 1 / 3)


def named(values):
    """dict of name -> (n,) of features of series (n, frames, 19)."""
    return dict(zip(FEATURES, sequence_features(values).T, strict=True))


def walk(frames=25):
    return np.random.default_rng(0).normal(size=(3, frames, len(CHANNELS)))


def test_features_are_named_by_series_band_and_statistic():
    values = walk()
    ours = named(values)
    assert len(CHANNELS) == 19 and len(FEATURES) == 228 == len(ours)
    first, last = values[1, :, 0], values[1, :, 17]
    assert ours["direction0.sequence.rms"][1] == pytest.approx(np.sqrt(np.mean(first**2)))
    assert ours["normal_y.sequence.skewness"][1] == pytest.approx(stats.skew(last))
    assert ours["normal_y.detail3.std"][1] == pytest.approx(np.std(pywt.wavedec(last, "db2", "symmetric", 3)[1]))


@pytest.mark.parametrize("level", [0.0, 0.1, -1.0, 1e5])
def test_constant_series_have_no_spread_and_no_skewness(level):
    for name, (value,) in named(np.full((1, 25, 19), level)).items():
        if name.endswith((".std", ".skewness")):
            assert value == 0
        elif ".sequence." in name:
            assert value == pytest.approx(abs(level))
        else:
            assert value == pytest.approx(0, abs=1e-9 * max(abs(level), 1))


def test_series_join_directions_and_normals_frame_by_frame():
    random = np.random.default_rng(1)
    images, normals = random.integers(0, 256, (2, 5, 16, 16), dtype=np.uint8), random.normal(size=(2, 5, 3))
    joined = series(images, normals)
    assert joined.shape == (2, 5, 19)
    np.testing.assert_array_equal(joined[:, :, 16:], normals)
    for frame in range(5):
        np.testing.assert_allclose(joined[:, frame, :16], directional_std(images[:, frame]), rtol=1e-5)
