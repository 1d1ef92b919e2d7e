"""BiGS (T5.1.4): a Barrett hand with three BioTac fingertips grasps a box, a ball and a cylinder.

Paper: Chebotar, Hausman, Su, Molchanov, Kroemer, Sukhatme, Schaal, BiGS: BioTac grasp stability dataset, ICRA 2016
workshop on grasping and manipulation datasets (T [104]); each finger has 19 electrodes, sampled at 100 Hz.
Layout: the layout of the published files is not known here. So a plain layout is read:
`OBJECT/success/GRASP/FINGER.csv`, OBJECT one of box, ball, cylinder, GRASP any name, three fingers, each a table
without a header, one sample per line, with the readings of electrodes 1 to 19 in columns separated by commas. Other
folders than `success`, such as `failure`, are ignored, as in the thesis.
To get it: download the data set from the authors' page named in the paper, and write the electrode readings of each
finger of each grasp into such a table.
"""

from pathlib import Path

import numpy as np

from .series import as_grey, colour_image, strongest_instant
from .touches import Recorded, existing_folder

LAYOUT = "BiGS: OBJECT/success/GRASP/FINGER.csv, OBJECT box, ball, cylinder, three fingers, 19 columns, 700 lines"
OBJECTS = ("ball", "box", "cylinder")
FINGERS, ELECTRODES = 3, 19
SAMPLES = 700  # 7 x 3 cells x 700 samples are 70 x 70 x 3 numbers
GRID = [  # electrodes from above, tip first, in columns by their position y = +, 0, - on the finger; 0: none
    [9, 7, 8], [11, 10, 1], [12, 17, 2], [13, 0, 3], [14, 0, 4], [15, 18, 5], [16, 19, 6],
]  # fmt: skip


def read_bigs(path: str | Path, instant: bool = False) -> Recorded:
    """The Recorded of BiGS: one 70 x 70 x 3 image per finger of a successful grasp; groups: the grasp, OBJECT/GRASP.

    A finger's readings minus its first are arranged in 7 x 3 cells, cut to the first 700 samples, and reshaped.
    instant: 7 x 3 of one instant instead, on which the thesis's networks failed (T5.1.4, T5.4). Raises ValueError that
    names what is missing.
    """
    root, series, labels, groups = existing_folder(path, LAYOUT), [], [], []
    for label, name in enumerate(OBJECTS):
        for grasp in sorted(existing_folder(root / name / "success", LAYOUT).iterdir()):
            fingers = sorted(grasp.glob("*.csv"))
            if len(fingers) != FINGERS:
                raise ValueError(f"{grasp} holds {len(fingers)} tables, {FINGERS} are needed; expected is {LAYOUT}")
            series += [_changes(file) for file in fingers]
            labels += [label] * FINGERS
            groups += [f"{name}/{grasp.name}"] * FINGERS
    if not series:
        raise ValueError(f"{root} holds no grasp; expected is {LAYOUT}")
    picture = strongest_instant if instant else colour_image
    images = np.stack([picture(one) for one in as_grey(np.stack(series))])
    return Recorded(images, np.array(labels), list(OBJECTS), np.array(groups))


def electrode_grid(readings: np.ndarray) -> np.ndarray:
    """(n, 7, 3): readings (n, 19) of the electrodes as a tactile image of n instants (T figure 5.2b).

    Follows the electrodes' positions in the manufacturer's manual: five in the middle column, seven on each side. The
    two cells of the middle column without an electrode get the mean of their neighbours on both sides. The thesis names
    the 7 x 3 image but not the order of its cells, which is chosen here.
    """
    grid = np.array(GRID)
    image = readings[:, np.maximum(grid - 1, 0)].astype(np.float32)
    for row in np.flatnonzero(grid[:, 1] == 0):
        image[:, row, 1] = image[:, row, [0, 2]].mean(axis=1)
    return image


def _changes(file):
    """(7, 3, 700) f4: how a finger's readings differ from its first."""
    try:
        readings = np.loadtxt(file, delimiter=",", ndmin=2)
    except ValueError as error:
        raise ValueError(f"{file} is not a table of numbers ({error}); expected is {LAYOUT}") from None
    if readings.shape[1] != ELECTRODES or len(readings) < SAMPLES or not np.isfinite(readings).all():
        lines, columns = readings.shape
        raise ValueError(f"{file}: {lines} lines of {columns} numbers, all finite; expected is {LAYOUT}, or remove it")
    return np.moveaxis(electrode_grid(readings[:SAMPLES] - readings[0]), 0, 2)
