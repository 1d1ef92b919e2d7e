"""Grasps by a Schunk hand with two pressure arrays on each of three fingers, over time: as BiGS, with more cells.

Data: Drimus, Kootstra, Bilberg, Kragic, Design of a flexible tactile sensor for classification of rigid and deformable
objects, Robotics and Autonomous Systems 62(1), 2014; in the form that Madry, Bo, Kragic, Fox, ST-HMP: unsupervised
spatio-temporal feature learning for tactile data, ICRA 2014, publish with their code (GitHub: mmadry/st-hmp).
Layout: `OBJECT/grasp-NUMBER.mat` with TS, six arrays (rows, 6, samples): the proximal (14 rows) and the distal one (13
rows) of each finger in turn.
"""

from pathlib import Path
from typing import Any

import cv2
import numpy as np

from stages.classification.recorded import open_root
from stages.meshes.mat import read_mat

from .series import as_grey, colour_image, strongest_instant
from .touches import Recorded

LAYOUT = "the grasps of st-hmp: OBJECT/grasp-NUMBER.mat, in each TS, six arrays of 14 or 13 x 6 cells over time"
FINGERS = 3
SAMPLES = 294  # of the 324 or more of each grasp: 27 x 6 cells x 294 are 126 x 126 x 3 numbers
BIGS = (7, 3)  # cells of BiGS's fingertip


def read_schunk(path: str | Path, cells: tuple[int, int] | None = None) -> Recorded:
    """The Recorded of one picture per finger of a grasp; groups: the grasp, OBJECT/FILE.

    path: the zip file, or a folder with the same in it. Without `cells`, 126 x 126 x 3: the first 294 readings of a
    finger's 27 x 6 cells minus the first, reshaped as BiGS is. With cells (rows, columns): the strongest instant alone,
    its cells averaged to so many. Raises ValueError that names the file and the remedy.
    """
    root, series, labels, groups = open_root(path, LAYOUT), [], [], []
    names = sorted(one.name for one in root.iterdir() if one.is_dir() and not one.name.startswith("_"))
    for label, name in enumerate(names):
        for grasp in sorted((root / name).iterdir(), key=lambda file: file.name):
            series += fingers(grasp)
            labels += [label] * FINGERS
            groups += [f"{name}/{grasp.name}"] * FINGERS
    if not series:
        raise ValueError(f"{path} holds no grasp; expected is {LAYOUT}")
    grey = as_grey(np.stack(series))
    pictures = [colour_image(one) if cells is None else fewer_cells(strongest_instant(one), cells) for one in grey]
    return Recorded(np.stack(pictures), np.array(labels), names, np.array(groups))


def fingers(file: Any) -> list[np.ndarray]:
    """(27, 6, 294) f4 of each finger, the distal array above the proximal: how its readings differ from the first."""
    try:
        (cells,) = read_mat(file.read_bytes(), ["TS"])
        arrays = [np.asarray(one, np.float32) for one in cells.ravel()]
        pairs = [np.concatenate([distal, proximal]) for proximal, distal in zip(arrays[::2], arrays[1::2], strict=True)]
        found = [(one - one[..., :1])[..., :SAMPLES] for one in pairs]
    except (ValueError, TypeError, IndexError) as error:
        raise ValueError(f"{file} is not such a grasp ({error}); expected is {LAYOUT}") from None
    shapes = [one.shape for one in found]
    if shapes != [(27, 6, SAMPLES)] * FINGERS or not np.isfinite(found).all():
        raise ValueError(f"{file}: fingers of {shapes}, not three of {(27, 6, SAMPLES)}, all finite; remove it")
    return found


def fewer_cells(image: np.ndarray, cells: tuple[int, int]) -> np.ndarray:
    """An image averaged to rows x columns cells."""
    return cv2.resize(image, cells[::-1], interpolation=cv2.INTER_AREA)
