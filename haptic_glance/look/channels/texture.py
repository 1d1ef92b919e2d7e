"""Channels of texture: contrast, entropy, edges and orientation, and two methods of OpenCV for comparison."""

from functools import cache

import numpy as np

from haptic_glance.base.lazy import cv2
from haptic_glance.mesh.mesh import Mesh

from ..views import View
from .cropped_view import checked_rgb, cropped_view, fill
from .operators import CENTRES, DELTAS, OUTPUT_SCALE, centre_surround, normalise, reduce

WINDOW = 80 / 900  # of the image's rows: 80 x 80 pixels in the thesis's 1200 x 900 (T3.1.1)
FLOOR = 0.5 / 255**2  # variance of half a grey level; below it there is only rounding


def contrast(mesh: Mesh, view: View, filled: bool = True) -> np.ndarray:
    """The contrast conspicuity map (h / 16, w / 16) f4 in 0..1, N of the luminance variance in 80 x 80 (T3.1.1).

    Only pixels of the object count in a window, so that the step to the background adds no contrast.
    """
    image = cropped_view(view, filled)
    side = max(round(WINDOW * image.shape[0]), 3)
    variance = reduce(local_variance(image.luminance, image.known, side), 0)
    return image.place_in_view(normalise(variance, image.cover[OUTPUT_SCALE], FLOOR), OUTPUT_SCALE)


def local_variance(image: np.ndarray, counted: np.ndarray, side: int) -> np.ndarray:
    """(h, w) f4: variance, in units of white squared, over the counted pixels of a side x side window.

    image (h, w) u1, counted (h, w) boolean. Zero where no pixel counts. Sums are of integers, so exact.
    """
    values = np.where(counted, image, 0).astype(np.float32)

    def window_sum(plane):
        return cv2.boxFilter(plane, cv2.CV_64F, (side, side), normalize=False, borderType=cv2.BORDER_CONSTANT)

    count = np.maximum(window_sum(counted.astype(np.float32)), 1)
    mean = window_sum(values) / count
    return ((window_sum(values * values) / count - mean * mean) / 255**2).astype(np.float32)


SIDE = 9  # T3.1.1
MEDIAN = 3  # pixels per side; T3.1.1 names the filter, not its size
SCALE = 2  # of the pixels where it is computed; the windows overlap, so each pixel counts
_COUNTS = np.arange(SIDE * SIDE + 1)
PLOGP = (_COUNTS * np.log2(np.maximum(_COUNTS, 1))).astype(np.float32)


def entropy(mesh: Mesh, view: View, filled: bool = True) -> np.ndarray:
    """The entropy conspicuity map (h / 16, w / 16) f4 in 0..1: N of the entropy in 9 x 9 after a median (T eq. 3.7).

    Only pixels of the object count, so that the background adds no entropy.
    """
    image = cropped_view(view, filled)
    smooth = cv2.medianBlur(image.luminance, MEDIAN)
    values = np.zeros(image.cover[SCALE].shape, dtype=np.float32)
    rows, columns = np.nonzero(image.cover[SCALE])
    values[rows, columns] = local_entropy(smooth, image.known, rows * 2**SCALE, columns * 2**SCALE)
    values = reduce(fill(values, image.cover[SCALE]), SCALE)
    return image.place_in_view(normalise(values, image.cover[OUTPUT_SCALE]), OUTPUT_SCALE)


def local_entropy(image: np.ndarray, counted: np.ndarray, rows: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """(k,) f4: entropy in bits of the counted pixels in the 9 x 9 windows around pixels (rows (k,), columns (k,)).

    image (h, w) u1, counted (h, w) boolean; pixels outside the image do not count. Each window is sorted, so that equal
    levels form runs; with runs of c_i pixels among n, H = log2(n) - sum(c_i log2 c_i) / n.
    """
    half = SIDE // 2
    levels = np.where(counted, image.astype(np.int16), -1)  # -1 is not a grey level: does not count
    padded = cv2.copyMakeBorder(levels, half, half, half, half, cv2.BORDER_CONSTANT, value=-1)
    windows = np.lib.stride_tricks.sliding_window_view(padded, (SIDE, SIDE))[rows, columns].reshape(-1, SIDE * SIDE)
    windows.sort(axis=1)
    ends = np.ones(windows.shape, dtype=bool)
    np.not_equal(windows[:, 1:], windows[:, :-1], out=ends[:, :-1])
    run_ends = np.flatnonzero(ends)
    runs = np.diff(run_ends, prepend=-1)
    runs[windows.ravel()[run_ends] < 0] = 0
    firsts = np.searchsorted(run_ends, np.arange(len(windows)) * SIDE * SIDE)
    counts = np.maximum(np.add.reduceat(runs, firsts), 1) if len(firsts) else np.ones(0)
    summed = np.add.reduceat(PLOGP[runs], firsts) if len(firsts) else np.zeros(0)
    return (np.log2(counts) - summed / counts).astype(np.float32).clip(0)


EDGE_SIGMA = (
    2.0 / 900
)  # of the image's rows: 2 pixels in the thesis's 1200 x 900, wide enough to smooth the steps of 8 bits


def edge(mesh: Mesh, view: View, filled: bool = True) -> np.ndarray:
    """The edge conspicuity map (h / 16, w / 16) f4 in 0..1, N of |LoG| (T3.2), of a haptic_glance.look.views.View."""
    image = cropped_view(view, filled)
    sigma = max(EDGE_SIGMA * image.shape[0], 0.7)
    response = np.abs(laplacian_of_gaussian(image.luminance, sigma))
    return image.place_in_view(normalise(reduce(response, 0), image.cover[OUTPUT_SCALE]), OUTPUT_SCALE)


def laplacian_of_gaussian(image: np.ndarray, sigma: float) -> np.ndarray:
    """(h, w) f4: sigma^2 times the Laplacian of the image (h, w) u1 in 0..1 blurred by sigma pixels.

    The factor makes the response to an edge the same at every sigma (Lindeberg 1998).
    """
    smooth = cv2.GaussianBlur(image.astype(np.float32), (0, 0), sigma, borderType=cv2.BORDER_REPLICATE)
    return cv2.Laplacian(smooth, cv2.CV_32F, borderType=cv2.BORDER_REPLICATE) * np.float32(sigma**2 / 255)


ANGLES = (0, 45, 90, 135)  # degrees, counter-clockwise from the horizontal, the direction of the preferred bar
WAVELENGTH = 4.0  # pixels of the scale: Greenspan et al., Overcomplete steerable pyramid filters, CVPR 1994 (Itti's)
GABOR_SIGMA = 1.5  # pixels; small enough that the coarse scales still resolve the parts of the object
RADIUS = 4  # 9 x 9 pixels
GAIN = 0.5  # from each scale to the next coarser one: responses are per pixel of the view, see `orientation`


def orientation(mesh: Mesh, view: View, filled: bool = True) -> np.ndarray:
    """The orientation conspicuity map (h / 16, w / 16) f4 in 0..1, T eq. 3.2, of a haptic_glance.look.views.View.

    T and its sources do not state the gain between scales. With equal gain a plain edge has the same response at all
    scales, so that |O(c) - O(s)| is zero on the edge and high on the empty surface next to it. With a gain per pixel
    of the view, half at each coarser scale, the edge itself stands out.
    """
    image = cropped_view(view, filled)
    levels = {s: image.intensity_pyramid[s] for s in range(CENTRES[0], CENTRES[-1] + DELTAS[-1] + 1)}
    total = np.zeros(image.cover[OUTPUT_SCALE].shape, dtype=np.float32)
    for angle in ANGLES:
        energies = {s: magnitude(level, gabor(angle)) * GAIN ** (s - CENTRES[0]) for s, level in levels.items()}
        total = total + normalise(centre_surround(energies, image.cover), image.cover[OUTPUT_SCALE])
    return image.place_in_view(normalise(total, image.cover[OUTPUT_SCALE]), OUTPUT_SCALE)


def magnitude(image: np.ndarray, kernels: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
    """(h, w) f4: magnitude of the responses of an image (h, w) f4 to an even and an odd kernel."""
    even, odd = (cv2.filter2D(image, cv2.CV_32F, kernel, borderType=cv2.BORDER_REPLICATE) for kernel in kernels)
    # Not cv2.magnitude, whose last bit depends on memory alignment.
    return np.sqrt(even * even + odd * odd)


def gabor_grid(angle: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(distance across the bar, Gaussian envelope, plain wave) at the pixels of the Gabor kernels of an angle."""
    x, y = np.meshgrid(np.arange(-RADIUS, RADIUS + 1), np.arange(RADIUS, -RADIUS - 1, -1))
    across = y * np.cos(np.radians(angle)) - x * np.sin(np.radians(angle))
    return across, np.exp(-(x**2 + y**2) / (2 * GABOR_SIGMA**2)), np.exp(2j * np.pi * across / WAVELENGTH)


@cache
def gabor(angle: float) -> tuple[np.ndarray, np.ndarray]:
    """The even and odd Gabor kernels of an angle, of unit gain, without response to a constant or a linear slope.

    A plain Gabor kernel responds slightly to both, and at coarse scales smooth shading would mask every bar.
    """
    across, envelope, wave = gabor_grid(angle)
    wave = wave * envelope
    wave -= envelope * (wave.sum() / envelope.sum())
    slope = envelope * across
    wave -= slope * ((wave * across).sum() / (slope * across).sum())
    wave /= np.abs(wave).sum() / 2
    return wave.real.astype(np.float32), wave.imag.astype(np.float32)


def spectral_residual(mesh: Mesh, view: View, filled: bool = True) -> np.ndarray:
    """The spectral residual map (h / 4, w / 4) f4 in 0..1 of a haptic_glance.look.views.View, by OpenCV.

    Hou and Zhang, Saliency detection: a spectral residual approach, CVPR 2007. The image is used as rendered,
    whatever `filled`, as the authors of the method would use it. Zero for an image of one grey value, for which OpenCV
    returns noise near 1.
    """
    grey = cv2.cvtColor(checked_rgb(view), cv2.COLOR_RGB2GRAY)
    if grey.min() == grey.max():
        return cropped_view(view, False).zero_map()
    detector = cv2.saliency.StaticSaliencySpectralResidual.create()
    return reduce(np.asarray(detector.computeSaliency(grey)[1]), 0, SCALE)


def fine_grained(mesh: Mesh, view: View, filled: bool = True) -> np.ndarray:
    """The fine-grained saliency map (h / 4, w / 4) f4 in 0..1 of a haptic_glance.look.views.View, by OpenCV.

    Montabone and Soto, Human detection using a mobile platform and novel features derived from a visual saliency
    mechanism, Image and Vision Computing 28(3), 2010. The image is used as rendered, whatever `filled`, as the
    authors of the method would use it.
    """
    grey = cv2.cvtColor(checked_rgb(view), cv2.COLOR_RGB2GRAY)
    detector = cv2.saliency.StaticSaliencyFineGrained.create()
    return reduce(np.asarray(detector.computeSaliency(grey)[1]), 0, SCALE)
