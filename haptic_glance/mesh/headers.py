"""Refuses a mesh file whose header states more than the file holds, before a parser allocates what it states."""

import io
import json
import re
import struct
from typing import Any

from PIL import Image

MOST_PRIMITIVES = 20_000  # of a GLB, counted at each node that shows them: the parser needs milliseconds for each
# Extensions of a glTF that are read, or whose loss changes no shape and is named by `materials.not_read`.
EXTENSIONS = ("KHR_mesh_quantization", "KHR_materials_", "KHR_texture_", "EXT_texture_", "KHR_lights_", "KHR_xmp")
ABSENT = "absent"  # key of a picture of a glTF that is not at hand: its name
MAX_TEXTURE = 8192  # pixels, of a square texture
PLY_BYTES = {b"short": 2, b"ushort": 2, b"int": 4, b"uint": 4, b"float": 4, b"double": 8}
PLY_BYTES |= {b"int16": 2, b"uint16": 2, b"int32": 4, b"uint32": 4, b"float32": 4, b"float64": 8}
DENSEST = 100  # bytes that one compressed byte of a PCD can hold: LZF writes three bytes for 264


class MeshError(ValueError):
    """A mesh that cannot be used. The message states the reason; the caller adds the name of the file."""


def check_header(content: bytes, suffix: str) -> None:
    """Raises MeshError for a file shorter than its header states: parsers accept it, or their message is unclear."""
    if suffix in CHECKS:
        CHECKS[suffix](content)


def _glb(content):
    if content[:4] != b"glTF" or len(content) < 20:
        raise MeshError("unreadable as GLB (no glTF header)")
    length, chunk = struct.unpack("<8xII4x", content[:20])
    if length > len(content):
        raise MeshError(f"truncated: {len(content)} of {length} bytes")
    try:
        tree = json.loads(content[20 : 20 + chunk])
        check_extensions(tree)
        counts = [accessor["count"] for accessor in tree.get("accessors", [])]
        stated_count = max((int(count) for count in counts), default=0)
        sizes = [len(mesh["primitives"]) for mesh in tree.get("meshes", [])]
        primitives = sum(sizes[node["mesh"]] for node in tree.get("nodes", []) if "mesh" in node)
    except MeshError:
        raise
    except (ValueError, LookupError, TypeError, AttributeError, RecursionError, OverflowError) as error:
        raise MeshError(f"unreadable as GLB ({type(error).__name__} in its JSON part)") from None
    if stated_count > len(content):
        raise MeshError(f"truncated: its header states {stated_count} numbers, the file has {len(content)} bytes")
    if primitives > MOST_PRIMITIVES:
        raise MeshError(
            f"{primitives:,} primitives are more than {MOST_PRIMITIVES:,}: join its parts in the program that wrote it"
        )
    for picture in _colour_pictures(tree):
        _check_picture(tree, picture, content[20 + chunk + 8 :])


def check_extensions(tree: dict[str, Any]) -> None:
    """Raises MeshError for a glTF whose shape only an extension tells: the parser would read zeros, or nothing."""
    extensions = [name for name in map(str, tree.get("extensionsRequired") or ()) if not name.startswith(EXTENSIONS)]
    if extensions:
        pressed = any("compression" in name or "draco" in name for name in extensions)
        remedy = "compression" if pressed else "it" if len(extensions) == 1 else "them"
        raise MeshError(f"needs {', '.join(extensions)}, which is not read: export it without {remedy}")


def _colour_pictures(tree):
    """The indices of the pictures that colour a material of a GLB; what is malformed is left to the parser."""
    indices = set()
    for material in tree.get("materials", []):
        try:
            indices.add(int(tree["textures"][material["pbrMetallicRoughness"]["baseColorTexture"]["index"]]["source"]))
        except (LookupError, TypeError, ValueError):
            continue
    return indices


def _check_picture(tree, picture, binary):
    """Raises MeshError for a picture that would fill the memory: the parser decodes it, or drops it without a word."""
    limit = f"larger than {MAX_TEXTURE:,} x {MAX_TEXTURE:,}"
    try:
        view = tree["bufferViews"][tree["images"][picture]["bufferView"]]
        start = view.get("byteOffset", 0)
        width, height = Image.open(io.BytesIO(binary[start : start + view["byteLength"]])).size
    except Image.DecompressionBombError:  # Pillow has a limit of its own, above this one
        raise MeshError(f"a texture is {limit} pixels: scale it down") from None
    except (LookupError, TypeError, ValueError, AttributeError, OSError):
        return
    if width * height > MAX_TEXTURE**2:
        raise MeshError(f"a texture of {width:,} x {height:,} pixels is {limit}: scale it down")


def _stl(content):
    if _in_words(content):
        if b"endsolid" not in content.lower():
            raise MeshError("truncated: an ASCII STL without endsolid")
        return
    if len(content) < 84:
        raise MeshError(f"truncated: {len(content)} bytes are fewer than an STL header")
    stated_count, actual_count = struct.unpack("<I", content[80:84])[0], (len(content) - 84) // 50
    if stated_count > actual_count:
        raise MeshError(f"truncated or not an STL: the header states {stated_count} faces, {actual_count} follow")


def stated_faces(content: bytes) -> bytes:
    """An STL's bytes without those that some programs write behind the faces of a binary one.

    A binary one that states no faces has all that follow: its program did not go back to write their number.
    """
    if _in_words(content):
        return content
    face_count = struct.unpack("<I", content[80:84])[0] or (len(content) - 84) // 50
    return content[:80] + struct.pack("<I", face_count) + content[84 : 84 + 50 * face_count]


def _in_words(content):
    is_binary = len(content) >= 84 and len(content) == 84 + 50 * struct.unpack("<I", content[80:84])[0]
    return not is_binary and content.lstrip()[:5].lower() == b"solid" and b"facet" in content.lower()


def _ply(content):
    header, _, body = content.partition(b"end_header")
    binary = b"format binary" in header
    rows = count = byte_count = 0  # rows of all elements, of this one, and the bytes that they need
    for words in map(bytes.split, header.splitlines()):
        if words[:1] == [b"element"] and len(words) == 3 and words[2].isdigit():
            count = int(words[2][:18])
            rows += count
        elif binary and words[:1] == [b"property"] and len(words) > 2:
            byte_count += count * PLY_BYTES.get(words[2 if words[1] == b"list" else 1], 1)  # a list may be empty
    if max(rows, byte_count) > len(body):
        minimum = f", {byte_count} bytes or more" if byte_count else ""
        raise MeshError(f"truncated: its header states {rows} vertices and faces{minimum}, {len(body)} bytes follow")


def _obj(content):
    # More digits than the length of the file has: no such vertex can exist, and the parser makes a table up to it.
    for match in re.finditer(rb"[ \t/]-?(\d{%d,})(?=[\s/]|$)" % (len(str(len(content))) + 1), content):
        if content[content.rfind(b"\n", 0, match.start()) + 1 :].lstrip()[:1] == b"f":
            raise MeshError(f"faces name vertices that do not exist ({match[1][:20].decode()})")


def _pcd(content):
    header, _, body = content.partition(b"\nDATA ")
    point_match = re.search(rb"^\W*points\s+(\d+)", header, re.M | re.I)
    if any(
        len(number) > 3 for line in re.findall(rb"^\W*count\s(.*)$", header, re.M | re.I) for number in line.split()
    ):
        raise MeshError("unreadable as PCD (more than 999 numbers in one field of a point)")
    kind, _, data = body.partition(b"\n")
    byte_count = len(data)
    if kind.strip() not in (b"ascii", b"binary", b"binary_compressed"):
        raise MeshError("unreadable as PCD (its data are neither ascii nor binary nor binary_compressed)")
    if kind.strip() == b"binary_compressed" and len(data) >= 8:
        byte_count = struct.unpack("<4xI", data[:8])[0]
        if byte_count > DENSEST * len(data):
            raise MeshError(f"truncated: its header states {byte_count} bytes, {len(data)} compressed ones follow")
    if point_match and int(point_match[1]) > byte_count:
        raise MeshError(f"truncated: its header states {int(point_match[1])} points, {byte_count} bytes follow")


def _las(content):
    if len(content) < 227 or content[:4] != b"LASF":
        raise MeshError("unreadable as LAS (no LASF header)")
    size, start, records, length, points = struct.unpack("<HIIxHI", content[94:111])
    if content[25] >= 4 and len(content) >= 375:  # version 1.4 has wider numbers besides
        extended_count, points = struct.unpack("<IQ", content[243:255])
        records += extended_count
    if size + 54 * records > len(content) or start + length * points > len(content):
        raise MeshError(f"truncated: its header states {points} points, {records} records, the file has {len(content)}"
                        " bytes")  # fmt: skip


CHECKS = {".las": _las, ".glb": _glb, ".pcd": _pcd, ".obj": _obj, ".stl": _stl, ".ply": _ply}
