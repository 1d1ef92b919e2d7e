"""Sixteen directions of an imprint: the contourlet transform (Do and Vetterli 2005, T [261]; T4.4.9)."""

import functools

import numpy as np
import pywt
import scipy.fft
from numpy.typing import ArrayLike

DIRECTIONS = 16  # T4.4.9
HALF = DIRECTIONS // 2
LEVELS = (2, 3, 4)  # of the tree behind the first fan, each of which halves every sub-band
PYRAMID = "bior4.4"  # the 9-7 filters of Cohen, Daubechies and Feauveau, which the authors use
LADDER = (0.6300, -0.1930, 0.0972, -0.0526, 0.0272, -0.0144)  # half of 12 taps: the 23-45 filters of Phoong et al. 1995
STEPS = ((8, 2), (2, 8))  # rows and columns between two coefficients, in the first and in the second half
SMALLEST = 4  # rows and columns of an image
BATCH = 512  # images transformed at once, which bounds the memory


def directional_std(images: ArrayLike) -> np.ndarray:
    """(k, 16) f8: standard deviation of each directional sub-band of images (k, rows, cols), u1 or floats.

    Integers up to 16 bits are scaled from 0..255 to 0..1 and transformed in single precision. The sub-bands are those
    of the finest level of the pyramid, since the thesis has one number per direction and names no level. The image is
    continued periodically, as in the authors' program, so that the discontinuity at its border counts as a stripe.
    An image whose sides are no multiples of 8 is first mirrored at its end, up to the next multiple.
    Raises ValueError for another shape, fewer than 4 x 4 cells, or NaN.
    """
    images = np.asarray(images)
    if images.ndim != 3 or min(images.shape[1:]) < SMALLEST:
        raise ValueError(f"images must have shape (k, rows, cols), at least {SMALLEST} x {SMALLEST}: {images.shape}")
    if images.dtype.kind == "f" and not np.isfinite(images).all():
        raise ValueError("images hold NaN or infinite values")
    scale = 255.0 if images.dtype.kind in "iu" else 1.0
    whole = [(0, 0), *((0, -side % max(STEPS[0])) for side in images.shape[1:])]
    deviations = np.empty((len(images), DIRECTIONS))
    for start in range(0, len(images), BATCH):
        part = images[start : start + BATCH].astype(np.result_type(images, np.float32))
        # A constant image is then exactly 0; the detail has no mean anyway.
        part = np.pad(part - part.mean(axis=(1, 2), keepdims=True), whole, mode="symmetric")
        halves = [bands.std(axis=(2, 3)) for bands in directional_bands(detail(part))]
        deviations[start : start + BATCH] = np.concatenate(halves, axis=1) / scale
    return deviations


def detail(images: np.ndarray) -> np.ndarray:
    """The finest level of the Laplacian pyramid of images (k, rows, cols): what the next coarser image lacks of them.

    The coarser image is the low-pass band of a wavelet transform, with rows and columns halved. Rows and columns must
    be even. The images are continued periodically.
    """
    down, along = (_low_pass(side).astype(images.dtype) for side in images.shape[1:])
    return images - down @ images @ along.T


def _low_pass(side):
    """(side, side): the matrix that filters and halves a row, and interpolates it again."""
    coarse, _ = pywt.dwt(np.eye(side), PYRAMID, mode="periodization", axis=0)
    return pywt.idwt(coarse, None, PYRAMID, mode="periodization", axis=0)


def directional_bands(images: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The directional filter bank of images (k, rows, cols): sub-bands 0 to 7 and 8 to 15, in the authors' order.

    The first eight, (k, 8, rows / 8, cols / 2), respond to stripes steeper than 45 degrees. The slope y / x of their
    frequency, y down, rises from -1 to 1. The others, (k, 8, rows / 2, cols / 8), respond to flatter stripes, and x / y
    falls from 1 to -1. Rows and columns must be multiples of 8. There are as many coefficients as pixels, and the
    images can be computed from them.

    The bank is a tree of four levels of ladders with two channels on quincunx lattices (Phoong et al. 1995). It is
    computed in the Fourier domain. With periodic continuation a filter behind a sampling is a product of responses
    before it. Every sub-band is then one product with the spectrum of the image, and one sum over the frequencies that
    sampling cannot tell apart. This is the ladder exactly, not an approximation, and takes one matrix product per
    frequency for many images.
    """
    rows, columns = images.shape[1:]
    spectra, bands = np.asarray(scipy.fft.fft2(images)), []
    for weights, (down, along) in zip(_weights(rows, columns, spectra.dtype), STEPS, strict=True):
        sampled = _aliases(spectra, down, along) @ weights
        half = np.asarray(scipy.fft.irfft2(sampled, (rows // down, columns // along), axes=(0, 1)))
        bands.append(np.moveaxis(half, (0, 1), (2, 3)))
    return bands[0], bands[1]


@functools.lru_cache(maxsize=8)
def _weights(rows, columns, dtype):
    """Of both halves: (rows / down, cols / along // 2 + 1, 16, 8), the responses where frequencies fall on one."""
    responses = filters(rows, columns).astype(dtype) / DIRECTIONS
    parts = zip((responses[:HALF], responses[HALF:]), STEPS, strict=True)
    return [np.ascontiguousarray(np.swapaxes(_aliases(part, *steps), 2, 3)) for part, steps in parts]


def _aliases(spectra, down, along):
    """(rows / down, cols / along // 2 + 1, k, 16): the frequencies of spectra (k, rows, cols) that sampling adds up.

    Sampled images are real, so that the other half of the columns mirrors this one.
    """
    count, rows, columns = spectra.shape
    blocks = spectra.reshape(count, down, rows // down, along, columns // along)
    half = blocks[..., : columns // along // 2 + 1].transpose(2, 4, 0, 1, 3)
    return half.reshape(*half.shape[:3], down * along)


def filters(rows: int, columns: int) -> np.ndarray:
    """(16, rows, cols) complex: the response of each sub-band at the frequencies of an fft2.

    The first level splits at the diagonals, |x| = |y|. Every further level splits a wedge of slopes v / u, where u is
    the larger of both frequencies, in the middle. The second channel of a ladder is sampled beside the first one, so
    that its response contains a shift.
    """
    y, x = 2 * np.pi * np.stack(np.meshgrid(np.fft.fftfreq(rows), np.fft.fftfreq(columns), indexing="ij"))
    responses = np.empty((DIRECTIONS, rows, columns), dtype=complex)
    for k in range(DIRECTIONS):
        flat = k >= HALF
        u, v = (y, x) if flat else (x, y)
        place = DIRECTIONS - 1 - k if flat else k  # of the wedge, by its slope
        response = channel(square_wave((x + y) / 2) * square_wave((x - y) / 2), flat)
        shift = u * flat
        for level in LEVELS:
            wedges = 2 ** (level - 2)
            middle = 2 * (place >> (5 - level)) - wedges + 1  # slope of the split, times wedges
            lower = not place >> (4 - level) & 1
            response = response * channel(square_wave(u) * square_wave(wedges * v - middle * u), lower)
            shift = shift + lower * ((1 - middle) * u + wedges * v)
        responses[k] = response * np.exp(1j * shift)
    return responses


def channel(sign: np.ndarray, second: bool) -> np.ndarray:
    """Response of a channel of a ladder, whose allpass filter is about 1 where the first channel passes, else -1."""
    first = (1 + sign) / np.sqrt(2)
    return np.sqrt(2) - sign * first if second else first


def square_wave(phase: np.ndarray) -> np.ndarray:
    """The sign of sin(phase), as well as the ladder's filter has it."""
    harmonics = (2 * tap * (-1) ** k * np.sin((2 * k + 1) * phase) for k, tap in enumerate(LADDER))
    return functools.reduce(np.add, harmonics)
