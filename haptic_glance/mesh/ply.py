"""PLY files whose faces have three, four or more corners, as triangles that the parser reads."""

import re

import numpy as np

from .headers import MeshError

TYPES = {"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4"}
TYPES |= {"float": "f4", "double": "f8", "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2"}
TYPES |= {"int32": "i4", "uint32": "u4", "int64": "i8", "uint64": "u8", "float32": "f4", "float64": "f8"}
CORNERS = ("vertex_indices", "vertex_index")
END = re.compile(rb"end_header\r?\n")


def plain(content: bytes) -> bytes:
    """A PLY's bytes with the usual names of colours, and `triangulated`."""
    header, mark, body = content.partition(b"end_header")
    if b"diffuse_red" in header and b" red" not in header:
        content = re.sub(rb"\bdiffuse_(red|green|blue)\b", rb"\1", header) + mark + body
    return triangulated(content)


def triangulated(content: bytes) -> bytes:
    """A PLY's bytes; each polygon of a binary one becomes a fan of triangles about its first vertex, in their order.

    Where all faces have three corners, or four, and where they have another list, the bytes stay as they are. Single
    values of a face go to each of its triangles. Raises MeshError for a file that ends in a face.
    """
    end = END.search(content)
    lines = content[: end.end()].decode("latin-1").splitlines() if end else ["", "ascii"]
    if not end or "ascii" in lines[1]:
        return content
    order, offset = ">" if "big" in lines[1] else "<", end.end()
    for name, rows, properties in _elements(lines):
        lists = [words for words in properties if words[0] == "list"]
        if name == "face" and len(lists) == 1 and lists[0][-1] in CORNERS and rows:
            return _fans(content, lines, end.end(), offset, rows, properties, order)
        if lists:  # what follows begins at a place that is not known
            break
        offset += rows * sum(np.dtype(TYPES[words[0]]).itemsize for words in properties)
    return content


def _elements(lines):
    """[(name, rows, words of its properties)] of a header's lines."""
    elements = []
    for words in map(str.split, lines):
        if words[:1] == ["element"]:
            elements.append((words[1], int(words[2]), []))
        elif words[:1] == ["property"]:
            elements[-1][2].append(words[1:])
    return elements


def _fans(content, lines, begin, at, rows, properties, order):
    place = next(i for i, words in enumerate(properties) if words[0] == "list")
    number, ids = (np.dtype(order + TYPES[kind]) for kind in properties[place][1:3])
    sizes = [np.dtype(TYPES[words[0]]).itemsize if words[0] != "list" else 0 for words in properties]
    before, after = sum(sizes[:place]), sum(sizes[place:])
    starts, corners = _rows(content, at, rows, "big" if order == ">" else "little", number, ids.itemsize, before, after)
    if (corners == corners[0]).all() and corners[0] in (3, 4):
        return content
    triangles = np.maximum(corners - 2, 0)
    face = np.repeat(np.arange(rows), triangles)
    second = np.arange(len(face)) - np.repeat(np.cumsum(triangles) - triangles, triangles) + 1
    octets = np.frombuffer(content, np.uint8)

    def taken(first, size):  # (faces, size) bytes from a place of each
        return octets[first[:, None] + np.arange(size)]

    ring = starts[face] + before + number.itemsize
    parts = [taken(starts[face], before), np.full((len(face), 1), 3, np.uint8)]
    parts += [taken(ring + corner * ids.itemsize, ids.itemsize) for corner in (0, second, second + 1)]
    parts += [taken(ring + corners[face] * ids.itemsize, after)]
    stop = starts[-1] + before + number.itemsize + corners[-1] * ids.itemsize + after
    header = "\n".join(lines) + "\n"
    header = re.sub(r"^element face .*", f"element face {len(face)}", header, flags=re.M)
    header = re.sub(r"^property list \S+ (\S+ vertex_ind)", r"property list uchar \1", header, count=1, flags=re.M)
    return b"".join([header.encode("latin-1"), content[begin:at], np.hstack(parts).tobytes(), content[stop:]])


def _rows(content, at, rows, order, number, item, before, after):
    """(where each face begins, its number of corners)."""

    def count(at):
        return int.from_bytes(content[at : at + number.itemsize], order)

    after += number.itemsize
    size = before + count(at + before) * item + after
    if at + rows * size <= len(content):
        corners = np.ndarray(rows, number, content, at + before, size)
        if (corners == corners[0]).all():
            return at + size * np.arange(rows), corners.astype(np.int64)
    starts, corners = [], []
    for _ in range(rows):
        starts.append(at)
        corners.append(count(at + before))
        at += before + corners[-1] * item + after
        if at > len(content):
            raise MeshError("truncated: it ends in a face")
    return np.array(starts), np.array(corners)
