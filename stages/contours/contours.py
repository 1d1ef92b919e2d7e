"""Contours of an object and their files, data/SET/contours/NAME.npz.

Planes through pairs of points are drawn without replacement (T4.4.6) until enough of them have a contour.
"""

from dataclasses import dataclass, fields, replace
from pathlib import Path

import numpy as np

from haptic_glance.base.files import read_arrays, write_arrays
from haptic_glance.touch import Surface, follow_many


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
    return {name: Sequences(*(arrays[f"{name}.{part.name}"] for part in fields(Sequences))) for name in strategies}


BATCH = 64  # planes followed at once, so that their imprints take a few MB until they are stored as bytes
DRAWS = 20  # pairs per requested sequence: if fewer than one in twenty defines a plane, none does


def sample_contours(
    surface: Surface,
    points: np.ndarray,
    count: int,
    generator: np.random.Generator,
    frames: int = 25,
    cells: tuple[int, int] = (32, 32),
    pitch: float = 0.01,
) -> tuple[Sequences, dict]:
    """(Sequences, statistics) of up to `count` contours through the object's centre and pairs of `points` (k,).

    points: vertex ids. The centre is that of the bounding box. A pair without a contour (collinear with the centre) is
    refused and the next one drawn, until no pair is left or 20 per requested sequence were tried. statistics:
    sequences, refused, the means loops and share, and the share of frames shrunk (T4.4.3), the last three None without
    sequences. Errors as in `follow`; also ValueError for a count below 1.
    """
    if int(count) != count or count < 1:
        raise ValueError(f"count must be an integer from 1, got {count}")
    vertices = surface.mesh.vertices
    surface_points = vertices[np.unique(surface.mesh.faces)]
    centre = (surface_points.min(axis=0) + surface_points.max(axis=0)) / 2
    pairs_drawn = draw_pairs(points, DRAWS * int(count), generator)
    accepted, attempts = [], 0
    while len(accepted) < count and attempts < len(pairs_drawn):
        pairs = pairs_drawn[attempts : attempts + min(BATCH, int(count) - len(accepted))]
        attempts += len(pairs)
        planes = np.concatenate([np.broadcast_to(centre, (len(pairs), 1, 3)), vertices[pairs]], axis=1)
        sequences = follow_many(surface, planes, frames, cells, pitch)
        accepted += [  # imprints, the only large part, as 0..255
            (pair, replace(sequence, images=np.round(255 * sequence.images).astype(np.uint8)))
            for pair, sequence in zip(pairs, sequences, strict=True)
            if not isinstance(sequence, str)
        ]
    statistics = {"sequences": len(accepted), "refused": attempts - len(accepted)}
    numbers = [(sequence.loops, sequence.share, np.mean(sequence.pitches < pitch)) for _, sequence in accepted]
    means = np.mean(numbers, axis=0).tolist() if accepted else (None,) * 3
    return _stack(accepted, int(frames), cells), statistics | dict(
        zip(("loops", "share", "shrunk"), means, strict=True)
    )


def _stack(accepted, frames, cells):
    """The Sequences of some (pair, Sequence)."""
    shapes = {"images": (frames, *cells), "normals": (frames, 3), "positions": (frames, 3), "pitches": (frames,)}
    arrays = {
        part: np.array([getattr(sequence, part) for _, sequence in accepted], PARTS[part]).reshape(-1, *shape)
        for part, shape in shapes.items()
    }
    return Sequences(**arrays, planes=np.array([pair for pair, _ in accepted], PARTS["planes"]).reshape(-1, 2))


def draw_pairs(points: np.ndarray, count: int, generator: np.random.Generator) -> np.ndarray:
    """(k, 2) up to `count` distinct pairs of distinct vertex ids, in random order, or all pairs if there are fewer.

    No pair occurs twice. The order within a pair is random too, since a contour begins at the first. points (n,):
    vertex ids; repeated ones count as one.
    """
    points = np.unique(points)
    total = len(points) * (len(points) - 1) // 2
    numbers = generator.choice(total, size=min(count, total), replace=False) if total else np.zeros(0, dtype=np.int64)
    # Pair number i is (low, high), low < high: the pairs of `high` begin at high (high - 1) / 2.
    high = ((1 + np.sqrt(8.0 * numbers + 1)) / 2).astype(np.int64)
    high -= high * (high - 1) // 2 > numbers  # the root of a large number may be rounded up
    high += high * (high + 1) // 2 <= numbers  # or down
    pairs = np.stack([numbers - high * (high - 1) // 2, high], axis=1)
    is_swapped = generator.random(len(pairs)) < 0.5
    pairs[is_swapped] = pairs[is_swapped, ::-1]
    return points[pairs]
