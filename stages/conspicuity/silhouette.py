"""How much of a map lies along the silhouette: the check that the background does not affect the maps."""

import cv2
import numpy as np

BAND = 12 / 900  # of the image's rows: 12 pixels in the thesis's 1200 x 900


def silhouette_share(values: np.ndarray, mask: np.ndarray) -> float:
    """The share of a map's sum in a band along the silhouette, over the band's share of the object's area.

    1: in proportion to the area; well above 1: the map responds to the silhouette. values (h', w') f4, a map of
    conspicuity(); mask (h, w) boolean of the view, of the same aspect ratio. NaN for a map of zeros.
    """
    padded = cv2.copyMakeBorder(mask.astype(np.uint8), 1, 1, 1, 1, cv2.BORDER_CONSTANT, value=0)
    inward = cv2.distanceTransform(padded, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)[1:-1, 1:-1]
    band = (inward > 0) & (inward <= BAND * len(mask))
    size = values.shape[::-1]
    share = cv2.resize(band.astype(np.float32), size, interpolation=cv2.INTER_AREA)
    object_share = cv2.resize(mask.astype(np.float32), size, interpolation=cv2.INTER_AREA)
    total = float(values.sum())
    if total <= 0:
        return float("nan")
    within = np.divide(share, object_share, out=np.zeros_like(share), where=object_share > 0)
    return float((values * within).sum() / total) / float(band.sum() / mask.sum())
