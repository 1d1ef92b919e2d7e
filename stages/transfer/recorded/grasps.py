"""Grasps by BioTac SP fingertips as colour images, one finger per channel, similar to BiGS in T5.1.4.

BiGS has a series of 700 samples per finger, BTS3 one instant of 24 electrodes. So the electrodes are arranged as on the
finger and the gaps are filled. As there, three parts make the three colours.
"""

import numpy as np
from scipy.interpolate import griddata

from stages.classification.recorded import Grasps

from .touches import Recorded

CELLS = (12, 11)
# Where electrodes 1 to 24 of a BioTac SP lie in 12 rows and 11 columns: the distribution of 12 x 11 cells in the code
# with Zapata-Impata, Gil, Torres, Non-matrix tactile sensors: how can be exploited their local connectivity for
# predicting grasp stability?, IROS 2018 workshop RoboTac (biotac-sp-images: code/Dataset Processing).
ROWS = [0, 1, 4, 5, 6, 7, 8, 9, 10, 11, 0, 1, 4, 5, 6, 7, 8, 9, 10, 11, 2, 3, 3, 5]
COLUMNS = [1, 2, 0, 1, 3, 0, 1, 4, 2, 1, 9, 8, 10, 9, 7, 10, 9, 6, 8, 9, 5, 4, 6, 5]
DEVIATIONS = 3  # standard deviations of an electrode's readings within the range of grey values
TARGETS = ("objects", "slipped")


def grasp_images(grasps: Grasps, target: str = "objects") -> Recorded:
    """The Recorded of Grasps (stages.classification.recorded.read_grasps): images (k, 12, 11, 3), groups: the object.

    target: the classes, `objects` for the grasped objects or `slipped` for `slipped` and `stable`. Red is the first
    finger, green the middle one, blue the thumb. Each electrode's readings are scaled by their own mean and deviation
    over the grasps of objects that the authors do not keep for testing (no label is used); grey 128 is the mean. Values
    are interpolated linearly between the electrodes and are those of the nearest one outside. Sorted by object and
    palm, then as in the files, whatever the target.
    """
    if target not in TARGETS:
        raise ValueError(f"unknown target {target!r}, known: {', '.join(TARGETS)}")
    names = grasps.objects if target == "objects" else np.where(grasps.slipped, "slipped", "stable")
    order = np.lexsort((np.arange(len(names)), grasps.palms, grasps.objects))
    classes, labels = np.unique(names[order], return_inverse=True)
    images = electrode_images(_scaled(grasps)[order])
    return Recorded(images, labels.astype(np.int64), classes.tolist(), grasps.objects[order])


def electrode_images(values: np.ndarray) -> np.ndarray:
    """(k, 12, 11, 3) u1: values (k, 72) in -1..1 of three fingers, 24 electrodes each, as images; 0 is grey 128."""
    fingers = np.asarray(values).reshape(-1, 3, 24) @ _filling().T
    grey = np.round(128 + 127 * np.clip(fingers, -1, 1)).astype(np.uint8)
    return np.moveaxis(grey.reshape(-1, 3, *CELLS), 1, 3)


def _scaled(grasps):
    """(n, 72) in -1..1 for readings within DEVIATIONS."""
    training = grasps.electrodes[~grasps.test]
    spread = training.std(axis=0)
    return (grasps.electrodes - training.mean(axis=0)) / (DEVIATIONS * np.where(spread > 0, spread, 1))


def _filling():
    """(132, 24): the weight of each electrode in the value of a cell."""
    positions, cells = np.transpose([ROWS, COLUMNS]), np.indices(CELLS).reshape(2, -1).T
    linear, nearest = (griddata(positions, np.eye(len(positions)), cells, method=how) for how in ("linear", "nearest"))
    return np.where(np.isnan(linear), nearest, linear)
