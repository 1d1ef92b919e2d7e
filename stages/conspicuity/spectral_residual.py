"""Spectral residual: what of the image's spectrum is not as in every other image. A rival, on the view as rendered."""

import cv2

from .operators import reduce
from .picture import picture

SCALE = 2  # of the map handed on, a quarter of the view


def spectral_residual(mesh, view, filled=True):
    """The spectral residual map (h / 4, w / 4) f4 in 0..1 of a stages.views.View, by OpenCV.

    Hou and Zhang, Saliency detection: a spectral residual approach, CVPR 2007. The image stays as rendered whatever
    `filled` says: a rival gets what its authors would give it. Zero for an image of one grey value, of which OpenCV
    makes noise near 1.
    """
    image = picture(view, False)
    grey = cv2.cvtColor(view.rgb, cv2.COLOR_RGB2GRAY)
    if image.empty or grey.min() == grey.max():
        return image.nothing()
    return reduce(cv2.saliency.StaticSaliencySpectralResidual_create().computeSaliency(grey)[1], 0, SCALE)
