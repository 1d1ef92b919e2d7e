"""Reads OFF files of every kind that Geomview defines: colours, normals, texture, 4 or n coordinates, text or binary.

http://www.geomview.org/docs/html/OFF.html. Trimesh reads the plain kind alone, and no mixed polygons.
"""

import re

import numpy as np

from haptic_glance.base.warner import warn_caller

from .headers import MeshError
from .polygons import FEW_CORNERS, fans, refined

KEYWORD = re.compile(rb"\s*(?:#[^\n]*\s+)*(ST)?(C)?(N)?(4)?(n)?OFF(?![^\s#\d])([ \t]+BINARY[^\n]*\n)?")
COUNTS = re.compile(rb"\s*(?:#[^\n]*\s+)*\d+[ \t]+\d+(?:[ \t]+\d+)?[ \t]*(?:#[^\n]*)?\r?\n")


def read_off(content: bytes, name: str = "the file") -> tuple[np.ndarray, np.ndarray, np.ndarray | None]:
    """(vertices (n, 3) f8, faces (m, 3) i8, colors (n, 3) u1 or None) of an OFF file's bytes, in the order of the file.

    A polygon becomes a fan of triangles about its first vertex, or others where a fan would fold a concave one; one of
    fewer than three vertices, which is a point or a line, is left out, with a warning that names the file. Fourth
    coordinates divide the others. Colours of faces are not read. Raises MeshError with the reason for any other file,
    before it allocates more than the file fills.
    """
    if COUNTS.match(content):  # a plain file may leave the word out
        content = b"OFF\n" + content
    header = KEYWORD.match(content)
    if not header:
        raise MeshError("unreadable as OFF: it does not begin with the word OFF")
    texture, colored, normals, homogeneous, dimensional, binary = header.groups()
    reader = _binary if binary else _text
    spans = {"texture": 2 * bool(texture), "normals": 3 * bool(normals), "place": 3 + bool(homogeneous)}
    table, polygons = reader(content[header.end() :], bool(dimensional), sum(spans.values()), bool(colored))
    vertices = table[:, :3]
    if homogeneous:
        with np.errstate(divide="ignore", invalid="ignore"):
            vertices = vertices / table[:, 3:4]
    first = spans["place"] + spans["normals"]
    colors = _bytes(table[:, first : table.shape[1] - spans["texture"]]) if colored else None
    if few := sum(len(polygon) < 3 for polygon in polygons):
        warn_caller(f"{name}: left out: {FEW_CORNERS} ({few:,})")
    return vertices, _triangles(polygons, vertices), colors


def _text(content, dimensional, width, colored):
    """(table (n, d) f8 of the vertices, a list of polygons) of the text after the keyword."""
    lines = [words for line in content.decode("latin-1").splitlines() if (words := line.partition("#")[0].split())]
    if dimensional:
        _three(lines.pop(0)[0] if lines else "")
    if not lines or len(lines[0]) < 2:
        raise MeshError("unreadable as OFF: the numbers of vertices and faces are missing")
    n, m = _numbers(int, lines[0][:2])
    if min(n, m) < 0 or n + m > len(lines) - 1:
        raise MeshError(f"truncated: the header states {n} vertices and {m} faces, {len(lines) - 1} lines follow")
    rows, faces = lines[1 : 1 + n], lines[1 + n : 1 + n + m]
    wide = len(rows[0]) if colored and rows else width  # a colour has three numbers, or four
    if wide < width + 3 * colored or any(len(row) < wide for row in rows):
        raise MeshError(f"unreadable as OFF: a vertex has fewer than {max(wide, width + 3 * colored)} numbers")
    table = np.array([_numbers(float, row[:wide]) for row in rows]).reshape(n, wide)
    polygons = [_numbers(int, row[1 : _numbers(int, row[:1])[0] + 1]) for row in faces]
    if any(str(len(polygon)) != row[0] for polygon, row in zip(polygons, faces, strict=True)):
        raise MeshError("unreadable as OFF: a face has fewer vertices than it states")
    return table, polygons


def _binary(content, dimensional, width, colored):
    """As _text, of what follows the word BINARY: big-endian integers and floats of four bytes."""
    words = np.frombuffer(content, dtype=">i4", count=len(content) // 4)
    if dimensional:
        _three(words[0] if len(words) else "")
        words = words[1:]
    n, m = words[:2].tolist() if len(words) > 2 else (-1, -1)
    wide, offset = width + 4 * colored, 3
    if min(n, m) < 0 or n * wide + 2 * m > len(words) - offset:
        raise MeshError(f"truncated: the header states {n} vertices and {m} faces, {4 * len(words)} bytes follow")
    table = words[offset : offset + n * wide].view(">f4").astype(np.float64).reshape(n, wide)
    offset, words, polygons = offset + n * wide, words.tolist(), []
    for _ in range(m):
        end = offset + 1 + max(words[offset], 0) if offset < len(words) else len(words)
        if end >= len(words) or words[end] < 0:
            raise MeshError("truncated: a face has fewer vertices than it states")
        polygons.append(words[offset + 1 : end])
        offset = end + 1 + words[end]
    return table, polygons


def _triangles(polygons, vertices):
    """(m, 3) i8 faces: a fan about the first vertex of each polygon, or triangles without folds of a concave one."""
    if any(len(polygon) != 3 for polygon in polygons):
        ids = np.array([corner for polygon in polygons for corner in polygon], dtype=np.int64)
        rings = refined(ids, np.array([len(polygon) for polygon in polygons]), vertices)
        polygons = [
            [polygon[corner] for corner in ring]
            for number, polygon in enumerate(polygons)
            for ring in rings.get(number, [range(len(polygon))])
        ]
        polygons = fans(polygons)
    return np.array(polygons, dtype=np.int64).reshape(-1, 3)


def _bytes(colors):
    """(n, 3) u1 of colours (n, 3 or 4), which are 0..255, or 0..1 where none is above."""
    if not np.isfinite(colors).all():
        raise MeshError("unreadable as OFF: a colour is not a number")
    scale = 255 if colors.max(initial=0) <= 1 else 1
    return np.clip(np.round(scale * colors[:, :3]), 0, 255).astype(np.uint8)


def _three(dimension):
    if str(dimension) != "3":
        raise MeshError(f"an OFF of {dimension} dimensions, 3 are needed")


def _numbers(kind, words):
    try:
        return list(map(kind, words))
    except ValueError as error:
        raise MeshError(f"unreadable as OFF: {error}") from None
