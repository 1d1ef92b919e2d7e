"""Errors of the pictures of a simplified mesh (T3.1.4, T3.2.9.2)."""

from collections.abc import Sequence
from typing import NamedTuple

import cv2
import numpy as np

from stages.kit import Mesh, Viewpoint
from stages.kit.similarity import WINDOW, local_moments
from stages.views import TWELVE, render

from .laplacian import band_distance, laplacian_pyramid
from .normalised_laplacian import normalise
from .similarity import ssim_error

LUMA = np.array([[0.299, 0.587, 0.114]])  # ITU-R BT.601


class Analysis(NamedTuple):
    """Of one picture: the bands of its pyramid before and after gain control, and its local moments."""

    bands: list[np.ndarray]
    normalised: list[np.ndarray]
    moments: tuple[np.ndarray, np.ndarray]


def perceptual(
    reference: Mesh, mesh: Mesh, viewpoints: Sequence[Viewpoint] = TWELVE, size: tuple[int, int] = (225, 300),
    renderer: str = "raster",
) -> dict[str, float]:  # fmt: skip
    """Errors of the pictures of a mesh against those of the reference, averaged over the viewpoints.

    dict(ssim, dlap, dnor), each 0 for equal pictures: 1 minus the structural similarity (T [63], see `similarity`), and
    the distances in the Laplacian and in the normalised Laplacian domain (T [225], see `laplacian` and
    `normalised_laplacian`). All are over the whole pictures, as in the thesis: the empty background counts as
    equal, so that a value is also a share of the picture. At a size below the thesis's 900 x 1200 the window of 11
    pixels covers more of the object: at 225 x 300 four meshes had 0.7 to 1.5 times the ssim of the full size. Compare
    values of one size only.

    Raises ValueError for meshes that exceed the frame (see stages.meshes.normalise), no viewpoint, a size below 11, or
    a mesh without faces.
    """
    if not (len(reference.faces) and len(mesh.faces)):
        raise ValueError("a mesh without faces has no picture to compare")
    before, after = (take_pictures(each, viewpoints, size, renderer) for each in (reference, mesh))
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
    """What the errors need of each of pictures (views, rows, columns) beside itself."""
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
    errors = np.mean([_errors(*each) for each in triples], axis=0)
    return dict(zip(("ssim", "dlap", "dnor"), errors.tolist(), strict=True))


def _errors(reference, picture, known):
    bands, normalised = _pyramids(picture)
    ssim = ssim_error(reference, picture, known.moments)
    return ssim, band_distance(known.bands, bands), band_distance(known.normalised, normalised)


def _pyramids(picture):
    bands = laplacian_pyramid(picture)
    return bands, normalise(bands)
