"""Fine-grained saliency: centre-surround at full resolution, from integral images; a method for comparison."""

import cv2
import numpy as np

from stages.kit import Mesh
from stages.views import View

from .cropped_view import cropped_view
from .operators import reduce

SCALE = 2  # of the returned map, a quarter of the view


def fine_grained(mesh: Mesh, view: View, filled: bool = True) -> np.ndarray:
    """The fine-grained saliency map (h / 4, w / 4) f4 in 0..1 of a stages.views.View, by OpenCV.

    Montabone and Soto, Human detection using a mobile platform and novel features derived from a visual saliency
    mechanism, Image and Vision Computing 28(3), 2010. The image is used as rendered, whatever `filled`, as the
    authors of the method would use it.
    """
    image = cropped_view(view, False)
    if image.empty:
        return image.zero_map()
    grey = cv2.cvtColor(view.rgb, cv2.COLOR_RGB2GRAY)
    detector = cv2.saliency.StaticSaliencyFineGrained.create()
    return reduce(np.asarray(detector.computeSaliency(grey)[1]), 0, SCALE)
