"""Errors of the pictures of a simplified mesh (T3.1.4, T3.2.9.2): the normalised Laplacian pyramid and SSIM.

`laplacian` is the difference of two pictures without their local means: the root of the mean squared difference of
each of six bands, averaged over the bands, on a scale where white is 1. Coarse bands have the same weight as fine
ones, which have more pixels. The thesis's "predicted distance in Laplacian domain" is the second number that the
authors' own program gives, beside the normalised one (NLPD).

NLPD divides each value of the pyramid by a constant and a weighted sum of its neighbours' sizes before. This gain
control gives a difference on a dark or even background a higher weight than one among strong contrasts. Pixels beyond
the frame count as zero in the gain.

Source: Laparra, Balle, Berardino and Simoncelli, Perceptual image quality assessment using a normalized Laplacian
pyramid, Electronic Imaging 2016 (T [225]). The filter is the binomial of Burt and Adelson 1983, as in plenoptic 1.2.0
(Duong et al. 2023), whose scores the tests check; the authors' program takes 0.05, 0.25, 0.4, 0.25, 0.05, within 0.025
of it per tap. plenoptic's 1e-10 under the root is left out, so that equal pictures are at 0. The authors' program turns
the small asymmetric filters by 180 degrees where plenoptic does not.

A mesh that exceeds the picture is refused; `within_frame` scales meshes down together, for `haptic-glance simplify`.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from haptic_glance.base.lazy import cv2
from haptic_glance.base.similarity import WINDOW, local_moments, ssim_map
from haptic_glance.look.camera import DISTANCE, VIEW_ANGLE, Viewpoint
from haptic_glance.look.views import TWELVE, render
from haptic_glance.mesh.mesh import Mesh

LUMA = np.array([[0.299, 0.587, 0.114]])  # ITU-R BT.601
EDGE = WINDOW // 2  # pixels from the border within which SSIM's window is not whole


class Analysis(NamedTuple):
    """One picture: the bands of its pyramid before and after gain control, and its local moments."""

    bands: list[np.ndarray]
    normalised: list[np.ndarray]
    moments: tuple[np.ndarray, np.ndarray]


def perceptual(
    reference: Mesh, mesh: Mesh, viewpoints: Sequence[Viewpoint] = TWELVE, size: tuple[int, int] = (225, 300),
    renderer: str = "raster",
) -> dict[str, float]:  # fmt: skip
    """Errors of the pictures of a mesh against those of the reference, averaged over the viewpoints.

    Parameters
    ----------
    reference, mesh : Mesh or any input of `as_mesh`
        The meshes, normalised together.
    viewpoints : sequence of Viewpoint
        By default the twelve of T figure 3.2.
    size : tuple of 2 ints
        Rows and columns of the pictures, 11 or more. Compare values of one size only: at 225 x 300 four meshes had 0.7
        to 1.5 times the `ssim` of the thesis's 900 x 1200, since the window of 11 pixels covers more of the object.
    renderer : str
        As of `render`.

    Returns
    -------
    dict of str to float
        `ssim`, 1 minus the structural similarity (T [63]), and `dlap` and `dnor`, the distances in the Laplacian and in
        the normalised Laplacian domain (T [225]); each is 0 for equal pictures. All are over the whole pictures, as in
        the thesis: the empty background counts as equal, so that a value is also a share of the picture. `ssim` leaves
        out the border of 5 pixels, where its window is not whole.

    Raises
    ------
    ValueError
        For meshes that exceed the frame (`normalise` scales them), no viewpoint, a size below 11, or a mesh without
        faces.

    References
    ----------
    Wang, Bovik, Sheikh and Simoncelli, Image quality assessment: from error visibility to structural similarity, IEEE
    Transactions on Image Processing 13(4), 2004.

    Examples
    --------
    >>> import trimesh
    >>> from haptic_glance import normalise, perceptual
    >>> cube = normalise(trimesh.creation.box())
    >>> sorted(perceptual(cube, cube, size=(60, 80)).items())
    [('dlap', 0.0), ('dnor', 0.0), ('ssim', 0.0)]
    """
    if not (len(reference.faces) and len(mesh.faces)):
        raise ValueError("a mesh without faces has no picture to compare")
    before, after = (take_pictures(surface, viewpoints, size, renderer) for surface in (reference, mesh))
    return picture_errors(before, after)


def take_pictures(
    mesh: Mesh, viewpoints: Sequence[Viewpoint] = TWELVE, size: tuple[int, int] = (225, 300), renderer: str = "raster"
) -> np.ndarray:
    """(views, rows, columns) f8 luminance, 0 to 255, of a mesh; those of a reference serve many comparisons."""
    if len(viewpoints) == 0:
        raise ValueError("pictures need one viewpoint or more")
    if min(size) < WINDOW:
        raise ValueError(f"pictures of {tuple(size)} are smaller than the window of {WINDOW} pixels")
    pictures = np.empty((len(viewpoints), *size))
    for picture, viewpoint in zip(pictures, viewpoints, strict=True):
        cv2.transform(render(mesh, viewpoint, size, renderer=renderer).rgb.astype(np.float64), LUMA, picture)
    return pictures


def analyse(pictures: np.ndarray) -> list[Analysis]:
    """Analyses pictures (views, rows, columns) for the errors."""
    return [Analysis(*_pyramids(picture), local_moments(picture)) for picture in pictures]


def picture_errors(
    reference: np.ndarray, pictures: np.ndarray, analyses: Sequence[Analysis] | None = None
) -> dict[str, float]:
    """dict(ssim, dlap, dnor) of pictures (views, rows, columns) against the reference's, averaged over the views.

    analyses: analyse(reference), where the reference serves many comparisons.
    """
    if reference.shape != pictures.shape:
        raise ValueError(f"pictures of {pictures.shape} cannot be compared with the reference's {reference.shape}")
    triples = zip(reference, pictures, analyses or analyse(reference), strict=True)
    errors = np.mean([_errors(*triple) for triple in triples], axis=0)
    return dict(zip(("ssim", "dlap", "dnor"), errors.tolist(), strict=True))


def _errors(reference, picture, analysis):
    bands, normalised = _pyramids(picture)
    ssim = ssim_error(reference, picture, analysis.moments)
    return ssim, band_distance(analysis.bands, bands), band_distance(analysis.normalised, normalised)


def _pyramids(picture):
    bands = laplacian_pyramid(picture)
    return bands, normalise(bands)


SCALES = 6  # Laparra et al. 2016: five bands and the remaining small picture
WHITE = 255.0  # the measure is defined on 0 to 1


def laplacian_pyramid(picture: np.ndarray) -> list[np.ndarray]:
    """Six bands, fine to coarse, of a picture (rows, columns), 0 to 255; the last is a small picture."""
    bands, image = [], np.asarray(picture, dtype=np.float32) / np.float32(WHITE)
    for _ in range(SCALES - 1):
        small = cv2.pyrDown(image)
        bands.append(image - _enlarge(small, image.shape))
        image = small
    return [*bands, image]


def _enlarge(small, shape):
    """A picture twice as large, of `shape`; mirrored at the border, where OpenCV by itself repeats the last row."""
    padded = cv2.copyMakeBorder(small, 1, 1, 1, 1, cv2.BORDER_REFLECT_101)
    return cv2.pyrUp(padded)[2 : 2 + shape[0], 2 : 2 + shape[1]]


def band_distance(reference: Sequence[np.ndarray], bands: Sequence[np.ndarray]) -> float:
    """Root mean square over the pixels of a band, mean over the bands (Laparra et al. 2016)."""
    roots = [cv2.norm(a, b) / np.sqrt(a.size) for a, b in zip(reference, bands, strict=True)]
    return float(np.mean(roots))


# Weights of the neighbours (up, left, right, down; beyond right in the first band) in a pixel's gain, and the constants
# beside them, band by band: fitted by the authors to undistorted photographs; the table of their own program.
NEIGHBOURS = (
    (0.1011, 0.1493, 0.1460, 0.1015, 0.0072),
    (0.0757, 0.1986, 0.1846, 0.0837, 0.0),
    (0.0477, 0.2138, 0.2243, 0.0467, 0.0),
    (0.0, 0.2503, 0.2616, 0.0, 0.0),
    (0.0, 0.2598, 0.2552, 0.0, 0.0),
    (0.0, 0.2215, 0.0717, 0.0, 0.0),
)
CONSTANTS = (0.0248, 0.0185, 0.0179, 0.0191, 0.0220, 0.2782)


def normalise(bands: Sequence[np.ndarray]) -> list[np.ndarray]:
    """The six bands after gain control."""
    return [
        band / cv2.filter2D(np.abs(band), -1, kernel, delta=constant, borderType=cv2.BORDER_CONSTANT)
        for band, kernel, constant in zip(bands, KERNELS, CONSTANTS, strict=True)
    ]


def _kernel(up, left, right, down, beyond):
    kernel = np.zeros((5, 5))
    kernel[1, 2], kernel[2, 1], kernel[2, 3], kernel[3, 2], kernel[2, 4] = up, left, right, down, beyond
    return kernel


KERNELS = [_kernel(*weights) for weights in NEIGHBOURS]


def ssim_error(
    reference: np.ndarray, picture: np.ndarray, moments: tuple[np.ndarray, np.ndarray] | None = None
) -> float:
    """1 - SSIM of two pictures, averaged over the pixels whose window lies wholly in the picture.

    The border of 5 pixels is left out, as in scikit-image's structural_similarity and in MATLAB's ssim.

    Parameters
    ----------
    reference, picture : (rows, columns) f8
        Brightness, 0 to 255.
    moments : tuple of two (rows, columns) f8, optional
        haptic_glance.base.similarity.local_moments(reference), where the reference serves many comparisons.

    Returns
    -------
    float
        0 for equal pictures.

    Raises
    ------
    ValueError
        For a picture smaller than the window.
    """
    if min(reference.shape) < WINDOW:
        raise ValueError(f"a picture of {reference.shape} is smaller than the window of {WINDOW} pixels")
    top, bottom, left, right = _content_box(reference, picture)
    inside = slice(top, bottom), slice(left, right)
    cropped = None if moments is None else (moments[0][inside].copy(), moments[1][inside].copy())  # compiled for rows
    differences = 1 - ssim_map(reference[inside], picture[inside], cropped)
    rows, columns = reference.shape
    whole = differences[max(EDGE - top, 0) : rows - EDGE - top, max(EDGE - left, 0) : columns - EDGE - left]
    return float(whole.sum() / ((rows - 2 * EDGE) * (columns - 2 * EDGE)))


def _content_box(reference, picture):
    """(top, bottom, left, right) of the content of both pictures, outside of which they are equal: the same sum."""
    content = np.maximum(reference, picture) > 0
    left, top, width, height = cv2.boundingRect(content.view(np.uint8))
    return max(top - WINDOW, 0), top + height + WINDOW, max(left - WINDOW, 0), left + width + WINDOW


FITS = 0.999 * DISTANCE * np.tan(np.radians(VIEW_ANGLE) / 2)  # radius that fills the rows, less 0.1 % for rounding


def within_frame(meshes: Sequence[Mesh]) -> tuple[list[Mesh], float]:
    """(list of Meshes, scale): all scaled about the origin by one factor, at most 1, so that no picture crops any.

    With few faces the vertices lie far outside a round surface, since the facets cut through it. At a scale of 1 the
    meshes are returned unchanged; vertices in no face do not count.
    """
    radius = max(np.linalg.norm(mesh.vertices[mesh.used], axis=1).max(initial=0.0) for mesh in meshes)
    if radius <= FITS:
        return list(meshes), 1.0
    scale = float(FITS / radius)
    return [replace(mesh, vertices=scale * mesh.vertices) for mesh in meshes], scale
