"""Channels of brightness and colour: intensity, opponent colours, and DKL.

Intensity and colour are centre-surround differences. DKL has three post-receptoral mechanisms: luminance, L - M and
S - (L + M).
"""

import numpy as np

from haptic_glance.base.lazy import cv2
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.srgb import decoded

from ..views import View
from .cropped_view import cropped_view
from .operators import OUTPUT_SCALE, centre_surround, normalise, pyramid, reduce


def intensity(mesh: Mesh, view: View, filled: bool = True) -> np.ndarray:
    """The intensity conspicuity map (h / 16, w / 16) f4 in 0..1, T eq. 3.1, of a haptic_glance.look.views.View."""
    image = cropped_view(view, filled)
    summed = centre_surround(image.intensity_pyramid, image.cover)
    return image.place_in_view(normalise(summed, image.cover[OUTPUT_SCALE]), OUTPUT_SCALE)


def color(mesh: Mesh, view: View, filled: bool = True) -> np.ndarray:
    """The color conspicuity map (h / 16, w / 16) f4 in 0..1, T eq. 3.3 to 3.5, of a haptic_glance.look.views.View.

    T eq. 3.3 subtracts the surround's G - R from the centre's R - G, as Itti 1998 prints it. The text next to both
    formulas describes a cell that red in the centre and green in the surround excite, so that the sum is meant: as
    printed, a red dot on green would cancel out and uniform red would respond. Therefore RG(c, s) is
    |(R - G)(c) - (R - G)(s)| here, and BY likewise. Zero when no pixel has a hue.
    """
    image = cropped_view(view, filled)
    if image.grey_only:
        return image.zero_map()
    summed = np.sum([centre_surround(pyramid(plane), image.cover) for plane in opponency(image.rgb)], axis=0)
    return image.place_in_view(normalise(summed, image.cover[OUTPUT_SCALE]), OUTPUT_SCALE)


def opponency(rgb: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(R - G, B - Y), each (h, w) f4 in -1..1, of rgb (h, w, 3) u1: differences of T3.1.1's broadly tuned channels.

    Negative responses are set to zero, as in Itti 1998, section 2.1.
    """
    r, g, b = cv2.split(rgb.astype(np.float32) / np.float32(255))
    red = np.maximum(r - (g + b) / 2, 0)
    green = np.maximum(g - (r + b) / 2, 0)
    blue = np.maximum(b - (r + g) / 2, 0)
    yellow = np.maximum((r + g) / 2 - cv2.absdiff(r, g) / 2 - b, 0)
    return red - green, blue - yellow


# Linear RGB of ITU-R BT.709 (the primaries of sRGB) to L, M, S: Smith and Pokorny's cone fundamentals, as in Vienot,
# Brettel and Mollon, Digital video colourmaps for checking the legibility of displays by dichromats, Color Research
# and Application 24(4), 1999, equation 4. White has L + M = 100.
RGB_TO_LMS = np.array([[17.8824, 43.5161, 4.11935], [3.45565, 27.1554, 3.86714], [0.0299566, 0.184309, 1.46709]])
LINEAR = decoded(np.arange(256) / 255)
FIRST = 2  # the first scale that is used; the matrix is applied there, since it commutes with linear filters


def dkl(mesh: Mesh, view: View, filled: bool = True) -> np.ndarray:
    """The DKL conspicuity map (h / 16, w / 16) f4 in 0..1, T eq. 3.6, of a haptic_glance.look.views.View.

    The axes are those of Derrington, Krauskopf and Lennie, J. Physiology 357, 1984 (T [206]); see `mechanisms`. The
    look-up table of T decodes the 256 levels of sRGB.
    """
    image = cropped_view(view, filled)
    if image.grey_only:  # grey lies on the luminance axis
        planes = [reduce(LINEAR.astype(np.float32)[image.luminance], 0, FIRST)]
    else:
        planes = cv2.split(mechanisms(reduce(LINEAR.astype(np.float32)[image.rgb], 0, FIRST)))
    pyramids = [pyramid(np.ascontiguousarray(plane), FIRST) for plane in planes]
    summed = np.sum([centre_surround(levels, image.cover) for levels in pyramids], axis=0)
    return image.place_in_view(normalise(summed, image.cover[OUTPUT_SCALE]), OUTPUT_SCALE)


def mechanisms(linear: np.ndarray) -> np.ndarray:
    """(h, w, 3) f4: R_Lum, R_L-M, R_S-Lum of linear RGB (h, w, 3) f4 in 0..1.

    R_Lum = L + M over that of white. The other two are differences weighted so that they vanish on every grey, in units
    of L + M and S of white (Brainard, Cone contrast and opponent modulation color spaces, 1996).
    """
    return cv2.transform(linear, MECHANISMS)


def _mechanisms():
    long, medium, short = RGB_TO_LMS
    lum = long + medium
    white = RGB_TO_LMS.sum(axis=1)
    red_green = (long - white[0] / white[1] * medium) / lum.sum()
    blue_yellow = short / white[2] - lum / lum.sum()
    return np.stack([lum / lum.sum(), red_green, blue_yellow])


MECHANISMS = _mechanisms()
