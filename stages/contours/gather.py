"""Many contours of one object: draws planes until enough of them have one."""

from dataclasses import replace

import numpy as np

from stages.imprints import follow_many

from .files import PARTS, Sequences
from .planes import draw_pairs

BATCH = 64  # planes followed at once: their imprints stay in a few MB until they are stored as bytes
DRAWS = 20  # pairs drawn for each sequence wanted: where fewer than one in twenty makes a plane, none will


def gather(surface, points, count, generator, frames=25, cells=(32, 32), pitch=0.01):
    """(Sequences, facts) of up to `count` contours through the object's centre and pairs of vertices `points` (k,).

    The centre is that of the bounding box. A pair that gives no contour (it lies on a line with the centre) is refused
    and the next one drawn, until no pair is left or 20 for each sequence wanted were tried. facts: sequences, refused,
    and, None where there are no sequences, the means loops and share and the share of frames shrunk (T4.4.3).
    Errors as in `follow`; ValueError for a count below 1.
    """
    if int(count) != count or count < 1:
        raise ValueError(f"count must be a whole number from 1, got {count}")
    vertices = surface.mesh.vertices
    used = vertices[np.unique(surface.mesh.faces)]
    centre = (used.min(axis=0) + used.max(axis=0)) / 2
    drawn = draw_pairs(points, DRAWS * int(count), generator)
    taken, tried = [], 0
    while len(taken) < count and tried < len(drawn):
        pairs = drawn[tried : tried + min(BATCH, int(count) - len(taken))]
        tried += len(pairs)
        planes = np.concatenate([np.broadcast_to(centre, (len(pairs), 1, 3)), vertices[pairs]], axis=1)
        found = follow_many(surface, planes, frames, cells, pitch)
        taken += [(pair, _as_bytes(one)) for pair, one in zip(pairs, found, strict=True) if not isinstance(one, str)]
    facts = {"sequences": len(taken), "refused": tried - len(taken)}
    numbers = [(one.loops, one.share, np.mean(one.pitches < pitch)) for _, one in taken]
    means = np.mean(numbers, axis=0).tolist() if taken else (None,) * 3
    return _stacked(taken, int(frames), cells), facts | dict(zip(("loops", "share", "shrunk"), means, strict=True))


def _as_bytes(sequence):
    """The Sequence with its imprints as 0..255: nothing else of it is large."""
    return replace(sequence, images=np.round(255 * sequence.images).astype(np.uint8))


def _stacked(taken, frames, cells):
    """The Sequences of some (pair, Sequence)."""
    shapes = {"images": (frames, *cells), "normals": (frames, 3), "positions": (frames, 3), "pitches": (frames,)}
    arrays = {
        part: np.array([getattr(one, part) for _, one in taken], PARTS[part]).reshape(-1, *shape)
        for part, shape in shapes.items()
    }
    return Sequences(**arrays, planes=np.array([pair for pair, _ in taken], PARTS["planes"]).reshape(-1, 2))
