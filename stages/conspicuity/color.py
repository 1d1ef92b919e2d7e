"""Color: red against green and blue against yellow."""

import cv2
import numpy as np

from stages.kit import Mesh
from stages.views import View

from .cropped_view import cropped_view
from .operators import OUTPUT_SCALE, centre_surround, normalise, pyramid


def color(mesh: Mesh, view: View, filled: bool = True) -> np.ndarray:
    """The color conspicuity map (h / 16, w / 16) f4 in 0..1, T eq. 3.3 to 3.5, of a stages.views.View.

    T eq. 3.3 subtracts the surround's G - R from the centre's R - G, as Itti 1998 prints it. The text next to both
    formulas describes a cell that red in the centre and green in the surround excite, so that the sum is meant: as
    printed, a red dot on green would cancel out and uniform red would respond. Therefore RG(c, s) is
    |(R - G)(c) - (R - G)(s)| here, and BY likewise. Zero when no pixel has a hue.
    """
    image = cropped_view(view, filled)
    if image.empty or image.grey_only:
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
