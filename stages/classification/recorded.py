"""Readers of recorded touches: images of a real pressure array, and grasps of a hand with BioTac SP fingertips."""

import io
import re
import zipfile
import zlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from PIL import Image

FINGERS = ("ff", "mf", "th")  # first and middle finger, thumb
ELECTRODES = [f"{finger}_biotac_{k}" for finger in FINGERS for k in range(1, 25)]
PALMS = ("45", "down", "side")  # where the palm looks
PRESSURE = "the archive of pressure images: a folder Images with a folder of .jpg files for each class"
GRASPS = "the archive BTS3 v2: bts3v2_palm_45.csv, _down.csv, _side.csv, and the same three with _test"


@dataclass(frozen=True)
class Grasps:
    """Grasps by three fingers: electrodes (n, 72) f8, the fingers ff, mf, th one after the other, 24 each; objects
    (n,) names; palms (n,) of PALMS; slipped (n,) boolean: the object fell or moved when the hand was lifted; test (n,)
    boolean: of the objects that the authors keep for testing. In the order of the files, 45, down, side, test last.
    """

    electrodes: np.ndarray
    objects: np.ndarray
    palms: np.ndarray
    slipped: np.ndarray
    test: np.ndarray


def read_pressure_images(path):
    """{class: (k, rows, cols) f8 in 0..1}, 1 the highest pressure; classes sorted, touches by their number.

    path: the zip file, or a folder with the same in it. In the archive of Gandarias, Garcia-Cerezo and Gomez-de-Gabriel
    (IEEE Sensors Journal 19(16), 2019): 22 classes, 50 touches each, 28 x 50 cells.
    Raises ValueError, with the file and what to do, where this is something else.
    """
    root = _opened(path, PRESSURE)
    folders = sorted(_inside(root / "Images"), key=lambda folder: folder.name)
    found = {folder.name: _numbered(folder) for folder in folders if folder.is_dir()}
    if not found or not all(found.values()):
        empty = [name for name, files in found.items() if not files] or ["Images"]
        raise ValueError(f"{path}: no .jpg in {empty[0]}; wanted is {PRESSURE}")
    images = {name: [_image(file) for file in files] for name, files in found.items()}
    sizes = {image.shape for group in images.values() for image in group}
    if len(sizes) > 1:
        raise ValueError(f"{path}: images of several sizes, {sorted(sizes)}; all must come from one sensor")
    return {name: np.stack(group) for name, group in images.items()}


def read_grasps(path):
    """The Grasps in the six tables of BTS3 v2 (Garcia-Garcia and others, IJCNN 2019).

    path: the zip file, or a folder with the tables. Raises ValueError, with the file and what to do, where a table is
    absent, lacks a column, or holds something that is no number.
    """
    root, parts = _opened(path, GRASPS), []
    for test in (False, True):
        for palm in PALMS:
            table = _table(root / f"bts3v2_palm_{palm}{'_test' if test else ''}.csv", path)
            parts.append(table.assign(palm=palm, test=test))
    rows = pd.concat(parts, ignore_index=True)
    return Grasps(
        rows[ELECTRODES].to_numpy(dtype=np.float64), rows["object"].to_numpy(dtype=str),
        rows["palm"].to_numpy(dtype=str), rows["slipped"].to_numpy() == 1, rows["test"].to_numpy(dtype=bool),
    )  # fmt: skip


def _opened(path, wanted):
    """The root of a zip file or a folder."""
    path = Path(path)
    if path.is_dir():
        return path
    if not path.exists():
        raise ValueError(f"{path} is not there: give the path of {wanted}")
    try:
        return zipfile.Path(zipfile.ZipFile(path))
    except zipfile.BadZipFile:
        raise ValueError(f"{path} is no whole zip file: fetch it anew; wanted is {wanted}") from None


def _inside(folder):
    return list(folder.iterdir()) if folder.is_dir() else []


def _numbered(folder):
    """The .jpg files of a folder in the order of the numbers at the end of their names."""
    files = [file for file in _inside(folder) if file.name.endswith(".jpg")]
    return sorted(files, key=lambda file: (int(re.search(r"(\d*)\.jpg$", file.name)[1] or 0), file.name))


def _image(file):
    try:
        with Image.open(io.BytesIO(_bytes(file))) as image:
            return np.asarray(image.convert("L"), dtype=np.float64) / 255
    except OSError:  # what Pillow raises for anything that is no picture
        raise ValueError(f"{file} is no readable picture: fetch the archive anew") from None


def _bytes(file):
    try:
        return file.read_bytes()
    except (zipfile.BadZipFile, zlib.error, EOFError) as error:
        raise ValueError(f"{file} is damaged ({error}): fetch the archive anew") from None


def _table(file, path):
    """One table, its columns checked."""
    if not file.exists():
        raise ValueError(f"{path} holds no {file.name}; wanted is {GRASPS}")
    try:
        rows = pd.read_csv(io.BytesIO(_bytes(file)))
    except (pd.errors.ParserError, pd.errors.EmptyDataError, UnicodeDecodeError) as error:
        raise ValueError(f"{file} is no table ({error}): fetch the archive anew") from None
    missing = [column for column in ("object", "slipped", *ELECTRODES) if column not in rows]
    if missing:
        raise ValueError(f"{file} has no column {missing[0]}; wanted is {GRASPS}")
    numbers = rows[["slipped", *ELECTRODES]].apply(pd.to_numeric, errors="coerce")
    bad = np.flatnonzero(~np.isfinite(numbers.to_numpy(dtype=np.float64)).all(axis=1) | rows["object"].isna())
    if len(bad):
        raise ValueError(f"{file}, line {bad[0] + 2}: an empty cell or no number: mend it, or fetch the archive anew")
    odd = np.flatnonzero(~numbers["slipped"].isin((0, 1)))
    if len(odd):
        raise ValueError(f"{file}, line {odd[0] + 2}: slipped must be 0 or 1, not {numbers['slipped'].iloc[odd[0]]:g}")
    return numbers.assign(object=rows["object"].astype(str))
