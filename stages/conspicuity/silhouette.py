"""How much of a map lies along the silhouette: the check that the background does not affect the maps."""

import cv2
import numpy as np

from haptic_glance.base.weak_cache import weak_cache

BAND = 12 / 900  # of the image's rows: 12 pixels in the thesis's 1200 x 900


def silhouette_share(values: np.ndarray, mask: np.ndarray) -> float:
    """The share of a map's sum in a band along the silhouette, over the band's share of the object's area.

    1: in proportion to the area; well above 1: the map responds to the silhouette. values (h', w') f4, a map of
    conspicuity(); mask (h, w) boolean of the view, of the same aspect ratio. NaN for a map of zeros, or a view so
    small that no pixel lies in the band.
    """
    total = float(values.sum())
    within, share = _band(mask, values.shape) if total > 0 and mask.any() else (values, 0)
    if share == 0:
        return float("nan")
    return float((values * within).sum() / total) / share


@weak_cache  # the channels of a view share its mask
def _band(mask, shape):
    """((h', w') the share of each pixel's object that lies in the band, the band's share of the object's area)."""
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    box = np.s_[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
    padded = cv2.copyMakeBorder(mask[box].astype(np.uint8), 1, 1, 1, 1, cv2.BORDER_CONSTANT, value=0)
    inward = cv2.distanceTransform(padded, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)[1:-1, 1:-1]
    band = np.zeros(mask.shape, dtype=bool)
    band[box] = (inward > 0) & (inward <= BAND * len(mask))
    parts = (cv2.resize(each.astype(np.float32), shape[::-1], interpolation=cv2.INTER_AREA) for each in (band, mask))
    along, inside = parts
    within = np.divide(along, inside, out=np.zeros_like(along), where=inside > 0)
    return within, float(band.sum() / mask.sum())
