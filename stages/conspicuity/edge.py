"""Edge: the Laplacian of a Gaussian."""

import cv2
import numpy as np

from stages.kit import Mesh
from stages.views import View

from .cropped_view import cropped_view
from .operators import OUTPUT_SCALE, normalise, reduce

SIGMA = 2.0 / 900  # of the image's rows: 2 pixels in the thesis's 1200 x 900, wide enough to smooth the steps of 8 bits


def edge(mesh: Mesh, view: View, filled: bool = True) -> np.ndarray:
    """The edge conspicuity map (h / 16, w / 16) f4 in 0..1, N of |LoG| (T3.2), of a stages.views.View."""
    image = cropped_view(view, filled)
    if image.empty:
        return image.zero_map()
    sigma = max(SIGMA * image.shape[0], 0.7)
    response = np.abs(laplacian_of_gaussian(image.luminance, sigma))
    return image.place_in_view(normalise(reduce(response, 0), image.cover[OUTPUT_SCALE]), OUTPUT_SCALE)


def laplacian_of_gaussian(image: np.ndarray, sigma: float) -> np.ndarray:
    """(h, w) f4: sigma^2 times the Laplacian of the image (h, w) u1 in 0..1 blurred by sigma pixels.

    The factor makes the response to an edge the same at every sigma (Lindeberg 1998).
    """
    smooth = cv2.GaussianBlur(image.astype(np.float32), (0, 0), sigma, borderType=cv2.BORDER_REPLICATE)
    return cv2.Laplacian(smooth, cv2.CV_32F, borderType=cv2.BORDER_REPLICATE) * np.float32(sigma**2 / 255)
