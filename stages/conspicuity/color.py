"""Color: red against green and blue against yellow."""

import cv2
import numpy as np

from .operators import COMMON, centre_surround, normalise, pyramid
from .picture import picture


def color(mesh, view, filled=True):
    """The color conspicuity map (h / 16, w / 16) f4 in 0..1, T eq. 3.3 to 3.5, of a stages.views.View.

    T eq. 3.3 subtracts the surround's G - R from the centre's R - G. A cell that red in the centre and green around it
    both excite has to add it (the text beside the formula, and beside the same slip in Itti 1998, describes that
    cell): as printed, a red dot on green would cancel out and plain red would respond. So RG(c, s) is
    |(R - G)(c) - (R - G)(s)| here, and BY likewise. Zero where no pixel has a hue.
    """
    image = picture(view, filled)
    if image.empty or image.grey_only:
        return image.nothing()
    summed = sum(centre_surround(pyramid(plane), image.cover) for plane in opponency(image.rgb))
    return image.whole(normalise(summed, image.cover[COMMON]), COMMON)


def opponency(rgb):
    """(R - G, B - Y), each (h, w) f4 in -1..1, of rgb (h, w, 3) u1: differences of T3.1.1's broadly tuned channels.

    Negative responses are set to zero, as in Itti 1998, section 2.1.
    """
    r, g, b = cv2.split(rgb.astype(np.float32) / np.float32(255))
    red = np.maximum(r - (g + b) / 2, 0)
    green = np.maximum(g - (r + b) / 2, 0)
    blue = np.maximum(b - (r + g) / 2, 0)
    yellow = np.maximum((r + g) / 2 - cv2.absdiff(r, g) / 2 - b, 0)
    return red - green, blue - yellow
