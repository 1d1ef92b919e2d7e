"""From one item of a source to a mesh that the later stages can use, and what is known of it."""

import hashlib

import numpy as np
from scipy.sparse.csgraph import connected_components

from stages.kit.fetch import FetchError

from .clean import clean
from .load import MeshError, parse
from .normalise import normalise, turn_up
from .plane import remove_plane


def prepare(item, without_table=False):
    """(mesh, row of the manifest) of a source's Item: read, repaired, turned upright, centred and scaled.

    without_table: first take out the plane that a scanned object stands on (remove_plane). Raises MeshError with the
    reason where the item gives no usable mesh.
    """
    try:
        content = item.content()
        raw, notes = clean(parse(content, item.suffix))
        if without_table:
            raw, notes = _off_the_table(raw, notes)
        mesh = normalise(turn_up(raw, item.up))
    except (FetchError, ValueError, OSError) as error:
        raise MeshError(str(error)) from error
    used = np.unique(mesh.faces)
    counts = mesh.edge_counts[1]
    parts = connected_components(mesh.adjacency[used][:, used])[0]
    return mesh, {
        "object": item.name, "file": item.file, "licence": item.licence, "creator": item.creator, "unit": item.unit,
        "up": item.up, "size": float(np.ptp(raw.vertices[np.unique(raw.faces)], axis=0).max()),
        "vertices": len(mesh.vertices), "faces": len(mesh.faces), "parts": int(parts), "watertight": mesh.watertight,
        "open_edges": int((counts == 1).sum()), "nonmanifold_edges": int((counts > 2).sum()),
        "colors": mesh.colors is not None, "repairs": "; ".join(notes), "sha256": hashlib.sha256(content).hexdigest(),
    }  # fmt: skip


def _off_the_table(mesh, notes):
    alone = remove_plane(mesh)
    gone = len(mesh.faces) - len(alone.faces)
    return alone, [*notes, f"supporting plane removed with {gone} faces" if gone else "no supporting plane found"]
