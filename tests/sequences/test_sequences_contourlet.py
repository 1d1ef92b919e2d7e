"""Contourlets of an imprint, and the ladders in space that undo them."""

import numpy as np
import pytest

from stages.sequences.contourlet import STEPS, detail, directional_bands, directional_std

SIZES = [(32, 32), (8, 8), (24, 16)]
# Do and Vetterli 2005: quincunx and resampling matrices, and which of them follow each other.
Q0, Q1 = np.array([[1, -1], [1, 1]]), np.array([[1, 1], [-1, 1]])
SHEARS = [np.array(shear) for shear in ([[1, 1], [0, 1]], [[1, -1], [0, 1]], [[1, 0], [1, 1]], [[1, 0], [-1, 1]])]
QUINCUNXES = (Q0, Q1, Q1, Q0)
SIGNS = (-1, 1, 1, -1)  # so that the first channel of every node has the larger slopes
TAPS = (0.63, -0.193, 0.0972, -0.0526, 0.0272, -0.0144)  # half of the ladder's filter, Phoong et al. 1995
# Analysis and synthesis low-pass of Cohen, Daubechies and Feauveau, from the middle.
NINE = (0.852698679009, 0.377402855613, -0.110624404418, -0.023849465019, 0.037828455507)
SEVEN = (0.788485616406, 0.418092273222, -0.040689417609, -0.064538882629)


def noise(shape, seed=0):
    return np.random.default_rng(seed).random(shape)


def allpass(image, axes, sign):
    """The filter of a ladder in space: its 12 taps along both diagonals of a lattice with these axes."""
    for diagonal in (axes[:, 0] + axes[:, 1], axes[:, 0] - axes[:, 1]):
        pairs = [
            np.roll(image, -k * diagonal, (0, 1)) - np.roll(image, (k + 1) * diagonal, (0, 1)) for k in range(len(TAPS))
        ]
        image = sum((-1) ** k * tap * pair for k, (tap, pair) in enumerate(zip(TAPS, pairs, strict=True)))
    return -sign * np.roll(image, -axes[:, 0], (0, 1))


def put(band, corner, steps, shape):
    """The image with the coefficients of a band where they were sampled."""
    image = np.zeros(shape)
    rows, columns = (np.arange(count) * step + at for count, step, at in zip(band.shape, steps, corner, strict=True))
    image[np.ix_(rows % shape[0], columns % shape[1])] = band
    return image


def undo(bands, shape, sampling, corner, path, half):
    """The image on the lattice of a node of the tree from its sub-bands, of lower slopes first, by backward ladders.

    path: for each level below the first, whether the node has the larger slopes.
    """
    if len(bands) == 1:
        return put(bands[0], corner, STEPS[half], shape)
    kind = 2 * half + path[-1] if path else None
    axes = sampling if kind is None else sampling @ SHEARS[kind]
    quincunx, sign = (Q1, 1) if kind is None else (QUINCUNXES[kind], SIGNS[kind])
    # The second channel is sampled where the product has it, which is one of many possible places.
    wedges = 2 ** len(path)
    beside = [wedges, wedges - 2 * int("".join(map(str, path)) or "0", 2)][:: 1 - 2 * half]
    lower, upper = bands[: len(bands) // 2], bands[len(bands) // 2 :]
    second = undo(lower, shape, axes @ quincunx, corner + beside, (*path, 0), half)
    first = undo(upper, shape, axes @ quincunx, corner, (*path, 1), half)
    return ladder_back(first, second, axes, sign)


def ladder_back(first, second, axes, sign):
    """The image whose channels these are: what the ladder added last is subtracted first."""
    odd = (second + on(second, allpass(first, axes, sign))) / np.sqrt(2)
    return odd + np.sqrt(2) * first - on(first, allpass(odd, axes, sign))


def on(channel, image):
    """The image where the channel was sampled."""
    return np.where(channel != 0, image, 0)


@pytest.mark.parametrize("size", SIZES)
def test_ladders_in_space_give_the_image_back(size):
    image = noise(size, 1)
    steep, flat = (bands[0] for bands in directional_bands(image[None]))
    first = undo(steep, size, Q0, np.array([0, 0]), (), 0)
    second = undo(flat[::-1], size, Q0, np.array([1, 0]), (), 1)
    np.testing.assert_allclose(ladder_back(first, second, np.eye(2, dtype=int), -1), image, atol=1e-10)


def smooth(image, taps):
    """The image filtered with a symmetric filter along rows and columns, continued periodically."""
    for axis in (0, 1):
        pairs = (tap * (np.roll(image, k, axis) + np.roll(image, -k, axis)) for k, tap in enumerate(taps[1:], 1))
        image = taps[0] * image + sum(pairs)
    return image


def coarse(image):
    return smooth(image, NINE)[::2, ::2]


def fine(image):
    """The coarse image interpolated."""
    enlarged = np.zeros(np.multiply(image.shape, 2))
    enlarged[::2, ::2] = image
    return smooth(enlarged, SEVEN)


@pytest.mark.parametrize("size", SIZES)
def test_pyramid_gives_the_image_back(size):
    image = noise(size, 2)
    details = detail(image[None])[0]
    np.testing.assert_allclose(fine(coarse(image)) + details, image, atol=1e-10)
    # The inverse of Do and Vetterli 2003, with the dual frame.
    np.testing.assert_allclose(fine(coarse(image) - coarse(details)) + details, image, atol=1e-10)
    np.testing.assert_allclose(coarse(details), 0, atol=1e-10)


def test_sub_bands_have_as_many_coefficients_as_the_image_has_pixels_and_shift_with_it():
    images = noise((2, 32, 48), 3)
    bands, moved = (directional_bands(batch) for batch in (images, np.roll(images, (8, 16), axis=(1, 2))))
    assert bands[0].shape == (2, 8, 4, 24) and bands[1].shape == (2, 8, 16, 6)
    for shifted, band, steps in zip(moved, bands, STEPS, strict=True):
        expected = np.roll(band, (8 // steps[0], 16 // steps[1]), axis=(2, 3))
        np.testing.assert_allclose(shifted, expected, atol=1e-12)


@pytest.mark.parametrize("radius", [22, 29])
@pytest.mark.parametrize("band", range(16))
def test_wave_lights_the_sub_band_of_its_direction(band, radius):
    across = round(radius * ((band % 8 + 0.5) / 4 - 1))
    y, x = (across, radius) if band < 8 else (radius, -across)  # periods of the wave down and along the image
    down, along = np.mgrid[:64, :64]
    energy = directional_std(np.cos(2 * np.pi * (x * along + y * down) / 64)[None])[0] ** 2
    assert energy.argmax() == band and energy[band] > 0.5 * energy.sum()


@pytest.mark.parametrize("image", [np.zeros((8, 8)), np.full((32, 32), 0.7), np.full((32, 32), 200, dtype=np.uint8)])
def test_constant_image_gives_zeros(image):
    assert directional_std(image[None]).max() < 1e-15


def test_deviations_are_those_of_the_sub_bands_of_the_detail_also_in_pieces(monkeypatch):
    images = noise((3, 16, 32), 5)
    bands = [part for half in directional_bands(detail(images)) for part in np.moveaxis(half, 1, 0)]
    expected = np.transpose([band.std(axis=(1, 2)) for band in bands])
    np.testing.assert_allclose(directional_std(images), expected, rtol=1e-10)
    monkeypatch.setattr("stages.sequences.contourlet.BATCH", 2)
    np.testing.assert_allclose(directional_std(images), expected, rtol=1e-10)
    assert directional_std(images[:0]).shape == (0, 16)


def test_image_of_other_sides_is_mirrored_up_to_a_multiple_of_eight():
    image = noise((1, 12, 33), 7)
    mirrored = np.concatenate([image, image[:, :-5:-1]], axis=1)
    mirrored = np.concatenate([mirrored, mirrored[:, :, :-8:-1]], axis=2)
    assert mirrored.shape == (1, 16, 40)
    np.testing.assert_allclose(directional_std(image), directional_std(mirrored), rtol=1e-10)
    assert (directional_std(noise((1, 4, 4))) > 0).all()
