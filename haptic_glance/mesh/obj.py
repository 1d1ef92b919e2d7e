"""OBJ files and their materials as people write them, in the form that the parser reads."""

from __future__ import annotations

import re
from contextlib import suppress
from pathlib import Path

import numpy as np

from haptic_glance.base.lazy import trimesh
from haptic_glance.base.text import text_of

from .headers import MeshError
from .materials import obj_vertices
from .polygons import FEW_CORNERS, refined

NUMBERED = [b"v"], [b"vt"], [b"vn"], [b"f"]  # the first words of lines of numbers
NUMBER = r"\s+[-+]?[\d.]+(?:e[-+]?\d+)?(?=\s)"
OPTION = re.compile(
    rf"(?<!\S)-(?:mm(?:{NUMBER}){{2}}|[ost](?:{NUMBER}){{1,3}}|(?:blend[uv]|cc|clamp|texres|imfchan|bm|boost)\s+\S+)\s+",
    re.I,
)


def plain(content: bytes) -> bytes:
    """An OBJ's bytes in UTF-8, without a byte-order mark, tabs, blanks that begin a line, and comments behind numbers.

    Numbers of corners count from the first line. A concave polygon begins at another corner, or becomes triangles,
    where the parser's fan would fold it. One line names all material libraries. Raises MeshError for a vertex 0.
    """
    content = text_of(content).encode()  # the parser guesses an encoding, another one for the materials
    content = content.replace(b"\t", b" ") if b"\t" in content else content
    # a line that ends with a backslash goes on: its numbers would grow together
    content = (
        re.sub(rb"(?m)(?<!\\\n)(?<!\\\r\n)^ +", b"", content) if b"\n " in content or content[:1] == b" " else content
    )

    def cut(comment: re.Match[bytes]) -> bytes:
        start = content.rfind(b"\n", 0, comment.start()) + 1
        return b"" if content[start : comment.start()].split(None, 1)[:1] in NUMBERED else comment[0]

    content = _counted(re.sub(rb"#[^\n]*", cut, content) if b"#" in content else content)
    zeros = ZERO.finditer(content, max(content.find(b"\nf "), 0))
    if any(content.startswith(b"f ", content.rfind(b"\n", 0, zero.start()) + 1) for zero in zeros):
        raise MeshError("faces name a vertex 0, which does not exist: an OBJ counts from 1")
    return _unfolded(_in_one_library(content))


ZERO = re.compile(rb" -?0+(?=[ /\r\n]|$)")
LIBRARY = re.compile(rb"(?m)^mtllib +([^\r\n]*?) *\r?$")
BETWEEN = "\x1f"  # of the names of several libraries


def _in_one_library(content):
    """The bytes with one `mtllib` line: the parser reads the first line alone."""
    names = [name.decode(errors="replace") for name in dict.fromkeys(LIBRARY.findall(content))]
    if len(names) < 2:
        return content
    line = b"mtllib " + BETWEEN.join(names).encode()
    return line + b"\n" + LIBRARY.sub(b"", content)


KINDS = b"v", b"vt", b"vn"  # in the order of the numbers of a corner
BACK = re.compile(rb"(?m)^f [^\n]*[ /]-\d")


def _counted(content):
    """The bytes with numbers that count from the first line; the parser counts -1 back from the end of the file."""
    if not BACK.search(content):
        return content
    counts, lines = dict.fromkeys(KINDS, 0), content.split(b"\n")
    for place, line in enumerate(lines):
        word, *corners = line.split() or [b""]
        if word in KINDS:
            counts[word] += 1
        elif word == b"f":
            parts = [zip(corner.split(b"/"), counts.values(), strict=False) for corner in corners]
            numbers = [[_forwards(number, count) for number, count in part] for part in parts]
            lines[place] = b"f " + b" ".join(map(b"/".join, numbers))
    return b"\n".join(lines)


def _forwards(number, count):
    if not re.fullmatch(rb"-\d+", number):  # the parser names what is no number
        return number
    if int(number) + count < 0:
        raise MeshError(f"faces name the vertex {int(number)} of {count}, which does not exist")
    return b"%d" % (int(number) + count + 1)


POLYGON = re.compile(rb"(?m)^f((?: +-?\d[-/\d]*){4,})(?= *\r?$)")


def _unfolded(content):
    polygons = [match[1].split() for match in POLYGON.finditer(content)]
    if not polygons:
        return content
    words = re.sub(rb"/\S*", b"", b" ".join(b" ".join(corners) for corners in polygons)).split()
    try:
        ids, vertices = np.array(words).astype(np.int64), obj_vertices(content)
    except ValueError:  # which the parser names
        return content
    rings = refined(ids - 1, np.array([len(corners) for corners in polygons]), vertices)
    numbers = iter(range(len(polygons)))

    def lines(polygon: re.Match[bytes]) -> bytes:
        number = next(numbers)
        parts = [[polygons[number][corner] for corner in ring] for ring in rings.get(number, ())]
        return b"\n".join(b"f " + b" ".join(part) for part in parts) or polygon[0]

    return POLYGON.sub(lines, content) if rings else content


class SiblingFiles:
    """Reads the files beside an OBJ, also by a name with the separators of Windows, or behind the options of a map.

    `absent` names the pictures that were not there.
    """

    def __init__(self, folder: trimesh.resolvers.Resolver) -> None:
        self.folder = folder
        self.file_name = getattr(folder, "file_name", None)
        self.absent: list[str] = []

    def get(self, key: str) -> bytes:
        if libraries := self._libraries(key):
            texts = []
            for name in libraries:
                with suppress(FileNotFoundError):
                    texts.append(self.get(name))
            return b"\n".join(texts)
        plain_name = OPTION.sub("", key).replace("\\", "/")
        for name in (key, plain_name):  # as it stands first: a file may be named so
            with suppress(OSError, ValueError, KeyError):
                data = self.folder.get(name)
                return text_of(data).encode() if name.lower().endswith(".mtl") else data
        self.absent.append(plain_name)
        raise FileNotFoundError(plain_name)

    __getitem__ = get

    def _libraries(self, key):
        """The names of several material libraries in one text; none where the text names one file."""
        if BETWEEN in key:
            return key.split(BETWEEN)
        words = key.split()
        if len(words) < 2 or not all(word.lower().endswith(".mtl") for word in words):
            return []
        with suppress(OSError, ValueError, KeyError):  # blanks are part of the name
            self.folder.get(key)
            return []
        return words


NAMES = re.compile(rb"(?mi)^[ \t]*(mtllib|map_\w+|bump|disp|decal|norm|refl)[ \t]+(.+?)\s*$")


def names_in(content: bytes) -> list[str]:
    """The names of the files that an OBJ file, or a material file, refers to; those of materials also word by word."""
    names = []
    for kind, text in NAMES.findall(text_of(content).encode()):
        name = text.decode(errors="replace")
        words = name.split() if kind.lower() == b"mtllib" else [OPTION.sub("", name)]
        names += [word.replace("\\", "/") for word in (name, *words)]
    return names


OTHER_MAPS = re.compile(r"(?mi)^\s*(?!map_Kd)(map_\w+|bump|disp|decal|norm|refl)\s")
# Further statements that change how a material looks, and the values that change nothing.
LOOKS = {"d": 1.0, "Tr": 0.0, "Ks": 0.0, "Ke": 0.0}
COLOUR_MAP, PLACED = re.compile(r"(?mi)^\s*map_Kd(\s.*)$"), re.compile(r"(?i)\s(-[ost])(?=\s)")
OTHER_ELEMENTS = {
    "lines": rb"\n[ \t]*l[ \t]", "points": rb"\n[ \t]*p[ \t]",
    FEW_CORNERS: rb"\n[ \t]*f(?:[ \t]+[-\d][^\s#]*+){1,2}+[ \t]*(?:#[^\n]*)?\r?(?=\n|\Z)",
}  # fmt: skip


def left_out(content: bytes) -> dict[str, int]:
    """{kind: count} of the elements of an OBJ, by statements, that are no surface."""
    return {kind: len(re.findall(form, content)) for kind, form in OTHER_ELEMENTS.items()}


USUAL_KD = {(0.0,) * 3, (0.8,) * 3, (1.0,) * 3}  # exporters write them beside a picture by habit


def _tints(material):
    """Whether the text of a material has a picture of colour and a Kd, by which others multiply the picture."""
    stated = re.search(r"(?mi)^\s*Kd\s+([-+.\deE \t]+?)\s*$", material)
    with suppress(ValueError):
        is_stated = stated is not None and tuple(map(float, stated[1].split())) not in USUAL_KD
        return is_stated and re.search(r"(?mi)^\s*map_Kd\s", material) is not None
    return False


def not_read(path: Path, has_colors: bool = False) -> list[str]:
    """Names the parts of an OBJ file and its materials that a Mesh cannot hold; returns no names for other files.

    Files that are not beside it, the pictures of other properties than colour, names, and what shines or is clear.
    has_colors: whether the Mesh has colours per vertex.
    """
    if path.suffix.lower() != ".obj":
        return []
    content = text_of(path.read_bytes()).encode()
    beside = SiblingFiles(trimesh.resolvers.FilePathResolver(str(path)))
    libraries = [name.decode(errors="replace") for kind, name in NAMES.findall(content) if kind.lower() == b"mtllib"]
    text: str | bytes = b""
    with suppress(OSError):
        text = beside.get(BETWEEN.join(libraries)) if libraries else b""
    names = [f"materials {name}, not beside it" for name in dict.fromkeys(beside.absent)]
    beside.absent.clear()
    with suppress(OSError):
        trimesh.exchange.obj.parse_mtl(text, beside)
    names += [f"picture {name}, not beside it" for name in dict.fromkeys(beside.absent)]
    words = text if isinstance(text, str) else text.decode(errors="replace")
    names += dict.fromkeys(OTHER_MAPS.findall(words))
    for kind, usual in LOOKS.items():
        values = re.findall(rf"(?mi)^\s*{kind}\s+([-+.\deE \t]+?)\s*$", words)
        with suppress(ValueError):
            names += [kind] * any(set(map(float, value.split())) - {usual} for value in values)
    names += ["Kd beside map_Kd"] * any(map(_tints, re.split(r"(?mi)^\s*newmtl\s", words)))
    options = [option for line in COLOUR_MAP.findall(words) for option in PLACED.findall(line)]
    names += [f"map_Kd {option}" for option in dict.fromkeys(options)]
    names += ["names of materials"] * (len(re.findall(r"(?mi)^\s*newmtl\s", words)) > 1)
    names += [kind for kind, count in left_out(content).items() if count]
    coloured = re.search(rb"(?m)^v(?:[ \t]+\S+){6,7}[ \t]*\r?$", content)
    return [*names, *(["colours of vertices"] * bool(coloured and not has_colors))]
