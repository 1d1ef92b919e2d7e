"""Reads the arrays and cells of MATLAB files of versions 5 to 7.

By our own code, since scipy 1.17 crashes on some damaged files (its pull request 25349). The format is that of
MathWorks, MAT-File Format, chapter 1.
"""

import math
import struct
import zlib
from collections.abc import Iterator, Sequence

import numpy as np

from haptic_glance.base.fetch import LARGEST
from haptic_glance.mesh.headers import MeshError

MATRIX, COMPRESSED, CELLS, TEXT = 14, 15, 1, 4
NUMBERS = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 9: "f8", 12: "i8", 13: "u8"}
TEXTS = {2: "latin-1", 4: "utf-16", 16: "utf-8", 17: "utf-16", 18: "utf-32"}
CLASSES = {6: "f8", 7: "f4", 8: "i1", 9: "u1", 10: "i2", 11: "u2", 12: "i4", 13: "u4", 14: "i8", 15: "u8"}


def read_mat(content: bytes, names: Sequence[str]) -> list[np.ndarray]:
    """The variables `names` of a MATLAB file's bytes: real arrays, text (an array of one str), or cells (of objects).

    Raises MeshError when the file is unreadable or a variable is missing.
    """
    order = {b"\x00\x01IM": "<", b"\x01\x00MI": ">"}.get(content[124:128])
    if order is None:
        raise MeshError("unreadable as a MATLAB file before version 7.3")
    try:
        found = _variables(memoryview(content)[128:], order)
        stored = {name: value for name, value in found if value is not None}
    except Exception as error:  # struct, zlib and numpy raise many types
        raise MeshError(f"unreadable as a MATLAB file before version 7.3 ({type(error).__name__}: {error})") from None
    missing = [name for name in names if name not in stored]
    if missing:
        raise MeshError(f"the MATLAB file has no variable {', '.join(missing)}")
    return [stored[name] for name in names]


def _variables(content, order):
    for kind, body in _elements(content, order):
        if kind == COMPRESSED:
            yield from _variables(memoryview(zlib.decompressobj().decompress(body, LARGEST)), order)
        elif kind == MATRIX:
            yield _matrix(body, order)


def _elements(content: memoryview, order: str) -> Iterator[tuple[int, memoryview]]:
    """Yields (data type, bytes) of the elements one after another."""
    at = 0
    while at < len(content):
        kind, size = struct.unpack_from(f"{order}II", content, at)
        start = at + 8
        if kind >> 16:  # a small element: size and type share four bytes, the data have the other four
            kind, size, start = kind & 0xFFFF, kind >> 16, at + 4
        if start + size > len(content):
            raise ValueError(f"an element of {size} bytes, {len(content) - start} follow")
        yield kind, content[start : start + size]
        at = start + size if kind == COMPRESSED else max(at + 8, start + size + -(start + size) % 8)


def _matrix(body, order):
    """(name, value) of a matrix; None for a value of another class, such as structures and sparse arrays."""
    if not len(body):
        return "", np.zeros((0, 0))
    (_, flags), (_, sizes), (_, name), *parts = _elements(body, order)
    kind, shape = np.frombuffer(flags, f"{order}u4")[0] & 0xFF, np.frombuffer(sizes, f"{order}i4").tolist()
    return bytes(name).decode("latin-1"), _value(kind, shape, parts, order)


def _value(kind, shape, parts, order):
    if kind == CELLS:
        if len(parts) != math.prod(shape):
            raise ValueError(f"{len(parts)} cells instead of {shape}")
        cells = np.empty(len(parts), dtype=object)
        cells[:] = [_matrix(body, order)[1] for _, body in parts]
        return cells.reshape(shape, order="F")
    if kind == TEXT:
        stored, text = parts[0]
        wide = "" if TEXTS[stored] in ("latin-1", "utf-8") else "-le" if order == "<" else "-be"
        return np.array([bytes(text).decode(TEXTS[stored] + wide)])
    if kind in CLASSES:
        stored, values = parts[0]
        return np.frombuffer(values, order + NUMBERS[stored]).reshape(shape, order="F").astype(CLASSES[kind])
    return None
