"""All sequences of one strategy with their classes and objects, at full size or with fewer frames and cells."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from stages.contours import read_sequences


@dataclass(frozen=True, eq=False)
class SequenceData:
    """n sequences: images (n, frames, rows, cols) u1, normals (n, frames, 3) f4, labels (n,) i8 into classes.

    ranks (n,) i8: the number, from 0, of the sequence's object among the objects of its class.
    """

    images: np.ndarray
    normals: np.ndarray
    labels: np.ndarray
    ranks: np.ndarray
    classes: list[str]

    @property
    def folds(self) -> int:
        """The number of folds that hold out one object of every class: that of objects in the smallest class."""
        return int(min(len(np.unique(self.ranks[self.labels == label])) for label in range(len(self.classes))))


def count_sequences(path: Path) -> dict[str, int]:
    """{strategy: number of sequences} of a file of data/SET/contours, without reading their images."""
    with open(path, "rb") as stream, np.load(stream, allow_pickle=False) as stored:
        names = sorted({name.rpartition(".")[0] for name in stored.files})
        return {name: len(stored[f"{name}.planes"]) for name in names}


def read_sequence_data(folder: Path, members: dict[str, list[str]], strategy: str) -> SequenceData:
    """The SequenceData of one strategy. folder: data/SET/contours; members: {class: objects}, all with sequences."""
    images, normals, labels, ranks = [], [], [], []
    for label, objects in enumerate(members.values()):
        for rank, name in enumerate(objects):
            found = read_sequences(folder / f"{name}.npz", strategy)[strategy]
            images.append(found.images)
            normals.append(found.normals)
            labels += [label] * len(found.images)
            ranks += [rank] * len(found.images)
    return SequenceData(
        np.concatenate(images), np.concatenate(normals), np.array(labels), np.array(ranks), list(members)
    )


def downsample(data: SequenceData, frames: int, cells: int) -> SequenceData:
    """The SequenceData with `frames` evenly spaced frames and imprints of `cells` rows, each cell the mean of a block.

    Raises ValueError for more frames than there are, or a number of cells that does not divide the imprints.
    """
    count, available, rows, columns = data.images.shape
    if not 1 <= frames <= available:
        raise ValueError(f"{frames} frames requested, the sequences have {available}")
    if not is_divisible(cells, rows, columns):
        raise ValueError(f"imprints of {rows} x {columns} cells cannot be averaged to {cells} rows")
    if (frames, cells) == (available, rows):
        return data
    frame_ids, side = np.arange(frames) * available // frames, rows // cells
    blocks = data.images[:, frame_ids].reshape(count, frames, cells, side, columns // side, side)
    images = np.round(blocks.mean(axis=(3, 5), dtype=np.float32)).astype(np.uint8)
    return replace(data, images=images, normals=data.normals[:, frame_ids])


def is_divisible(cells: int, rows: int, columns: int) -> bool:
    """True if imprints of rows x columns divide into square blocks, `cells` of them in a column."""
    return 1 <= cells <= rows and rows % cells == 0 and columns % (rows // cells) == 0
