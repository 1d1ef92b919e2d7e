"""Spectral residual: the deviation of the image's spectrum from the average one; a method for comparison."""

import cv2
import numpy as np

from stages.kit import Mesh
from stages.views import View

from .cropped_view import cropped_view
from .operators import reduce

SCALE = 2  # of the returned map, a quarter of the view


def spectral_residual(mesh: Mesh, view: View, filled: bool = True) -> np.ndarray:
    """The spectral residual map (h / 4, w / 4) f4 in 0..1 of a stages.views.View, by OpenCV.

    Hou and Zhang, Saliency detection: a spectral residual approach, CVPR 2007. The image is used as rendered,
    whatever `filled`, as the authors of the method would use it. Zero for an image of one grey value, for which OpenCV
    returns noise near 1.
    """
    image = cropped_view(view, False)
    grey = cv2.cvtColor(view.rgb, cv2.COLOR_RGB2GRAY)
    if image.empty or grey.min() == grey.max():
        return image.zero_map()
    detector = cv2.saliency.StaticSaliencySpectralResidual.create()
    return reduce(np.asarray(detector.computeSaliency(grey)[1]), 0, SCALE)
