"""Real pressure images (28 x 50 cells) as images for networks."""

from collections.abc import Mapping

import numpy as np

from .touches import Recorded


def pressure_images(touches: Mapping[str, np.ndarray]) -> Recorded:
    """The Recorded of {class: (k, rows, columns) in 0..1}, as stages.classification's read_pressure_images returns.

    Gandarias, Garcia-Cerezo, Gomez-de-Gabriel, IEEE Sensors Journal 19(16), 2019: 22 classes, 50 touches each. groups
    is None: the recordings that touches belong to are not published. Touches with neighbouring numbers are similar, so
    runs of them can be held out.
    """
    return Recorded(
        images=np.round(255 * np.concatenate(list(touches.values()))).astype(np.uint8),
        labels=np.repeat(np.arange(len(touches)), [len(images) for images in touches.values()]),
        classes=list(touches),
        groups=None,
    )
