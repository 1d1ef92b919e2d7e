"""Intensity: light on dark and dark on light."""

from .operators import COMMON, centre_surround, normalise
from .picture import picture


def intensity(mesh, view, filled=True):
    """The intensity conspicuity map (h / 16, w / 16) f4 in 0..1, T eq. 3.1, of a stages.views.View."""
    image = picture(view, filled)
    if image.empty:
        return image.nothing()
    summed = centre_surround(image.intensity_pyramid, image.cover)
    return image.whole(normalise(summed, image.cover[COMMON]), COMMON)
