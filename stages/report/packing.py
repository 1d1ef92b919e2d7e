"""Mesh data small enough for a page: neighbours stored one after the other, differences instead of values, deflate."""

import base64
import zlib

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from stages.kit import Mesh

STEPS = 4095  # either side of 0 over -0.5..0.5: an eighth of a pixel of a canvas 1000 pixels high
SHADES = 64  # of the colour scale: more cannot be told apart
CELLS = 1024  # a side of the grid whose Morton order puts neighbours next to each other


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


def ordered(mesh: Mesh) -> tuple[Mesh, np.ndarray]:
    """(mesh, ids): faces along a Morton curve, vertices by first use, unused ones left out; ids: their old numbers."""
    faces = mesh.faces[np.argsort(_morton(mesh.vertices[mesh.faces].mean(axis=1)), kind="stable")]
    corners, ids = pd.factorize(faces.ravel())
    return Mesh(mesh.vertices[ids], corners.reshape(-1, 3)), ids


def _morton(points: np.ndarray) -> np.ndarray:
    """Place of points (k, 3) within -0.5..0.5 on the Morton curve."""
    cells = (np.clip(points + 0.5, 0, 1) * (CELLS - 1)).astype(np.int64)
    bits, axes = np.arange(10), np.arange(3)[:, None]
    return (((cells[:, :, None] >> bits) & 1) << (3 * bits + axes)).sum(axis=(1, 2))
