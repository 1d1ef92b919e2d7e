"""How different a simplified mesh looks (T3.1.4, T3.2.9.2)."""

import numpy as np
from skimage.metrics import structural_similarity

from stages.views import TWELVE, render

LUMA = (0.299, 0.587, 0.114)  # ITU-R BT.601
WINDOW = 11  # pixels; Wang et al. 2004, with a Gaussian of sigma 1.5
SIGMA = 1.5


def perceptual(reference, mesh, viewpoints=TWELVE, size=(225, 300), renderer="raycast"):
    """Errors of the pictures of a mesh against those of the reference, averaged over the viewpoints: dict(ssim).

    ssim is 1 minus the structural similarity of the whole images (Wang et al. 2004, T [63]), as in the thesis: the
    empty background counts as alike, so that the value is also a share of the picture. At a size below the thesis's
    900 x 1200 the window of 11 pixels covers more of the object: at 225 x 300 four meshes measured 0.7 to 1.5 times the
    value of the full size. Compare values of one size only.

    Raises ValueError for meshes that leave the frame (see stages.meshes.normalise), no viewpoint, or a size below 11.
    """
    pictures = (take_pictures(each, viewpoints, size, renderer) for each in (reference, mesh))
    return picture_errors(*pictures)


def take_pictures(mesh, viewpoints=TWELVE, size=(225, 300), renderer="raycast"):
    """(views, rows, columns) f8 luminance, 0 to 255, of a mesh: make those of a reference once, compare many meshes."""
    if len(viewpoints) == 0:
        raise ValueError("pictures need one viewpoint or more")
    if min(size) < WINDOW:
        raise ValueError(f"pictures of {tuple(size)} are smaller than the window of {WINDOW} pixels")
    return np.stack([render(mesh, viewpoint, size, renderer=renderer).rgb @ np.array(LUMA) for viewpoint in viewpoints])


def picture_errors(reference, pictures):
    """dict(ssim) of pictures (views, rows, columns) against the reference's, averaged over the views."""
    if reference.shape != pictures.shape:
        raise ValueError(f"pictures of {pictures.shape} cannot be compared with the reference's {reference.shape}")
    return {name: float(np.mean([error(*pair) for pair in zip(reference, pictures, strict=True)]))
            for name, error in ERRORS.items()}  # fmt: skip


def ssim_error(reference, picture):
    """1 - SSIM of two images (rows, columns), 0 to 255, averaged over every pixel of the image."""
    inside = _both(reference, picture)
    if inside is None:
        return 0.0
    _, similarity = structural_similarity(
        reference[inside], picture[inside], win_size=WINDOW, gaussian_weights=True, sigma=SIGMA,
        use_sample_covariance=False, data_range=255, full=True,
    )  # fmt: skip
    return float((1 - similarity).sum() / reference.size)


def _both(reference, picture):
    """The box around what either image shows, so wide that both are alike outside: less work, the same sum."""
    seen = (reference > 0) | (picture > 0)
    if not seen.any():
        return None
    box = []
    for axis in (1, 0):
        where = np.flatnonzero(seen.any(axis=axis))
        box.append(slice(max(where[0] - WINDOW, 0), where[-1] + WINDOW + 1))
    return tuple(box)


ERRORS = {"ssim": ssim_error}
