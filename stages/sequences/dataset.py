"""All sequences of one strategy with their classes and objects, whole, thinned or coarser."""

from dataclasses import dataclass, replace

import numpy as np

from stages.contours import read_sequences


@dataclass(frozen=True, eq=False)
class Data:
    """n sequences: images (n, frames, rows, cols) u1, normals (n, frames, 3) f4, labels (n,) i8 into classes.

    ranks (n,) i8: which object of its class a sequence was felt on, 0 the first.
    """

    images: np.ndarray
    normals: np.ndarray
    labels: np.ndarray
    ranks: np.ndarray
    classes: list[str]

    @property
    def folds(self):
        """How many folds leave one object of every class out: the number of objects of the smallest class."""
        return int(min(len(np.unique(self.ranks[self.labels == label])) for label in range(len(self.classes))))


def counts_in(path):
    """{strategy: number of sequences} of a file of data/contours, without reading their images."""
    with np.load(path, allow_pickle=False) as stored:
        names = sorted({name.rpartition(".")[0] for name in stored.files})
        return {name: len(stored[f"{name}.planes"]) for name in names}


def read_data(folder, members, strategy):
    """The Data of one strategy. folder: data/contours; members: {class: its objects}, all of them with sequences."""
    images, normals, labels, ranks = [], [], [], []
    for label, objects in enumerate(members.values()):
        for rank, name in enumerate(objects):
            found = read_sequences(folder / f"{name}.npz")[strategy]
            images.append(found.images)
            normals.append(found.normals)
            labels += [label] * len(found.images)
            ranks += [rank] * len(found.images)
    return Data(np.concatenate(images), np.concatenate(normals), np.array(labels), np.array(ranks), list(members))


def smaller(data, frames, cells):
    """The Data with so many of the frames, evenly spread, and imprints of `cells` rows, each the mean of a block.

    Raises ValueError where there are not that many frames, or the imprints do not divide into such blocks.
    """
    count, there, rows, columns = data.images.shape
    if not 1 <= frames <= there:
        raise ValueError(f"{frames} frames wanted, the sequences have {there}")
    if not divides(cells, rows, columns):
        raise ValueError(f"imprints of {rows} x {columns} cells cannot be averaged to {cells} rows")
    if (frames, cells) == (there, rows):
        return data
    kept, side = np.arange(frames) * there // frames, rows // cells
    blocks = data.images[:, kept].reshape(count, frames, cells, side, columns // side, side)
    images = np.round(blocks.mean(axis=(3, 5), dtype=np.float32)).astype(np.uint8)
    return replace(data, images=images, normals=data.normals[:, kept])


def divides(cells, rows, columns):
    """True where imprints of rows x columns are made of square blocks, `cells` of them in a column."""
    return 1 <= cells <= rows and rows % cells == 0 and columns % (rows // cells) == 0
