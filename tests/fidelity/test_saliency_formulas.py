"""T3.1.1 and T3.2, eq. 3.1 to 3.9: conspicuity maps and their averages, in plain loops of numpy and scipy."""

import cmath
import math
from types import SimpleNamespace

import numpy as np
from scipy import ndimage

from haptic_glance.look.camera import Viewpoint
from haptic_glance.look.channels import conspicuity
from haptic_glance.look.channels.channels import mask_at_size
from haptic_glance.look.channels.colour import LINEAR, MECHANISMS
from haptic_glance.look.points.detectors import FusedDetector, SummedDetector
from haptic_glance.look.points.fuse import COMBINATIONS, fuse
from haptic_glance.look.views import View, render
from haptic_glance.mesh.mesh import Mesh

MESH = Mesh([[0, -0.5, -0.5], [0, 0.5, -0.5], [0, 0, 0.5]], [[0, 1, 2]])
PAIRS = [(c, c + delta) for c in (2, 3, 4) for delta in (3, 4)]


def smaller(image):
    """The next level of a dyadic pyramid, with a Gaussian of one pixel to 4 deviations; not the binomial."""
    return ndimage.gaussian_filter(np.asarray(image, dtype=np.float64), 1, mode="nearest")[::2, ::2]


def pyramid(image):
    levels = [np.asarray(image, dtype=np.float64)]
    for _ in range(8):
        levels.append(smaller(levels[-1]))
    return levels


def at_scale(image, fine, steps):
    """The coarse image at the pixels of the fine one, by straight lines: pixel k of a scale lies on pixel 2 k below."""
    places = np.mgrid[: fine[0], : fine[1]] / 2**steps
    return ndimage.map_coordinates(image, places, order=1, mode="nearest")


def filtered(image, fine, steps):
    """The same with zeros between the pixels and a filter of 1, 4, 6, 4, 1 over them at each scale."""
    shapes = [fine]
    while len(shapes) < steps:
        shapes.append(tuple(-(-side // 2) for side in shapes[-1]))
    for shape in reversed(shapes):
        spread = np.zeros(shape)
        spread[::2, ::2] = image
        for axis in (0, 1):
            spread = ndimage.convolve1d(spread, np.array([1, 4, 6, 4, 1]) / 8, axis, mode="mirror")
        image = spread
    return image


def local_maxima(image):
    """One value for each regional maximum above zero: pixels that no neighbour exceeds, plateaus counted once."""
    highest = image == ndimage.maximum_filter(image, 3, mode="nearest")
    labels, count = ndimage.label(highest & (image > 0), np.ones((3, 3)))
    values = []
    for k in range(1, count + 1):
        values += list(np.unique(image[labels == k]))
    return np.array(values)


def n(image, mended=False):
    """N(.): the image times (M - m)^2, M its maximum and m the mean of all (mended: all other) local maxima."""
    scaled = ((image - image.min()) / np.ptp(image)).astype(np.float32)
    maxima = np.sort(local_maxima(scaled))
    counted = maxima[:-1] if mended else maxima
    return scaled * (scaled.max() - (counted.mean() if len(counted) else 0)) ** 2


def across_scales(levels, surround=None, mended=False, enlarge=at_scale):
    """The sums over c and s of N(|I(c) - I(s)|), reduced to scale 4 and added point by point (eq. 3.1)."""
    total = 0
    for c, s in PAIRS:
        other = enlarge((surround or levels)[s], levels[c].shape, s - c)
        term = n(np.abs(levels[c] - other), mended)
        for _ in range(c, 4):
            term = smaller(term)
        total = total + term
    return total


def gabor_response(image, degrees, zero_mean):
    """The magnitude of the sum over 9 x 9 pixels of exp(-r^2 / (2 1.5^2)) exp(2 pi i d / 4) times the picture.

    d is the distance across a bar of this direction; the weights exp(.) are divided by their sum. With `zero_mean`,
    each window first loses its weighted mean.
    """
    padded, rows, columns = np.pad(image, 4, mode="edge"), *image.shape
    window = {
        (right, up): padded[4 - up : 4 - up + rows, 4 + right : 4 + right + columns]
        for up in range(-4, 5)
        for right in range(-4, 5)
    }
    weight = {(right, up): math.exp(-(right**2 + up**2) / 4.5) for right, up in window}
    mean = sum(weight[k] * window[k] for k in window) / sum(weight.values())
    angle, response = math.radians(degrees), 0
    for right, up in window:
        across = up * math.cos(angle) - right * math.sin(angle)
        seen = window[right, up] - (mean if zero_mean else 0)
        response = response + weight[right, up] * cmath.exp(2j * math.pi * across / 4) * seen
    return np.abs(response) / sum(weight.values())


def printed(picture, channel, formulas="printed"):
    """The library's map with the printed formulas or another reading of them, on the scale of its sum."""
    rgb, mask = picture
    view = View(rgb, np.full(mask.shape, 10, np.float32), np.where(mask, 0, -1).astype(np.int32), Viewpoint(0, 0))
    size = tuple(side // 4 for side in mask.shape)
    return conspicuity(MESH, view, [channel], size, filled=False, formulas=formulas)[channel]


def at_quarter(literal, mask):
    """The literal map at the pixels of the library's: pixel k, of a quarter of the picture, lies at 4 k + 1.5 of it."""
    scale = round(mask.shape[0] / literal.shape[0])
    places = np.stack(np.mgrid[: mask.shape[0] // 4, : mask.shape[1] // 4]) * 4 + 1.5
    return ndimage.map_coordinates(np.asarray(literal, dtype=np.float64), places / scale, order=1, mode="nearest")


def correlation(computed, literal, mask):
    """Of two maps over the object."""
    inside = computed > 0
    return float(np.corrcoef(computed[inside], at_quarter(literal, mask)[inside])[0, 1])


def test_normalisation(picture, agreement):
    from haptic_glance.look.channels import printed as library

    rgb, _ = picture
    images = [
        rgb.mean(axis=2),
        ndimage.gaussian_filter(np.random.default_rng(0).random((60, 80)), 2),
        rgb[..., 0] / 255,
    ]
    apart = [np.abs(library.normalise(np.float32(image), mended) - n(np.float32(image), mended)).max()
             for image in images for mended in (False, True)]  # fmt: skip
    agreement("difference", max(apart))


def intensity(rgb):
    return across_scales(pyramid(rgb.mean(axis=2) / 255))


def test_intensity(picture, agreement):
    rgb, mask = picture
    agreement("r", correlation(printed(picture, "intensity"), intensity(rgb), mask))


def orientation(rgb, zero_mean=False, enlarge=at_scale):
    levels = pyramid(rgb.mean(axis=2) / 255)
    responses = ([gabor_response(level, angle, zero_mean) for level in levels] for angle in (0, 45, 90, 135))
    return sum(n(across_scales(response, enlarge=enlarge)) for response in responses)


def test_orientation(picture, agreement):
    """eq. 3.2 with plain Gabor kernels."""
    rgb, mask = picture
    agreement("r", correlation(printed(picture, "orientation"), orientation(rgb), mask))


def test_orientation_of_zero_mean(picture, agreement):
    """eq. 3.2 with Gabor kernels of sum zero, whose weak responses depend on how a coarse scale is enlarged."""
    rgb, mask = picture
    library = printed(picture, "orientation", "zero_mean")
    agreement("r", correlation(library, orientation(rgb, True), mask))
    assert round(correlation(library, orientation(rgb, True, filtered), mask), 3) == 0.998


def test_the_sum_of_the_gabor_kernels(picture):
    """The map of kernels of sum zero beside that of plain ones: two readings, not one."""
    plain, zero_mean = (printed(picture, "orientation", formulas) for formulas in ("printed", "zero_mean"))
    inside = plain > 0
    assert round(np.corrcoef(plain[inside], zero_mean[inside])[0, 1], 2) == 0.27


def opponents(rgb):
    r, g, b = np.moveaxis(rgb / 255, 2, 0)
    red, green, blue = r - (g + b) / 2, g - (r + b) / 2, b - (r + g) / 2
    yellow = (r + g) / 2 - np.abs(r - g) / 2 - b
    return (red, green), (blue, yellow)


def color(rgb, mended=False):
    total = 0
    for first, second in opponents(rgb):
        centre, surround = pyramid(first - second), pyramid(first - second if mended else second - first)
        total = total + across_scales(centre, surround, mended)
    return total


def color_likeness(picture, mended):
    rgb, mask = picture
    return correlation(printed(picture, "color", "mended" if mended else "printed"), color(rgb, mended), mask)


def test_color(picture, agreement):
    """eq. 3.3 to 3.5: |(R(c) - G(c)) - (G(s) - R(s))|, and blue and yellow likewise."""
    agreement("r", color_likeness(picture, mended=False))


def test_mended_color(picture, agreement):
    """The same as T [41] means it: |(R(c) - G(c)) - (R(s) - G(s))|, and N without the highest maximum."""
    agreement("r", color_likeness(picture, mended=True))


def test_the_sign_of_color(picture):
    """The map with the printed sign beside the mended one: two readings, not one."""
    inside = picture[1][2::4, 2::4]
    maps = [printed(picture, "color", formulas)[inside] for formulas in ("printed", "mended")]
    assert round(np.corrcoef(*maps)[0, 1], 2) == 0.86


def dkl(rgb):
    return sum(across_scales(pyramid(plane)) for plane in np.moveaxis(LINEAR[rgb] @ MECHANISMS.T, 2, 0))


def test_dkl(picture, agreement):
    rgb, mask = picture
    agreement("r", correlation(printed(picture, "dkl"), dkl(rgb), mask))


def test_sums(picture, agreement):
    """eq. 3.8 of the sums of eq. 3.1 to 3.6; of means the intensity would weigh as much as DKL, not a third."""
    rgb, mask = picture
    sums = {"intensity": intensity, "orientation": orientation, "color": color, "dkl": dkl}
    literal = sum(at_quarter(formula(rgb), mask) for formula in sums.values()) / len(sums)
    sight = SimpleNamespace(maps={channel: printed(picture, channel) for channel in sums})
    computed = SummedDetector(sums).fused(sight, None)
    inside = computed > 0
    agreement("r", float(np.corrcoef(computed[inside], literal[inside])[0, 1]))
    plain = FusedDetector(sums).fused(sight, None)
    assert np.corrcoef(plain[inside], literal[inside])[0, 1] < 0.99


def luminance(rgb):
    return np.rint(rgb @ [0.299, 0.587, 0.114])


def test_contrast(picture, agreement):
    """The variance of the luminance in windows of 80 x 80 pixels of 900 rows, the background counted."""
    rgb, mask = picture
    side = round(80 * len(rgb) / 900)
    grey = luminance(rgb)
    mean = ndimage.uniform_filter(grey, side, mode="constant")
    literal = n(ndimage.uniform_filter(grey**2, side, mode="constant") - mean**2)
    agreement("r", correlation(printed(picture, "contrast"), smaller(smaller(literal)), mask))


def test_entropy(picture, agreement):
    """eq. 3.7 in 9 x 9 pixels behind a median filter, the background counted."""
    rgb, mask = picture
    grey = ndimage.median_filter(luminance(rgb).astype(np.uint8), 3, mode="nearest")

    def bits(window):
        counts = np.bincount(window.astype(np.uint8))
        shares = counts[counts > 0] / len(window)
        return -(shares * np.log2(shares)).sum()

    literal = n(ndimage.generic_filter(grey.astype(np.float64), bits, 9, mode="reflect"))
    agreement("r", correlation(printed(picture, "entropy"), smaller(smaller(literal)), mask))


def test_edge(picture, agreement):
    """The second derivatives of the picture smoothed by a Gaussian (T3.2)."""
    rgb, mask = picture
    sigma = max(2 * len(rgb) / 900, 0.7)
    literal = n(np.abs(ndimage.laplace(ndimage.gaussian_filter(luminance(rgb), sigma, mode="nearest"), mode="nearest")))
    agreement("r", correlation(printed(picture, "edge"), smaller(smaller(literal)), mask))


def test_average(agreement):
    """eq. 3.8: the sum of the maps over their number, for i = {I, O, RG, DKL, Sym, Con, Ent} and curvature."""
    seven = {"intensity", "orientation", "color", "dkl", "symmetry", "contrast", "entropy"}
    assert set(COMBINATIONS["VisAttAll"]) - seven == {"curvature"}  # T3.2.2 lists it, eq. 3.8 does not
    maps = {name: np.random.default_rng(k).random((20, 30)) for k, name in enumerate(COMBINATIONS["VisAttAll"])}
    agreement("difference", np.abs(fuse(maps) - sum(maps.values()) / len(maps)).max())


def test_weighted_average(agreement):
    """eq. 3.9: the weighted sum of nine maps over the sum of their weights."""
    names = [*COMBINATIONS["VisAttAll"], "edge"]
    maps = {name: np.random.default_rng(k).random((20, 30)) for k, name in enumerate(names)}
    weights = {name: 0.1 + k / 9 for k, name in enumerate(names)}
    literal = sum(weights[name] * maps[name] for name in names) / sum(weights.values())
    agreement("difference", np.abs(fuse(maps, weights) - literal).max())


def test_our_formulas(dromedary, agreement):
    """Nine maps of a dromedary by our own formulas, background filled, beside the printed ones: the least likeness."""
    view = render(dromedary, Viewpoint(90, 0), (450, 600), renderer="raster")
    ours = conspicuity(dromedary, view)
    letter = conspicuity(dromedary, view, filled=False, formulas="printed")
    inside = mask_at_size(view.mask, ours["intensity"].shape)
    likeness = [np.corrcoef(ours[name][inside], letter[name][inside])[0, 1] for name in ours if letter[name].any()]
    assert len(likeness) == 9
    agreement("r", float(min(likeness)))
