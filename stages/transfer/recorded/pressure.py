"""Real pressure images (28 x 50 cells) as images for networks."""

import numpy as np

from .touches import Recorded


def pressure_images(touches):
    """The Recorded of {class: (k, rows, columns) in 0..1}, what stages.classification's read_pressure_images gives.

    Gandarias, Garcia-Cerezo, Gomez-de-Gabriel, IEEE Sensors Journal 19(16), 2019: 22 classes, 50 touches each. groups
    is None: which touches were made in one go is not said; neighbouring numbers are alike, so runs of them can be held
    out.
    """
    return Recorded(
        images=np.round(255 * np.concatenate(list(touches.values()))).astype(np.uint8),
        labels=np.repeat(np.arange(len(touches)), [len(images) for images in touches.values()]),
        classes=list(touches),
        groups=None,
    )
