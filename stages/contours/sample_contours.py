"""Many contours of one object: draws planes until enough of them have a contour."""

from dataclasses import replace

import numpy as np

from haptic_glance.touch import Surface, follow_many

from .files import PARTS, Sequences
from .planes import draw_pairs

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
    used = vertices[np.unique(surface.mesh.faces)]
    centre = (used.min(axis=0) + used.max(axis=0)) / 2
    pairs_drawn = draw_pairs(points, DRAWS * int(count), generator)
    accepted, tried = [], 0
    while len(accepted) < count and tried < len(pairs_drawn):
        pairs = pairs_drawn[tried : tried + min(BATCH, int(count) - len(accepted))]
        tried += len(pairs)
        planes = np.concatenate([np.broadcast_to(centre, (len(pairs), 1, 3)), vertices[pairs]], axis=1)
        sequences = follow_many(surface, planes, frames, cells, pitch)
        accepted += [
            (pair, _as_bytes(sequence))
            for pair, sequence in zip(pairs, sequences, strict=True)
            if not isinstance(sequence, str)
        ]
    statistics = {"sequences": len(accepted), "refused": tried - len(accepted)}
    numbers = [(sequence.loops, sequence.share, np.mean(sequence.pitches < pitch)) for _, sequence in accepted]
    means = np.mean(numbers, axis=0).tolist() if accepted else (None,) * 3
    return _stack(accepted, int(frames), cells), statistics | dict(
        zip(("loops", "share", "shrunk"), means, strict=True)
    )


def _as_bytes(sequence):
    """The Sequence with its imprints, the only large part, as 0..255."""
    return replace(sequence, images=np.round(255 * sequence.images).astype(np.uint8))


def _stack(accepted, frames, cells):
    """The Sequences of some (pair, Sequence)."""
    shapes = {"images": (frames, *cells), "normals": (frames, 3), "positions": (frames, 3), "pitches": (frames,)}
    arrays = {
        part: np.array([getattr(sequence, part) for _, sequence in accepted], PARTS[part]).reshape(-1, *shape)
        for part, shape in shapes.items()
    }
    return Sequences(**arrays, planes=np.array([pair for pair, _ in accepted], PARTS["planes"]).reshape(-1, 2))
