"""A .gltf file as one GLB, so that both have one reader: buffers and pictures beside the file are packed into it."""

from __future__ import annotations

import base64
import json
import struct
from pathlib import Path
from typing import Any
from urllib.parse import unquote, unquote_to_bytes

import numpy as np

from haptic_glance.base.lazy import trimesh

from .headers import ABSENT, MeshError, check_extensions
from .srgb import decoded, encoded

SUFFIXES = (".glb", ".gltf")
DATA = "data:"
KINDS = {b"\x89PNG": "image/png", b"\xff\xd8": "image/jpeg", b"RIFF": "image/webp"}  # of a picture, by its first bytes
ALIGNED = 4  # bytes, of the parts of a GLB
FLOAT, INTEGERS = 5126, {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2"}  # of the components of an accessor
IDS = 5125  # the kind of the vertices of faces
KINDS_OF_NUMBERS = INTEGERS | {IDS: "<u4", FLOAT: "<f4"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
TRIANGLES, FAN = 4, 6  # modes of primitives
NO_SURFACE = {0: "points", 1: "lines", 2: "lines", 3: "lines"}  # modes that are not read
INSTANCES = "EXT_mesh_gpu_instancing"
BENT = 1e-3  # of the entries of a joint's matrix: the joints of a file in its bind pose differ by rounding
GLOSS, TRANSFORM = "KHR_materials_pbrSpecularGlossiness", "KHR_texture_transform"
PLACE = ("matrix", "translation", "rotation", "scale")  # of a node
MALFORMED = ValueError, LookupError, TypeError, AttributeError, OverflowError, RecursionError  # of a damaged file


def as_glb(path: Path) -> bytes:
    """The bytes of a GLB or, as one, of a .gltf file; empty for other suffixes. Raises MeshError as `packed`."""
    suffix = path.suffix.lower()
    content = path.read_bytes() if suffix in SUFFIXES else b""
    resolver = trimesh.resolvers.FilePathResolver(str(path))
    return parser_bytes(packed(content, resolver) if suffix == ".gltf" else with_pictures(content, resolver))


def with_pictures(content: bytes, resolver: trimesh.resolvers.Resolver | None = None) -> bytes:
    """The bytes of a GLB with the pictures that lie beside it; one that is not there gets a mark. Else as `packed`."""
    try:
        tree, binary = opened(content)
        if not any("uri" in image for image in tree.get("images", [])):
            return content
        if any("uri" in buffer for buffer in tree["buffers"]):
            return content
        _pack_pictures(tree, binary, resolver)
        tree["buffers"][0]["byteLength"] = len(binary)
        return joined(tree, binary)
    except MALFORMED:  # the parser refuses it
        return content


def packed(content: bytes, resolver: trimesh.resolvers.Resolver | None = None) -> bytes:
    """The bytes of a GLB with what a .gltf file says and refers to (glTF 2.0, sections 3.6.1 and 4.4).

    resolver: reads the files beside it; None where there are none. Raises MeshError for what is no glTF, and for a
    buffer that is not there. A picture that is not there is left out; `materials.not_read` names it.
    """
    try:
        tree = json.loads(content)
        binary = _pack(tree, resolver)
    except MeshError:
        raise
    except MALFORMED as error:
        raise MeshError(f"unreadable as GLTF ({type(error).__name__} in its JSON)") from None
    return joined(tree, binary)


def parser_bytes(content: bytes) -> bytes:
    """The bytes of a GLB in the form that the parser reads (glTF 2.0, sections 3.5, 3.6.2 and 3.7).

    Meshes have the shape of their morph weights, and sparse accessors are full. Colours, which a glTF states linear,
    become those of sRGB, as pictures hold them, before the parser makes bytes of them. Texture coordinates are where
    the pictures of a material want them. Normalised integers and texture coordinates become floats, and fans single
    triangles. A mesh with a skin stands where its skin puts it in the pose of the file. A file without a scene shows
    all nodes. A malformed file stays as it is: the parser refuses it. Raises MeshError for malformed morph targets and
    sparse accessors, which the parser would read as zeros.
    """
    content = _morphed(content) if b'"sparse"' in content or b'"weights"' in content else content
    try:
        tree, binary = opened(content)
        before = json.dumps(tree)
        _as_srgb(tree, binary, content)
        _place_pictures(tree, binary, content)
        _as_floats(tree, binary, content)
        _as_triangles(tree, binary, content)
        _place_skins(tree, content)
        if "scenes" not in tree:
            tree["scenes"] = [{"nodes": _roots(tree)}]
        if json.dumps(tree) == before:
            return content
        tree["buffers"][0]["byteLength"] = len(binary)
        return joined(tree, binary)
    except MALFORMED:
        return content


def _morphed(content):
    """The bytes of a GLB with full accessors, whose nodes show the shape of their morph weights (section 3.7.2.2)."""
    try:
        tree, binary = opened(content)
        _show_weights(tree, binary, content)
        _fill(tree, binary, content)
        tree["buffers"][0]["byteLength"] = len(binary)
        return joined(tree, binary)
    except MALFORMED as error:
        where = "its morph targets or sparse accessors"
        raise MeshError(f"unreadable as GLB ({type(error).__name__} in {where})") from None


def _show_weights(tree, binary, content):
    """Gives each node with morph weights a mesh whose positions are moved towards its targets."""
    meshes, shapes = tree.get("meshes", []), {}
    for node in (node for node in tree.get("nodes", []) if "mesh" in node):
        mesh = meshes[node["mesh"]]
        weights = tuple(node.get("weights", mesh.get("weights", ())))
        key = node["mesh"], weights  # two nodes can show one mesh with different weights
        if any(weights) and key not in shapes:
            shapes[key] = len(meshes)
            parts = [_moved(tree, binary, content, part, weights) for part in mesh["primitives"]]
            meshes.append(mesh | {"primitives": parts})
        node["mesh"] = shapes.get(key, node["mesh"])


def _fill(tree, binary, content):
    """Makes the sparse accessors of attributes full ones; those of morph targets are read no more."""
    attributes = [primitive["attributes"] for mesh in tree.get("meshes", []) for primitive in mesh["primitives"]]
    for number in sorted({number for names in attributes for number in names.values()}):
        entry = tree["accessors"][number]
        if "sparse" in entry:
            tree["accessors"][number] = tree["accessors"][_new_accessor(tree, binary, _floats(tree, entry, content))]
    for entry in tree.get("accessors", []):
        entry.pop("sparse", None)


def _moved(tree, binary, content, primitive, weights):
    """A primitive whose positions are moved towards its targets."""
    attributes = primitive["attributes"]
    positions = _floats(tree, tree["accessors"][attributes["POSITION"]], content)
    for target, weight in zip(primitive.get("targets", []), weights, strict=False):
        if weight and "POSITION" in target:
            positions = positions + weight * _floats(tree, tree["accessors"][target["POSITION"]], content)
    return primitive | {"attributes": attributes | {"POSITION": _new_accessor(tree, binary, positions)}}


def _floats(tree, entry, content):
    """(n, d): the numbers of an accessor, integers that are normalised as -1..1."""
    values = numbers_of(tree, entry, content)
    return np.maximum(values / np.iinfo(values.dtype).max, -1) if entry.get("normalized") else values.astype(float)


def _as_srgb(tree, binary, content):
    """Encodes the linear colours of vertices and materials (sections 3.7.2.1 and 5.22.1), but not their alpha."""
    made = {}
    for primitive in _primitives(tree):
        number = primitive["attributes"].get("COLOR_0")
        if number is None or "bufferView" not in tree["accessors"][number]:  # none, or all are zero
            continue
        if number not in made:  # others may use the old accessor for something else
            values = _colours(tree, tree["accessors"][number], content)
            values[:, :3] = encoded(values[:, :3])
            made[number] = _new_accessor(tree, binary, values)
        primitive["attributes"]["COLOR_0"] = made[number]
    for material in tree.get("materials", []):
        _encode_factor(material.get("pbrMetallicRoughness", {}), "baseColorFactor")
        gloss = material.get("extensions", {}).get(GLOSS, {})
        if "diffuseTexture" not in gloss:  # the parser itself multiplies a picture
            _encode_factor(gloss, "diffuseFactor")


def _new_accessor(tree, binary, values):
    """The number of a new accessor of floats (n, d)."""
    kind = {"type": f"VEC{values.shape[1]}", "componentType": FLOAT, "count": len(values), "byteOffset": 0}
    tree["accessors"].append(kind | {"bufferView": _added(tree, binary, values.astype("<f4"))})
    return len(tree["accessors"]) - 1


def _place_pictures(tree, binary, content):
    """Makes the coordinates that all pictures of a material share those of the first set, moved and scaled.

    The parser reads the first set alone, and no KHR_texture_transform. Pictures of a material that differ, and those
    that are turned, stay as they are: `materials.not_read` names them.
    """
    for number, material in enumerate(tree.get("materials", [])):
        properties = material | material.get("pbrMetallicRoughness", {})
        uses = [use for use in properties.values() if isinstance(use, dict) and "index" in use]
        shared = [_coordinates_of(use) for use in uses] or [None]
        if shared[0] is None or shared[0] == (0, (0, 0), (1, 1)) or shared.count(shared[0]) < len(shared):
            continue
        place, offset, scale = shared[0]
        own, name = f"TEXCOORD_{place}", "TEXCOORD_0"
        users = [primitive["attributes"] for primitive in _primitives(tree) if primitive.get("material") == number]
        if not all(own in attributes for attributes in users):
            continue
        for attributes in users:
            values = _floats(tree, tree["accessors"][attributes.pop(own)], content)
            if name in attributes:  # another set, which no picture uses
                attributes[own] = attributes[name]
            attributes[name] = _new_accessor(tree, binary, values * scale + offset)
        for use in uses:
            use.pop("texCoord", None)
            use.get("extensions", {}).pop(TRANSFORM, None)


def _coordinates_of(use):
    """(set of coordinates, offset, scale) of a picture in a material; None of one that is turned."""
    transform = use.get("extensions", {}).get(TRANSFORM, {})
    if transform.get("rotation", 0) != 0:
        return None
    place = transform.get("texCoord", use.get("texCoord", 0))
    return place, tuple(transform.get("offset", (0, 0))), tuple(transform.get("scale", (1, 1)))


def _encode_factor(properties, name):
    if name in properties:
        properties[name] = encoded(np.array(properties[name][:3], float)).tolist() + properties[name][3:]


def with_linear_colours(content: bytes) -> bytes:
    """The bytes of a GLB of the parser, whose colours are sRGB, with linear ones: `parser_bytes` the other way round.

    Colours of vertices become floats: eight bits would lose dark ones, and the parser takes 16 bits for plain integers.
    """
    tree, binary = opened(content)
    for number in {primitive["attributes"].get("COLOR_0") for primitive in _primitives(tree)} - {None}:
        entry = tree["accessors"][number]
        values = _colours(tree, entry, content)
        values[:, :3] = decoded(values[:, :3])
        kind = {"type": entry["type"], "count": entry["count"], "componentType": FLOAT}
        tree["accessors"][number] = kind | {"bufferView": _added(tree, binary, values.astype("<f4")), "byteOffset": 0}
    for material in tree.get("materials", []):
        factor = material.get("pbrMetallicRoughness", {}).get("baseColorFactor")
        if factor is not None:
            factor[:3] = decoded(np.array(factor[:3])).round(9).tolist()
    tree["buffers"][0]["byteLength"] = len(binary)
    return joined(tree, binary)


def _colours(tree, entry, content):
    """(n, 3) or (n, 4) floats of 0..1: the colours of an accessor."""
    values = numbers_of(tree, entry, content)
    return values / np.float64(1 if values.dtype.kind == "f" else np.iinfo(values.dtype).max)


def _as_floats(tree, binary, content):
    """Makes floats of normalised integers and of texture coordinates: the parser takes them for plain integers."""
    for entry in tree.get("accessors", []):
        is_plain = entry["componentType"] not in INTEGERS or "bufferView" not in entry
        if is_plain or not (entry.get("normalized") or entry["type"] == "VEC2"):
            continue
        values = _floats(tree, entry, content)
        entry.pop("normalized", None)
        entry |= {"bufferView": _added(tree, binary, values.astype("<f4")), "byteOffset": 0, "componentType": FLOAT}


def _as_triangles(tree, binary, content):
    """Makes triangles of fans, which the parser leaves out."""
    for primitive in _primitives(tree):
        if primitive.get("mode") != FAN:
            continue
        count = tree["accessors"][primitive["attributes"]["POSITION"]]["count"]
        number = primitive.get("indices")
        ids = np.arange(count) if number is None else numbers_of(tree, tree["accessors"][number], content)[:, 0]
        faces = np.stack([np.full(len(ids) - 2, ids[0]), ids[1:-1], ids[2:]], axis=1).astype(KINDS_OF_NUMBERS[IDS])
        primitive |= {"mode": TRIANGLES, "indices": len(tree["accessors"])}
        view = _added(tree, binary, faces)
        tree["accessors"].append(
            {"bufferView": view, "componentType": IDS, "type": "SCALAR", "count": faces.size, "byteOffset": 0}
        )


def _added(tree, binary, values):
    """The number of a new view of the buffer that holds these values."""
    binary += b"\0" * (-len(binary) % ALIGNED)
    tree["bufferViews"].append({"buffer": 0, "byteOffset": len(binary), "byteLength": values.nbytes})
    binary += values.tobytes()
    return len(tree["bufferViews"]) - 1


def _place_skins(tree, content):
    """Gives each node with a skin the place that the first joint of its skin has: its own place says nothing."""
    nodes = tree.get("nodes", [])
    skinned = [number for number, node in enumerate(nodes) if "skin" in node and "mesh" in node]
    parents = _parents(tree)
    places = {number: _joint_place(tree, tree["skins"][nodes[number]["skin"]], 0, content) for number in skinned}
    for number, place in places.items():
        node, root = nodes[number], number
        for _ in nodes:
            root = parents.get(root, root)
        if root != number or "children" in node:  # the mesh gets a node of its own: children stay at their place
            nodes.append({key: node.pop(key) for key in ("name", "mesh") if key in node})
            node = nodes[-1]
            for scene in tree.get("scenes", []):
                scene["nodes"] += [len(nodes) - 1] * (root in scene["nodes"])
        for key in PLACE:
            node.pop(key, None)
        node["matrix"] = [round(value, 9) for value in place.T.ravel().tolist()]


def _parents(tree):
    return {child: number for number, node in enumerate(tree.get("nodes", [])) for child in node.get("children", [])}


def _joint_place(tree, skin, order, content):
    """(4, 4): the place to which a joint of a skin, by its order, moves the mesh."""
    nodes, parents, joint, place = tree["nodes"], _parents(tree), skin["joints"][order], np.eye(4)
    if "inverseBindMatrices" in skin:
        place = numbers_of(tree, tree["accessors"][skin["inverseBindMatrices"]], content)[order].reshape(4, 4).T
    for _ in nodes:  # nodes of a damaged file may form a ring
        if joint is not None:
            place, joint = _matrix(nodes[joint]) @ place, parents.get(joint)
    return place


def left_out(content: bytes) -> dict[str, int]:
    """{kind: count} of the parts of a GLB that change its shape and that the parser leaves out; empty where malformed.

    Primitives of points and of lines, meshes of the scenes that are not shown, instances, and skins whose joints stand
    apart in the pose of the file: `parser_bytes` moves the mesh of such a skin by the first joint alone.
    """
    try:
        tree, _ = opened(content)
        nodes, shown = tree.get("nodes", []), _shown(tree)
        drawn = [nodes[number] for number in sorted(shown) if "mesh" in nodes[number]]
        modes = [part.get("mode") for node in drawn for part in tree["meshes"][node["mesh"]]["primitives"]]
        kinds = [NO_SURFACE[mode] for mode in modes if mode in NO_SURFACE]
        instances = [node.get("extensions", {}).get(INSTANCES, {}).get("attributes", {}) for node in drawn]
        accessors = [next(iter(attributes.values())) for attributes in instances if attributes]
        skins = [tree["skins"][number] for number in {node["skin"] for node in drawn if "skin" in node}]
        return {kind: kinds.count(kind) for kind in sorted(set(kinds))} | {
            "meshes of further scenes": sum("mesh" in node for node in nodes) - len(drawn),
            "instances": sum(tree["accessors"][number]["count"] for number in accessors),
            "poses of skins": sum(_bends(tree, skin, content) for skin in skins),
        }
    except MALFORMED:
        return {}


def _shown(tree):
    """The nodes of the scene that the parser reads, with all nodes below."""
    scenes = tree.get("scenes")
    waiting, shown = list(scenes[tree.get("scene", 0)].get("nodes", []) if scenes else _roots(tree)), set()
    while waiting:
        number = waiting.pop()
        waiting += [] if number in shown else tree["nodes"][number].get("children", [])
        shown.add(number)
    return shown


def _bends(tree, skin, content):
    """Whether the joints of a skin put a mesh at places that differ."""
    places = np.stack([_joint_place(tree, skin, order, content) for order in range(len(skin["joints"]))])
    return bool(np.abs(places - places[0]).max() > BENT * (1 + np.abs(places[0]).max()))


def _matrix(node):
    """(4, 4): the place of a node below its parent."""
    if "matrix" in node:
        return np.array(node["matrix"], dtype=np.float64).reshape(4, 4).T
    place = np.eye(4)
    if "rotation" in node:
        x, y, z, w = node["rotation"]
        place = trimesh.transformations.quaternion_matrix([w, x, y, z])
    place[:3, :3] *= np.array(node.get("scale", [1, 1, 1]))
    place[:3, 3] = node.get("translation", [0, 0, 0])
    return place


def _roots(tree):
    """The nodes that are below no other node."""
    children = {child for node in tree["nodes"] for child in node.get("children", [])}
    return [number for number in range(len(tree["nodes"])) if number not in children]


def numbers_of(tree: dict[str, Any], accessor: dict[str, Any], content: bytes) -> np.ndarray:
    """(n, width): the numbers of an accessor of a GLB with this tree, as the bytes store them.

    A sparse one is a full one, or zeros, with some other numbers (section 3.6.2.3). Raises LookupError, TypeError or
    ValueError for a malformed one.
    """
    kind, width = np.dtype(KINDS_OF_NUMBERS[accessor["componentType"]]), WIDTHS[accessor["type"]]
    if "sparse" in accessor:
        full, sparse = {key: value for key, value in accessor.items() if key != "sparse"}, accessor["sparse"]
        is_zero = "bufferView" not in full
        values = np.zeros((full["count"], width), kind) if is_zero else numbers_of(tree, full, content).copy()
        ids = sparse["indices"] | {"type": "SCALAR", "count": sparse["count"]}
        others = {"type": full["type"], "componentType": full["componentType"], "count": sparse["count"]}
        values[numbers_of(tree, ids, content)[:, 0]] = numbers_of(tree, sparse["values"] | others, content)
        return values
    view = tree["bufferViews"][accessor["bufferView"]]
    strides = view.get("byteStride", width * kind.itemsize), kind.itemsize
    first = 28 + int.from_bytes(content[12:16], "little") + view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    return np.ndarray((accessor["count"], width), kind, content, first, strides)


def _primitives(tree):
    return [primitive for mesh in tree.get("meshes", []) for primitive in mesh["primitives"]]


def opened(content: bytes) -> tuple[dict[str, Any], bytearray]:
    """(tree, buffer) of the bytes of a GLB; ValueError for other bytes."""
    start = 20 + int.from_bytes(content[12:16], "little")
    return json.loads(content[20:start]), bytearray(content[start + 8 :])


def joined(tree: dict[str, Any], binary: bytearray) -> bytes:
    """The bytes of a GLB of a tree and its one buffer."""
    text = json.dumps(tree).encode()
    text += b" " * (-len(text) % ALIGNED)
    length = 12 + 8 + len(text) + 8 + len(binary)
    head = struct.pack("<4sII", b"glTF", 2, length) + struct.pack("<I4s", len(text), b"JSON")
    return head + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary


def _pack(tree: dict[str, Any], resolver: trimesh.resolvers.Resolver | None) -> bytearray:
    """One buffer for all that the tree refers to; the tree refers to that buffer afterwards."""
    check_extensions(tree)
    binary, starts = bytearray(), []
    for buffer in tree.get("buffers", []):
        data, name = _read(buffer["uri"], resolver), _name(buffer["uri"])
        if data is None:
            raise MeshError(f"refers to {name}, which is not beside it: keep both together, or export a .glb")
        if len(data) < buffer.get("byteLength", 0):
            raise MeshError(f"{name} is truncated: {len(data)} of {buffer['byteLength']} bytes")
        starts.append(len(binary))
        binary += _aligned(data)
    for view in tree.get("bufferViews", []):
        view |= {"byteOffset": starts[view["buffer"]] + view.get("byteOffset", 0), "buffer": 0}
    _pack_pictures(tree, binary, resolver)
    tree["buffers"] = [{"byteLength": len(binary)}]
    return binary


def _pack_pictures(tree, binary, resolver):
    """Moves the pictures of URIs into the buffer; names those that are not there."""
    for image in tree.get("images", []):
        if "uri" not in image:
            continue
        data, name = _read(image["uri"], resolver), _name(image["uri"])
        if data is None:
            image[ABSENT] = name
            continue
        if image["uri"][: len(DATA)].lower() != DATA:
            image.setdefault("name", name)
        kind = next((kind for start, kind in KINDS.items() if data.startswith(start)), image.get("mimeType", ""))
        del image["uri"]
        image |= {"bufferView": len(tree.setdefault("bufferViews", [])), "mimeType": kind}
        tree["bufferViews"].append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(data)})
        binary += _aligned(data)


def _read(uri: str, resolver: trimesh.resolvers.Resolver | None) -> bytes | None:
    """The bytes that a URI stands for; None where they are not at hand."""
    if uri[: len(DATA)].lower() == DATA:
        head, _, body = uri.partition(",")
        return base64.b64decode(unquote(body)) if head.lower().endswith(";base64") else unquote_to_bytes(body)
    try:
        return resolver and resolver.get(unquote(uri))
    except (OSError, ValueError, KeyError):  # not there, not below the folder of the file, not in the archive
        return None


def names_in(content: bytes) -> list[str]:
    """The names of the files that a .gltf file or a GLB refers to; none of what is no glTF."""
    try:
        tree = opened(content)[0] if content[:4] == b"glTF" else json.loads(content)
        uris = [entry["uri"] for key in ("buffers", "images") for entry in tree.get(key, []) if "uri" in entry]
        return [unquote(uri) for uri in uris if uri[: len(DATA)].lower() != DATA]
    except (ValueError, TypeError, AttributeError):
        return []


def _name(uri: str) -> str:
    return unquote(uri) if len(uri) < 200 else f"{uri[:20]}..."


def _aligned(data: bytes) -> bytes:
    return data + b"\0" * (-len(data) % ALIGNED)
