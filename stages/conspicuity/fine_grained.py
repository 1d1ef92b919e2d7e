"""Fine-grained saliency: centre-surround at full resolution, from integral images. A rival, on the view as rendered."""

import cv2

from .operators import reduce
from .picture import picture

SCALE = 2  # of the map handed on, a quarter of the view


def fine_grained(mesh, view, filled=True):
    """The fine-grained saliency map (h / 4, w / 4) f4 in 0..1 of a stages.views.View, by OpenCV.

    Montabone and Soto, Human detection using a mobile platform and novel features derived from a visual saliency
    mechanism, Image and Vision Computing 28(3), 2010. The image stays as rendered whatever `filled` says: a rival gets
    what its authors would give it.
    """
    image = picture(view, False)
    if image.empty:
        return image.nothing()
    grey = cv2.cvtColor(view.rgb, cv2.COLOR_RGB2GRAY)
    return reduce(cv2.saliency.StaticSaliencyFineGrained_create().computeSaliency(grey)[1], 0, SCALE)
