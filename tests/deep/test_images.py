"""Imprints become images of the thesis's kind."""

import numpy as np
import pytest
import torch

from haptic_glance.deep.images import MEAN, STD, augmentation, normalise, to_images

pytestmark = pytest.mark.slow

IMPRINTS = np.random.default_rng(0).random((5, 24, 24), dtype=np.float32)


def test_grey_goes_to_red_and_the_rest_is_zero():
    images = to_images(IMPRINTS, 24).numpy()
    assert np.array_equal(images[:, 0], IMPRINTS) and not images[:, 1:].any()
    grey = np.arange(256, dtype=np.uint8).reshape(1, 16, 16)
    assert torch.equal(to_images(grey, 16), to_images(grey.astype(np.float32) / 255, 16))
    assert to_images(IMPRINTS, 8)[:, 0].mean().item() == pytest.approx(IMPRINTS.mean(), abs=0.01)


def test_reversed_imprints_are_taken_as_they_lie():
    imprints = np.random.default_rng(0).random((2, 4, 6))[:, ::-1, ::-1]
    assert torch.equal(to_images(imprints, 8), to_images(imprints.copy(), 8))


@pytest.mark.filterwarnings("error")
def test_imprints_that_may_only_be_read_are_taken_without_a_warning():
    kept = IMPRINTS.copy()
    kept.setflags(write=False)
    assert torch.equal(to_images(kept, 24), to_images(IMPRINTS, 24))


def test_normalised_photographs_of_imagenets_mean_are_zero_and_one_deviation_is_one():
    image = torch.tensor(MEAN).view(1, 3, 1, 1).expand(1, 3, 4, 4)
    assert normalise(image).abs().max() == 0
    image = image + torch.tensor(STD).view(1, 3, 1, 1)
    assert torch.allclose(normalise(image), torch.ones(1, 3, 4, 4), atol=1e-6)


def test_augmentation_moves_images_but_no_value_range_and_no_channel_and_no_contact_from_outside():
    images = to_images(IMPRINTS, 24)
    torch.manual_seed(0)
    moved = augmentation()(images)
    assert moved.shape == images.shape and not torch.allclose(moved, images)
    assert not moved[:, 1:].any() and moved.min() >= 0 and moved.max() <= 1
    far = to_images(np.ones((8, 16, 16), dtype=np.float32), 16)
    assert torch.allclose(augmentation()(far)[:, 0], far[:, 0], atol=1e-5)


@pytest.mark.parametrize(
    ("bad", "reason"),
    [
        (np.zeros((4, 4)), "shape"),
        (np.zeros((0, 4, 4)), "empty"),
        (np.full((1, 4, 4), np.nan), "0..1"),
        ([np.zeros((4, 4)), np.zeros((4, 5))], r"several sizes, \(4, 4\), \(4, 5\)"),
    ],
)
def test_bad_imprints_are_refused(bad, reason):
    with pytest.raises(ValueError, match=reason):
        to_images(bad, 4)
