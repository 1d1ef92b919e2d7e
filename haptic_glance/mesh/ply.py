"""PLY files whose faces have three, four or more corners, as triangles that the parser reads."""

import re
from contextlib import suppress

import numpy as np

from .headers import MeshError
from .polygons import FEW_CORNERS, fans, refined

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


def names_in(content: bytes) -> list[str]:
    """The name of the picture that a PLY file names in its header."""
    header = content.partition(b"end_header")[0]
    return [name.decode(errors="replace") for name in re.findall(rb"(?m)^comment TextureFile (.*?)\s*$", header)]


def left_out(content: bytes) -> dict[str, int]:
    """{kind: count} of the elements of a PLY that are no surface: edges, and faces of fewer than three corners."""
    header = content.partition(b"end_header")[0]
    few = 0
    with suppress(ValueError, LookupError, MeshError):  # which the parser names
        few = int((_corner_counts(content) < 3).sum())
    return {"edges": sum(map(int, re.findall(rb"(?m)^element edge (\d+)", header))), FEW_CORNERS: few}


def _corner_counts(content):
    """(m,) the number of corners of each face; empty where the place of the faces is not known."""
    end = END.search(content)
    lines = content[: end.end()].decode("latin-1").splitlines() if end else ["", ""]
    if end and "ascii" in lines[1]:
        rows, at = content[end.end() :].splitlines(), 0
        for name, count, properties in _elements(lines):
            if name == "face":
                place = _place_of_list(properties)
                return np.array([int(row.split(None, place + 1)[place]) for row in rows[at : at + count]])
            at += count
    for name, count, properties, at in _binary_elements(lines, end.end() if end else 0):
        if name == "face" and count:
            return _rows(content, at, count, properties, _order(lines))[1]
    return np.zeros(0)


def triangulated(content: bytes) -> bytes:
    """A PLY's bytes; each polygon of a binary one becomes a fan of triangles about its first vertex, in their order.

    Where all faces have three corners, or four, and where they have another list, the bytes stay as they are. A concave
    polygon, also of text, that a fan would fold begins at another corner, or becomes triangles. Single values of a face
    go to each of its triangles. Raises MeshError for a file that ends in a face.
    """
    end = END.search(content)
    lines = content[: end.end()].decode("latin-1").splitlines() if end else ["", "ascii"]
    if end and "ascii" in lines[1]:
        with suppress(ValueError, LookupError):  # which the parser names
            return _unfolded_text(content, end.end(), _elements(lines))
    if not end or "ascii" in lines[1]:
        return content
    order, vertices = _order(lines), np.zeros((0, 3))
    for name, rows, properties, at in _binary_elements(lines, end.end()):
        lists = [words for words in properties if words[0] == "list"]
        if name == "face" and len(lists) == 1 and lists[0][-1] in CORNERS and rows:
            return _fans(content, lines, end.end(), at, rows, properties, order, vertices)
        if name == "vertex":
            with suppress(ValueError, LookupError):
                kind = np.dtype([(words[1], order + TYPES[words[0]]) for words in properties])
                table = np.frombuffer(content, kind, rows, at)
                vertices = np.stack([table[axis] for axis in "xyz"], axis=1).astype(np.float64)
    return content


def _unfolded_text(content, begin, elements):
    """The bytes of a PLY of text, whose body begins at a place, with polygons that a fan does not fold."""
    rows, at, table, axes = content[begin:].splitlines(), 0, [], []
    for name, count, properties in elements:
        lists = [place for place, words in enumerate(properties) if words[0] == "list"]
        if name == "face" and len(lists) == 1 and properties[lists[0]][-1] in CORNERS:
            faces, place = [row.split() for row in rows[at : at + count]], lists[0]
            sizes = np.array([int(face[place]) for face in faces])
            if (sizes <= 3).all() or list(map(len, faces)) != (len(properties) + sizes).tolist():
                break
            vertices = np.array([[float(words[axis]) for axis in axes] for words in map(bytes.split, table)])
            polygons = [face[place + 1 : place + 1 + k] for face, k in zip(faces, sizes, strict=True)]
            rings = refined(np.array([int(corner) for ring in polygons for corner in ring]), sizes, vertices)
            for number, parts in rings.items():
                face, polygon = faces[number], polygons[number]
                behind = face[place + 1 + len(polygon) :]
                new = [[*face[:place], b"%d" % len(ring), *(polygon[k] for k in ring), *behind] for ring in parts]
                rows[at + number] = b"\n".join(map(b" ".join, new))
            more = count + sum(len(parts) - 1 for parts in rings.values())
            header = re.sub(rb"(?m)^element face \d+", b"element face %d" % more, content[:begin])
            return header + b"\n".join(rows) + b"\n" if rings else content
        if name == "vertex":
            axes = [[words[-1] for words in properties].index(axis) for axis in "xyz"]
            table = rows[at : at + count]
        at += count
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


def _binary_elements(lines, begin):
    """(name, rows, words of its properties, place in the bytes) of the elements up to the first one with a list."""
    for name, rows, properties in _elements(lines):
        yield name, rows, properties, begin
        if any(words[0] == "list" for words in properties):  # the next element begins at a place that is not known
            return
        begin += rows * sum(np.dtype(TYPES[words[0]]).itemsize for words in properties)


def _order(lines):
    return ">" if "big" in lines[1] else "<"


def _place_of_list(properties):
    return [words[0] for words in properties].index("list")


def _row_layout(properties, order):
    """(type of the number of corners, type of a corner, bytes before the list, bytes behind it) of a binary face."""
    place = _place_of_list(properties)
    number, ids = (np.dtype(order + TYPES[kind]) for kind in properties[place][1:3])
    sizes = [np.dtype(TYPES[words[0]]).itemsize if words[0] != "list" else 0 for words in properties]
    return number, ids, sum(sizes[:place]), sum(sizes[place:])


def _fans(content, lines, begin, at, rows, properties, order, vertices):
    """The bytes with triangles for polygons, or with quads that a fan does not fold."""
    number, ids, before, after = _row_layout(properties, order)
    starts, corners = _rows(content, at, rows, properties, order)
    if (corners == 3).all():
        return content
    octets = np.frombuffer(content, np.uint8)

    def taken(first, size):  # (faces, size) bytes from a place of each
        return octets[first[:, None] + np.arange(size)]

    rings = starts + before + number.itemsize
    within = np.arange(corners.sum()) - np.repeat(np.cumsum(corners) - corners, corners)
    named = taken(np.repeat(rings, corners) + ids.itemsize * within, ids.itemsize).view(ids).ravel()
    unfolded = refined(named.astype(np.int64), corners, vertices)
    if (corners == 4).all():
        rotated = octets.copy()
        for face, ((first, *_),) in unfolded.items():
            quad = slice(rings[face], rings[face] + 4 * ids.itemsize)
            rotated[quad] = np.roll(octets[quad], -first * ids.itemsize)
        return rotated.tobytes() if unfolded else content
    triangles = np.maximum(corners - 2, 0)
    face = np.repeat(np.arange(rows), triangles)
    second = np.arange(len(face)) - np.repeat(np.cumsum(triangles) - triangles, triangles) + 1
    chosen = np.stack([np.zeros_like(second), second, second + 1], axis=1)
    firsts = np.cumsum(triangles) - triangles
    for place, parts in unfolded.items():
        chosen[firsts[place] : firsts[place] + triangles[place]] = fans(parts)
    ring = rings[face]
    parts = [taken(starts[face], before), np.full((len(face), 1), 3, np.uint8)]
    parts += [taken(ring + corner * ids.itemsize, ids.itemsize) for corner in chosen.T]
    parts += [taken(ring + corners[face] * ids.itemsize, after)]
    stop = starts[-1] + before + number.itemsize + corners[-1] * ids.itemsize + after
    header = "\n".join(lines) + "\n"
    header = re.sub(r"^element face .*", f"element face {len(face)}", header, flags=re.M)
    header = re.sub(r"^property list \S+ (\S+ vertex_ind)", r"property list uchar \1", header, count=1, flags=re.M)
    return b"".join([header.encode("latin-1"), content[begin:at], np.hstack(parts).tobytes(), content[stop:]])


def _rows(content, at, rows, properties, order):
    """(where each face begins, its number of corners)."""
    number, ids, before, after = _row_layout(properties, order)
    item, endian = ids.itemsize, "big" if order == ">" else "little"

    def count(at):
        return int.from_bytes(content[at : at + number.itemsize], endian)

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
