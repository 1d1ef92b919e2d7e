"""Intensity: centre-surround differences of brightness, light on dark and dark on light."""

import numpy as np

from stages.kit import Mesh
from stages.views import View

from .cropped_view import cropped_view
from .operators import OUTPUT_SCALE, centre_surround, normalise


def intensity(mesh: Mesh, view: View, filled: bool = True) -> np.ndarray:
    """The intensity conspicuity map (h / 16, w / 16) f4 in 0..1, T eq. 3.1, of a stages.views.View."""
    image = cropped_view(view, filled)
    if image.empty:
        return image.zero_map()
    summed = centre_surround(image.intensity_pyramid, image.cover)
    return image.place_in_view(normalise(summed, image.cover[OUTPUT_SCALE]), OUTPUT_SCALE)
