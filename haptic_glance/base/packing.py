"""Turnable meshes small enough for a page: neighbours stored one after the other, differences for values, deflate.

gallery/viewer/viewer.js shows the dict of `pack` for one object, and that of `viewer_data` for all objects.
"""

import base64
import zlib
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from haptic_glance.mesh.mesh import Mesh

STEPS = 4095  # either side of 0 over -0.5..0.5: an eighth of a pixel of a canvas 1000 pixels high
SHADES = 64  # of the colour scale: more cannot be told apart
CELLS = 1024  # a side of the grid whose Morton order puts neighbours next to each other
TOP = 0.99  # of the coarsest level's vertices have an error below the top of the scale; the others show as the top
# Pale is equal, orange medium, dark red large: ever darker, so that the colour-blind can tell the errors apart, too.
ERROR_COLOURS = ((236, 234, 228), (250, 190, 90), (213, 94, 0), (90, 18, 50))


class Level(NamedTuple):
    """A simplified mesh of so many faces, as it is drawn; error: of each vertex of the full one, % of the diagonal."""

    mesh: Mesh
    error: np.ndarray
    faces: int


class Store:
    """Collects arrays; each `put_...` returns the [offset, count] by which the page's script finds its array again."""

    def __init__(self) -> None:
        self._bytes = bytearray()

    def put_words(self, values: ArrayLike) -> list[int]:
        """16-bit values (k,) or (k, d) as differences along the first axis; low bytes first, then high bytes."""
        values = np.asarray(values).astype(np.int64)
        return self._planes(np.diff(values, axis=0, prepend=np.zeros_like(values[:1])))

    def put_shades(self, values: ArrayLike) -> list[int]:
        """Values (k,) in 0..1 as differences of shades."""
        steps = ((SHADES - 1) * np.clip(values, 0, 1)).round().astype(np.int64)
        return self._add(np.diff(steps, prepend=0).astype(np.uint8), len(steps))

    def put_colors(self, colors: np.ndarray) -> list[int]:
        """Colours (n, 3) u1 as differences along the first axis."""
        values = colors.astype(np.int64)
        return self._add((np.diff(values, axis=0, prepend=0) % 256).ravel().astype(np.uint8), colors.size)

    def put_positions(self, vertices: np.ndarray) -> list[int]:
        """Vertices (n, 3) within -0.5..0.5, of a mesh from `ordered`."""
        return self.put_words((2 * STEPS * np.clip(vertices, -0.5, 0.5)).round())

    def put_triangles(self, faces: np.ndarray) -> list[int]:
        """Faces (m, 3) of a mesh from `ordered`: how far below the next new vertex each id lies, 0 for the new one."""
        ids = faces.ravel().astype(np.int64)
        following = np.maximum.accumulate(np.r_[-1, ids])[:-1] + 1
        return self._planes(following - ids)

    def text(self) -> str:
        """All of it, deflated, in base64."""
        return base64.b64encode(zlib.compress(bytes(self._bytes), 9)).decode("ascii")

    def _planes(self, words: np.ndarray) -> list[int]:
        words = (words.ravel() % 65536).astype(np.uint16)
        return self._add(np.r_[words & 255, words >> 8].astype(np.uint8), len(words))

    def _add(self, octets: np.ndarray, count: int) -> list[int]:
        offset = len(self._bytes)
        self._bytes += octets.tobytes()
        return [offset, count]


def viewer_data(
    objects: Sequence[Mapping[str, Any]], colours: np.ndarray, left_out: Sequence[str] = ()
) -> dict[str, Any]:
    """All that the script reads. objects: of `pack`; colours (SHADES, 3) u1 of saliency; left_out: names of objects."""
    place, stops = (np.linspace(0, 1, count) for count in (SHADES, len(ERROR_COLOURS)))
    errors = np.stack([np.interp(place, stops, channel) for channel in np.transpose(ERROR_COLOURS)], axis=1)
    shades = np.concatenate([colours, errors]).round().astype(np.uint8)
    shade_text = base64.b64encode(shades.tobytes()).decode("ascii")
    return {"objects": list(objects), "left_out": list(left_out), "colours": shade_text}


def pack(
    name: str, faces: int, full: Mesh, saliency: Mapping[str, tuple[str, np.ndarray]],
    points: Mapping[str, tuple[str, np.ndarray]], ladders: Mapping[str, tuple[str, Sequence[Level]]],
    colors: np.ndarray | None = None,
) -> dict[str, Any]:  # fmt: skip
    """One object: a mesh from `ordered`, of an object of so many faces, and of it by method, with a label each.

    saliency: (n,) in 0..1; points: (k,) ids of its vertices; ladders: its Levels, finest first. All levels share one
    scale, `error_top` in % of the diagonal, so that the error is seen to grow along the slider; shades are its square
    root. colors (n, 3) u1: of its own, for an object without levels.
    """
    store = Store()
    levels = [level for _, ladder in ladders.values() for level in ladder]
    top = max((float(np.quantile(level.error, TOP)) for level in levels), default=0.0)
    record: dict[str, Any] = {"name": name, "faces": faces, "full": _mesh(full, store), "error_top": top}
    record["saliency"] = {key: {"label": text, "values": store.put_shades(v)} for key, (text, v) in saliency.items()}
    record["points"] = {key: {"label": text, "ids": store.put_words(ids)} for key, (text, ids) in points.items()}
    record["ladders"] = {
        key: {"label": text, "levels": [_level(level, top, store) for level in ladder]}
        for key, (text, ladder) in ladders.items()
    }
    if colors is not None:
        record["tints"] = store.put_colors(colors)
    return record | {"store": store.text()}


def _mesh(mesh: Mesh, store: Store) -> dict[str, Any]:
    positions, triangles = store.put_positions(mesh.vertices), store.put_triangles(mesh.faces)
    return {"faces": len(mesh.faces), "positions": positions, "triangles": triangles}


def _level(level: Level, top: float, store: Store) -> dict[str, Any]:
    return _mesh(level.mesh, store) | {
        "faces": level.faces,
        "drawn": len(level.mesh.faces),
        "error": store.put_shades(np.sqrt(level.error / (top or 1.0))),
        "error_max": round(float(level.error.max()), 3),
        "error_mean": round(float(level.error.mean()), 4),
    }


def ordered(mesh: Mesh) -> tuple[Mesh, np.ndarray]:
    """(mesh, ids): faces along a Morton curve, vertices by first use, unused ones left out; ids: their old numbers."""
    faces = mesh.faces[np.argsort(_morton(mesh.vertices[mesh.faces].mean(axis=1)), kind="stable")]
    ids, first, corners = np.unique(faces.ravel(), return_index=True, return_inverse=True)
    order = np.argsort(first)
    return Mesh(mesh.vertices[ids[order]], np.argsort(order)[corners].reshape(-1, 3)), ids[order]


def _morton(points: np.ndarray) -> np.ndarray:
    """Place of points (k, 3) within -0.5..0.5 on the Morton curve."""
    cells = (np.clip(points + 0.5, 0, 1) * (CELLS - 1)).astype(np.int64)
    bits, axes = np.arange(10), np.arange(3)[:, None]
    return (((cells[:, :, None] >> bits) & 1) << (3 * bits + axes)).sum(axis=(1, 2))
