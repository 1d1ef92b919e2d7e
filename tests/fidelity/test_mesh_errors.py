"""T3.1.4 and T3.2.9: the errors of a simplified mesh."""

import numpy as np
import trimesh
from scipy import ndimage
from skimage.metrics import structural_similarity

from haptic_glance.lod.errors import metro
from haptic_glance.lod.perceptual import CONSTANTS, NEIGHBOURS, band_distance, laplacian_pyramid, normalise, ssim_error
from haptic_glance.mesh.mesh import Mesh

BINOMIAL = np.array([1, 4, 6, 4, 1]) / 16


def test_metro(agreement):
    """Mean, rms and largest distance of points on either surface to the other one, the larger of both, over the
    diagonal."""
    fine, coarse = (trimesh.creation.icosphere(subdivisions=k, radius=0.5) for k in (4, 2))
    fine.vertices *= 1 + 0.1 * np.sin(7 * fine.vertices[:, :1])
    sides = []
    for first, other in ((fine, coarse), (coarse, fine)):
        points, _ = trimesh.sample.sample_surface(first, 20000, seed=5)
        gaps, corner_gaps = (trimesh.proximity.closest_point(other, part)[1] for part in (points, first.vertices))
        sides.append([gaps.mean(), np.sqrt((gaps**2).mean()), max(gaps.max(), corner_gaps.max())])
    literal = np.max(sides, axis=0) / np.linalg.norm(np.ptp(fine.vertices, axis=0))
    errors = metro(Mesh(fine.vertices, fine.faces), Mesh(coarse.vertices, coarse.faces), samples=20000)
    agreement("difference", np.abs(literal - [errors[name] for name in ("mean", "rms", "max")]).max())


def pictures():
    """Two pictures of a body, on black as the thesis's are."""
    generator, body = np.random.default_rng(0), np.zeros((256, 320))
    body[90:160, 120:220] = 1
    first = ndimage.gaussian_filter(generator.random(body.shape), 3) * 255 * body
    second = np.clip(first + ndimage.gaussian_filter(generator.normal(size=body.shape), 2) * 20, 0, 255) * body
    return np.rint(first).astype(np.float32), np.rint(second).astype(np.float32)


def test_ssim(agreement):
    """T3.2.9.2: one minus the structural similarity."""
    first, second = pictures()
    how = {"gaussian_weights": True, "sigma": 1.5, "use_sample_covariance": False, "data_range": 255}
    agreement("difference", abs(ssim_error(first, second) - (1 - structural_similarity(first, second, **how))))


def blurred(image, scale=1.0):
    for axis in (0, 1):
        image = ndimage.convolve1d(image, BINOMIAL * scale, axis=axis, mode="mirror")
    return image


def bands(picture):
    rest, levels = picture / 255.0, []
    for _ in range(5):
        small = blurred(rest)[::2, ::2]
        doubled = np.zeros((2 * small.shape[0], 2 * small.shape[1]))
        doubled[::2, ::2] = small
        levels.append(rest - blurred(doubled, 2)[: rest.shape[0], : rest.shape[1]])
        rest = small
    return [*levels, rest]


def distance(first, second):
    return np.mean([np.sqrt(((a - b) ** 2).mean()) for a, b in zip(first, second, strict=True)])


def test_laplacian(agreement):
    """T [225]: six bands of the Laplacian pyramid, the root mean square of each, averaged; relative to the error."""
    first, second = pictures()
    literal = distance(bands(first), bands(second))
    error = band_distance(laplacian_pyramid(first), laplacian_pyramid(second))
    agreement("difference", abs(error - literal))


def controlled(band, weights, constant):
    up, left, right, down, beyond = weights
    kernel = np.zeros((5, 5))
    kernel[1, 2], kernel[2, 1], kernel[2, 3], kernel[3, 2], kernel[2, 4] = up, left, right, down, beyond
    return band / (constant + ndimage.correlate(np.abs(band), kernel, mode="constant"))


def test_normalised_laplacian(agreement):
    """T [225]: each value over a constant and a weighted sum of its neighbours' sizes."""
    sides = []
    for picture in pictures():
        triples = zip(bands(picture), NEIGHBOURS, CONSTANTS, strict=True)
        sides.append([controlled(*parts) for parts in triples])
    first, second = (normalise(laplacian_pyramid(picture)) for picture in pictures())
    agreement("difference", abs(band_distance(first, second) - distance(*sides)))
