"""Directions of an imprint: a tight frame that knows angles."""

import numpy as np
import pytest

from stages.sequences.contourlet import DIRECTIONS, border_position, directional_std, wedges

MAP_DIMENSIONS = [(32, 32), (16, 16), (8, 8), (33, 33), (16, 32), (9, 12), (4, 4)]


def noise(shape, seed=0):
    return np.random.default_rng(seed).random(shape)


def grating(angle, size=64, waves=9):
    """A wave whose frequency has this angle from level, in degrees, rounded to whole waves."""
    down, along = np.mgrid[:size, :size]
    radians = np.radians(angle)
    y, x = round(waves * np.sin(radians)), round(waves * np.cos(radians))
    return np.cos(2 * np.pi * (x * along + y * down) / size), (x, y)


@pytest.mark.parametrize("size", MAP_DIMENSIONS)
def test_shares_add_up_to_one_frequency_or_two(size):
    total = wedges(*size).sum(axis=0)
    assert total[0, 0] == 0
    along = np.fft.rfftfreq(size[1])
    expected = np.where((along > 0) & (along < 0.5), 2.0, 1.0)
    np.testing.assert_allclose(total.ravel()[1:], np.broadcast_to(expected, total.shape).ravel()[1:], atol=1e-12)


@pytest.mark.parametrize("size", MAP_DIMENSIONS)
def test_energies_add_up_to_the_variance(size):
    images = noise((5, *size))
    np.testing.assert_allclose((directional_std(images) ** 2).sum(axis=1), images.var(axis=(1, 2)), rtol=1e-10)


@pytest.mark.parametrize("angle", [5, 20, 35, 55, 70, 85, 110, 140, 170])
def test_grating_lights_the_wedge_of_its_angle(angle):
    image, (x, y) = grating(angle)
    found = directional_std(image[None])[0]
    at = border_position(np.array([float(x)]), np.array([float(y)]))[0] / 4 * DIRECTIONS
    assert found.argmax() in (int(at) % DIRECTIONS, round(at) % DIRECTIONS, (round(at) - 1) % DIRECTIONS)
    far = [k for k in range(DIRECTIONS) if 1.5 < (k + 0.5 - at) % DIRECTIONS < DIRECTIONS - 1.5]
    assert np.abs(found[far]).max() < 1e-9


def test_grating_in_the_middle_of_a_wedge_lights_it_alone():
    down, along = np.mgrid[:64, :64]
    image = np.cos(2 * np.pi * (8 * along + 3 * down) / 64)  # slope 3 / 8: between the seams 1 / 4 and 1 / 2
    found = directional_std(image[None])[0]
    assert found[1] == pytest.approx(np.sqrt(0.5))
    assert np.delete(found, 1).max() < 1e-9


@pytest.mark.parametrize("size", [32, 33, 8])
def test_quarter_turn_moves_every_direction_by_half_the_number(size):
    image = noise((size, size), 3)
    turned = directional_std(np.rot90(image)[None])[0]
    # Turned frequencies (x, y) become (y, -x): the place on the border of the square moves by two of its four parts.
    np.testing.assert_allclose(turned, np.roll(directional_std(image[None])[0], 8), atol=1e-12)


def test_mirroring_reverses_the_directions():
    image = noise((32, 32), 4)
    np.testing.assert_allclose(
        directional_std(image[None, :, ::-1])[0], directional_std(image[None])[0][::-1], atol=1e-12
    )


def test_shift_round_the_border_changes_nothing():
    image = noise((32, 32), 5)
    moved = np.roll(image, (3, 7), axis=(0, 1))
    np.testing.assert_allclose(directional_std(moved[None]), directional_std(image[None]), atol=1e-12)


def test_constant_image_gives_zeros():
    assert directional_std(np.full((2, 32, 32), 0.7)).max() < 1e-12
    assert directional_std(np.full((2, 32, 32), 200, dtype=np.uint8)).max() == 0


def test_whole_numbers_are_of_a_scale_of_255():
    images = np.random.default_rng(6).integers(0, 256, (4, 32, 32), dtype=np.uint8)
    np.testing.assert_allclose(directional_std(images), directional_std(images / 255.0), rtol=1e-6)


def test_many_images_go_in_pieces(monkeypatch):
    images = noise((7, 8, 8))
    whole = directional_std(images)
    monkeypatch.setattr("stages.sequences.contourlet.BATCH", 3)
    np.testing.assert_allclose(directional_std(images), whole, rtol=1e-12)


def test_none_gives_none():
    assert directional_std(np.zeros((0, 32, 32))).shape == (0, 16)


@pytest.mark.parametrize(
    ("images", "count", "word"),
    [(np.zeros((32, 32)), 16, "shape"), (np.zeros((1, 3, 32)), 16, "at least 4"), (np.zeros((1, 8, 8)), 5, "even"),
     (np.full((1, 8, 8), np.nan), 16, "NaN")],
)  # fmt: skip
def test_bad_input_is_named(images, count, word):
    with pytest.raises(ValueError, match=word):
        directional_std(images, count)
