"""Readers of recorded touches (a pressure array, a hand with BioTac SP fingertips), and imprints of one sampling."""

import io
import itertools
import re
import zipfile
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from haptic_glance.base.files import open_picture
from haptic_glance.know.features import SIMILARITY_THRESHOLD, features, similarity
from stages.imprints.imprints import read_imprints

from .touch_trials import THESIS_COUNT, TouchSet

FINGERS = ("ff", "mf", "th")  # first and middle finger, thumb
ELECTRODES = [f"{finger}_biotac_{k}" for finger in FINGERS for k in range(1, 25)]
PALMS = ("45", "down", "side")  # direction of the palm
PRESSURE = "the archive of pressure images: a folder Images with a folder of .jpg files for each class"
GRASPS = "the archive BTS3 v2: bts3v2_palm_45.csv, _down.csv, _side.csv, and the same three with _test"


@dataclass(frozen=True)
class Grasps:
    """Grasps by three fingers: electrodes (n, 72) f8, 24 of each finger in the order ff, mf, th; objects
    (n,) names; palms (n,) of PALMS; slipped (n,) boolean: the object fell or moved when the hand was lifted; test (n,)
    boolean: of the objects that the authors reserve for testing. In the order of the files, 45, down, side, test last.
    """

    electrodes: np.ndarray
    objects: np.ndarray
    palms: np.ndarray
    slipped: np.ndarray
    test: np.ndarray


def read_pressure_images(path: str | Path) -> dict[str, np.ndarray]:
    """{class: (k, rows, cols) f8 in 0..1}, 1 the highest pressure; classes sorted, touches by their number.

    path: the zip file, or a folder with the same in it. In the archive of Gandarias, Garcia-Cerezo and Gomez-de-Gabriel
    (IEEE Sensors Journal 19(16), 2019): 22 classes, 50 touches each, 28 x 50 cells.
    Raises ValueError, with the file and the remedy, for anything else.
    """
    root = open_root(path, PRESSURE)
    folders = sorted(_entries(root / "Images"), key=lambda folder: folder.name)
    files_by_class = {folder.name: _images_by_number(folder) for folder in folders if folder.is_dir()}
    if not files_by_class or not all(files_by_class.values()):
        empty = [name for name, files in files_by_class.items() if not files] or ["Images"]
        raise ValueError(f"{path}: no .jpg in {empty[0]}; expected {PRESSURE}")
    images = {name: [_image(file) for file in files] for name, files in files_by_class.items()}
    sizes = {image.shape for group in images.values() for image in group}
    if len(sizes) > 1:
        raise ValueError(f"{path}: images of several sizes, {sorted(sizes)}; all must come from one sensor")
    return {name: np.stack(group) for name, group in images.items()}


def read_grasps(path: str | Path) -> Grasps:
    """The Grasps in the six tables of BTS3 v2 (Garcia-Garcia and others, IJCNN 2019).

    path: the zip file, or a folder with the tables. Raises ValueError, with the file and the remedy, if a table is
    missing, lacks a column, or contains a value that is not a number.
    """
    root, parts = open_root(path, GRASPS), []
    for test in (False, True):
        for palm in PALMS:
            table = _table(root / f"bts3v2_palm_{palm}{'_test' if test else ''}.csv", path)
            parts.append(table.assign(palm=palm, test=test))
    rows = pd.concat(parts, ignore_index=True)
    return Grasps(
        rows[ELECTRODES].to_numpy(dtype=np.float64), rows["object"].to_numpy(dtype=str),
        rows["palm"].to_numpy(dtype=str), rows["slipped"].to_numpy() == 1, rows["test"].to_numpy(dtype=bool),
    )  # fmt: skip


def open_root(path: str | Path, expected: str) -> Path | zipfile.Path:
    """The root of a zip file or a folder; raises ValueError, with the remedy, where it is neither."""
    path = Path(path)
    if path.is_dir():
        return path
    if not path.exists():
        raise ValueError(f"{path} does not exist: give the path of {expected}")
    try:
        return zipfile.Path(zipfile.ZipFile(path))
    except zipfile.BadZipFile:
        raise ValueError(f"{path} is not a complete zip file: download it again; expected {expected}") from None


def _entries(folder):
    return list(folder.iterdir()) if folder.is_dir() else []


def _images_by_number(folder):
    """The .jpg and .JPG files of a folder in the order of the numbers at the end of their names."""
    files = [file for file in _entries(folder) if file.name.lower().endswith(".jpg")]
    return sorted(files, key=lambda file: (int("0" + re.findall(r"(?i)(\d*)\.jpg$", file.name)[0]), file.name))


def _image(file):
    return np.asarray(open_picture(_bytes(file), file).convert("L"), dtype=np.float64) / 255


def _bytes(file):
    try:
        return file.read_bytes()
    except (zipfile.BadZipFile, zlib.error, EOFError) as error:
        raise ValueError(f"{file} is damaged ({error}): download the archive again") from None


def _table(file, path):
    """One table, its columns checked."""
    if not file.exists():
        raise ValueError(f"{path} has no {file.name}; expected {GRASPS}")
    try:
        rows = pd.read_csv(io.BytesIO(_bytes(file)))
    except (pd.errors.ParserError, pd.errors.EmptyDataError, UnicodeDecodeError) as error:
        raise ValueError(f"{file} is not a valid table ({error}): download the archive again") from None
    missing = [column for column in ("object", "slipped", *ELECTRODES) if column not in rows]
    if missing:
        raise ValueError(f"{file} has no column {missing[0]}; expected {GRASPS}")
    numbers = pd.DataFrame({name: pd.to_numeric(rows[name], errors="coerce") for name in ("slipped", *ELECTRODES)})
    bad = np.flatnonzero(~np.isfinite(numbers.to_numpy(dtype=np.float64)).all(axis=1) | rows["object"].isna())  # type: ignore[operator]
    if len(bad):
        raise ValueError(
            f"{file}, line {bad[0] + 2}: an empty cell or not a number: correct it, or download the archive again"
        )
    invalid = np.flatnonzero(~numbers["slipped"].isin((0, 1)))
    if len(invalid):
        raise ValueError(
            f"{file}, line {invalid[0] + 2}: slipped must be 0 or 1, not {numbers['slipped'].iloc[invalid[0]]:g}"
        )
    return numbers.assign(object=rows["object"].astype(str))


def gather(folder: Path, objects: list[str], sampling: str, count: int) -> tuple[TouchSet, np.ndarray]:
    """(TouchSet, labels (k,)): the first `count` imprints of each object, the objects in alphabetical order."""
    imprints_by_object = {name: read_imprints(folder / f"{name}.npz")[sampling] for name in sorted(objects)}
    images = np.concatenate([imprints.images[:count] for imprints in imprints_by_object.values()])
    places = np.concatenate([imprints.positions[:count] for imprints in imprints_by_object.values()])
    truth = np.repeat(np.arange(len(imprints_by_object)), count)
    width = max(imprints.width for imprints in imprints_by_object.values())
    return TouchSet.from_images(features(images), images, truth, places, width), np.array(list(imprints_by_object))[
        truth
    ]


def similar_share_rows(touched: TouchSet, objects: list[str]) -> list[dict]:
    """Rows of the share of imprints confusable with another object's: over all objects, and per object (`item`)."""
    rows = []
    for variant, part in (("plain", touched), (f"first_{THESIS_COUNT}", touched.first_of_each())):
        for name, mask in ((None, slice(None)), *((item, part.truth == k) for k, item in enumerate(objects))):
            share = part.confusable[mask]
            rows.append({"variant": variant, "classifier": None, "item": name, "metric": "similar_share"})
            rows[-1] |= {"imprints": len(share), "value": float(share.mean()), "seconds": None, "note": None}
    return rows


def alike(objects: Sequence[str], folder: Path) -> np.ndarray:
    """(n, n) share of imprints of two objects that are confusable with one of the other, the mean of all samplings."""
    imprints = [read_imprints(folder / f"{name}.npz") for name in objects]
    shared = sorted(set.intersection(*map(set, imprints)))
    shares = np.zeros((len(objects), len(objects)))
    for sampling, (row, first), (column, second) in itertools.product(shared, enumerate(imprints), enumerate(imprints)):
        is_similar = similarity(first[sampling].images, second[sampling].images) >= SIMILARITY_THRESHOLD
        shares[row, column] += (is_similar.any(axis=1).mean() + is_similar.any(axis=0).mean()) / 2
    return shares / max(1, len(shared))
