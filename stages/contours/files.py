"""The files of the stage: data/SET/contours/NAME.npz."""

from dataclasses import dataclass, fields
from pathlib import Path

import numpy as np

from haptic_glance.base.files import read_arrays, write_arrays


@dataclass(frozen=True)
class Sequences:
    """The n sequences of one object and strategy, in the order in which their planes were drawn.

    images (n, frames, rows, cols) u1: the imprints, 0 is contact and 255 is farthest; normals (n, frames, 3) f4 unit
    vectors of the array; positions (n, frames, 3) f4 and pitches (n, frames) f4 in units of the mesh; planes (n, 2) i8
    the vertex ids of the two points that define the plane together with the object's centre.
    """

    images: np.ndarray
    normals: np.ndarray
    positions: np.ndarray
    pitches: np.ndarray
    planes: np.ndarray


PARTS = {"images": np.uint8, "normals": np.float32, "positions": np.float32, "pitches": np.float32, "planes": np.int64}


def write_sequences(path: str | Path, sequences: dict[str, Sequences]) -> None:
    """Writes {strategy: Sequences} as the arrays STRATEGY.images, .normals, .positions, .pitches and .planes."""
    arrays = {}
    for strategy in sorted(sequences):
        for part in fields(Sequences):
            values = getattr(sequences[strategy], part.name)
            arrays[f"{strategy}.{part.name}"] = values.astype(PARTS[part.name], copy=False)
    write_arrays(path, **arrays)


def read_sequences(path: str | Path, strategy: str | None = None) -> dict[str, Sequences]:
    """{strategy: Sequences} of one object, the strategies in alphabetical order; or of one strategy alone."""
    arrays = read_arrays(path, f"{strategy}." if strategy else "")
    strategies = sorted({key.rpartition(".")[0] for key in arrays})
    return {one: Sequences(*(arrays[f"{one}.{part.name}"] for part in fields(Sequences))) for one in strategies}
