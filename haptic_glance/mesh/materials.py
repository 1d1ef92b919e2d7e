"""Materials and colours of a mesh, and the join of parts that a file splits by material or at texture seams.

A material shows its colour or its picture of colour: Kd and map_Kd, baseColorFactor and baseColorTexture. The other
properties of a glTF material are carried along, and their pictures stay undecoded.
"""

from __future__ import annotations

import io
import zlib
from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np
from PIL import Image

from haptic_glance.base.lazy import trimesh

from .gltf import GLOSS, INSTANCES, MALFORMED, NO_SURFACE, joined, numbers_of, opened
from .headers import ABSENT, MAX_TEXTURE, MeshError
from .mesh import MOST_UV, Mesh, Texture, content_of
from .srgb import decoded, multiplied

FACTORS = (
    "name", "baseColorFactor", "metallicFactor", "roughnessFactor", "emissiveFactor", "alphaMode", "alphaCutoff",
    "doubleSided",
)  # fmt: skip
MAPS = ("normalTexture", "metallicRoughnessTexture", "occlusionTexture", "emissiveTexture")
WHITE, GREY = (255, 255, 255, 255), (204, 204, 204, 255)  # colours of no material: in a GLB, in other files
COLOURS_OF = {"baseColorFactor", "baseColorTexture"}
BRIGHT = 2  # a float colour above it is one of 0..255: computed ones of 0..1 may end a little above 1
BESIDE = "beside_colour"  # in the metadata of a part
MIDDLE = 0.01  # pixels from the middle of one, below which texture coordinates of single precision mean the middle
OF_NO_MATERIAL = {"doubleSided": False}  # a part of a GLB without a material has glTF's default one, which is white


def beside_colour(material: Any) -> dict[str, Any] | None:
    """The other properties of a glTF material, as arguments of trimesh's PBRMaterial; None of other materials.

    A picture is the bytes of its file where that is a PNG or JPEG that was not decoded, and else the PIL image. The
    picture of colour, which is an image of the Texture, is the bytes of its file, and else True.
    """
    if not isinstance(material, trimesh.visual.material.PBRMaterial):
        return None
    properties = {name: getattr(material, name) for name in FACTORS} | {
        name: _file(getattr(material, name)) for name in MAPS
    }
    if material.baseColorTexture is not None:
        content = _file(material.baseColorTexture)
        properties["baseColorTexture"] = content if isinstance(content, bytes) else True
    return {name: value for name, value in properties.items() if value is not None}


def _file(image):
    content = getattr(getattr(image, "fp", None), "getvalue", None)
    return content() if content and image.format in ("PNG", "JPEG") else image


def set_apart(loaded: trimesh.parent.Geometry, content: bytes = b"") -> list[str]:
    """Moves all pictures but those of colour from the materials of a file's Scene to the metadata of its parts.

    A copy of a part, as `join_parts` makes, would decode them. content: the bytes of a GLB, whose pictures on another
    set of texture coordinates than the first are left out. Returns the names of unreadable pictures, which are left
    out, too.
    """
    parts = [part for part in getattr(loaded, "geometry", {}).values() if isinstance(part, trimesh.Trimesh)]
    materials = {id(part): getattr(part.visual, "material", None) for part in parts}
    tree = _header(content)
    unreadable = [name for name, picture in _pictures(tree, content) if not _is_readable(picture)]
    elsewhere, stated = _on_other_coordinates(tree), _stated_in(tree, "materials")
    left_out, exact = {}, {}
    if stated:  # the names are those of `numbered`
        of_file: dict[int, Any] = {id(part): part for part in materials.values() if getattr(part, "name", None)}
        for material in of_file.values():  # a part without a material has none, or one without a name
            entry = stated[int(material.name)]
            left_out[id(material)] = elsewhere[int(material.name)] if elsewhere else ()
            exact[id(material)] = _exact_factor(entry)
            material.name = entry.get("name")
    for part in parts:
        properties, unplaced = beside_colour(materials[id(part)]), left_out.get(id(materials[id(part)]), ())
        properties = properties and {k: v for k, v in properties.items() if k not in unplaced}
        properties = properties and properties | exact.get(id(materials[id(part)]), {})
        part.metadata[BESIDE] = properties or (dict(OF_NO_MATERIAL) if tree else None)
    for material in {id(material): material for material in materials.values() if material is not None}.values():
        if isinstance(material, trimesh.visual.material.PBRMaterial):
            for name in MAPS:
                setattr(material, name, None)
        for name in ("baseColorTexture", "image"):
            image = getattr(material, name, None)
            _check_size(image)
            if image is not None and not _is_readable(image):
                of_it = f"of the material {material.name}" if material.name else "of a material without a name"
                unreadable.append(of_it)
                setattr(material, name, None)
                for part in parts:
                    if materials[id(part)] is material and part.metadata[BESIDE]:
                        part.metadata[BESIDE].pop(name, None)
    return unreadable


def numbered(content: bytes) -> bytes:
    """The bytes of a GLB whose materials have their numbers as names.

    Names may be equal, or absent: `set_apart` tells the materials apart by the numbers, and gives the names back.
    """
    if not _stated_in(_header(content), "materials"):
        return content
    tree, binary = opened(content)
    for number, material in enumerate(_stated_in(tree, "materials")):
        material["name"] = str(number)
    return joined(tree, binary)


def _exact_factor(material):
    """The linear factor of colour of a GLB material: `gltf.parser_bytes` encoded it, the parser made bytes of it."""
    with suppress(*MALFORMED):
        factor = np.array(material["pbrMetallicRoughness"]["baseColorFactor"], dtype=np.float64)
        if factor.shape == (4,) and GLOSS not in material.get("extensions", {}):
            return {"baseColorFactor": np.append(decoded(factor[:3]), factor[3]).round(9)}
    return {}


def _on_other_coordinates(tree):
    """[names of the pictures that a material has on another set of texture coordinates]; empty where none has any."""
    names = []
    with suppress(*MALFORMED):
        names = [
            {name for name, use in _uses(material) if use.get("texCoord")} for material in _stated_in(tree, "materials")
        ]
    return names if any(names) else []


def _pictures(tree, content):
    """Yields (name, bytes) of the pictures in a GLB; what is malformed is left to the parser."""
    start, views = 28 + int.from_bytes(content[12:16], "little"), _stated_in(tree, "bufferViews")
    for number, entry in enumerate(_stated_in(tree, "images")):
        with suppress(*MALFORMED):
            view = views[entry["bufferView"]]
            first = start + view.get("byteOffset", 0)
            yield str(entry.get("name", f"number {number}")), content[first : first + view["byteLength"]]


def _is_readable(picture):
    """Whether Pillow can read the head of a picture's bytes, or decode a picture, which then stays decoded."""
    try:
        Image.open(io.BytesIO(picture)) if isinstance(picture, bytes) else picture.load()
    except Image.DecompressionBombError:
        return True  # too large for a colour, which `_check_size` says; the others stay undecoded
    except (OSError, SyntaxError, ValueError):
        return False
    return True


def pixels_of(image: Image.Image) -> np.ndarray:
    """(h, w, 4) u1: the pixels of a picture, which may have 16 bits of grey: Pillow would clip them to white."""
    if image.mode.startswith("I"):
        image = Image.fromarray(np.clip(np.asarray(image) // 257, 0, 255).astype(np.uint8))
    return np.asarray(image.convert("RGBA"))


USUAL = {"scale": 1, "strength": 1, "texCoord": 0}  # of a use of a picture
USUAL_SAMPLER = {"wrapS": 10497, "wrapT": 10497, "magFilter": 9729}  # repeated; interpolated between pixels
READ = (GLOSS, "EXT_texture_webp")  # extensions that trimesh reads
OF_THE_SCENE = ("KHR_lights_", "KHR_node_", "KHR_xmp", "KHR_materials_variants", INSTANCES, "MSFT_lod")
KEPT_BESIDE_COLOURS = ("baseColorFactor", "pbrMetallicRoughness", "extensions", "extras")
WITH_EXTRAS = ("nodes", "materials")  # trimesh writes them for each mesh
DERIVED = ("POSITION", "NORMAL", "TANGENT", "TEXCOORD_0")  # attributes of vertices that are kept, or follow from others


def not_read(content: bytes, has_colors: bool = False) -> list[str]:
    """Names the properties of a GLB's materials and vertices that a Mesh cannot hold, and animations and the like.

    has_colors: whether the Mesh has colours per vertex, which stand for the materials.
    """
    tree = _header(content)
    names = [name for name in ("animations", "skins", "cameras") if _stated_in(tree, name)]
    names += ["further scenes"] * (len(_stated_in(tree, "scenes")) > 1)
    names += ["extras"] * any("extras" in entry for kind in WITH_EXTRAS for entry in _stated_in(tree, kind))
    extensions = tree.get("extensionsUsed") if isinstance(tree, dict) else None
    whole = map(str, extensions) if isinstance(extensions, list) else ()  # extensions of the scene
    names += [name for name in whole if name.startswith(OF_THE_SCENE)]
    names += [f"picture {entry[ABSENT]}, not beside it" for entry in _stated_in(tree, "images") if ABSENT in entry]
    with suppress(*MALFORMED):
        names += ["asset.copyright"] if tree["asset"].get("copyright") else []
    textures, samplers = (_stated_in(tree, name) for name in ("textures", "samplers"))
    with suppress(*MALFORMED):
        primitives = [primitive for mesh in _stated_in(tree, "meshes") for primitive in mesh["primitives"]]
        materials = _stated_in(tree, "materials")
        if has_colors:
            names += [name for material in materials for name in _flat(material) if name not in KEPT_BESIDE_COLOURS]
        for primitive in primitives:
            attributes = primitive["attributes"]
            # without a material they become those of the Mesh, or a picture
            has_place = has_colors or "material" not in primitive
            has_place = has_place or _is_white(tree, attributes.get("COLOR_0"), content)
            names += [name for name in attributes if name not in DERIVED and not (name == "COLOR_0" and has_place)]
        names += [NO_SURFACE[entry["mode"]] for entry in primitives if entry.get("mode") in NO_SURFACE]
        names += ["morph targets"] * any(primitive.get("targets") for primitive in primitives)
        for material in materials:
            names += material.get("extensions", {})
            for name, use in _uses(material):
                texture = textures[use["index"]]
                sampler = samplers[texture["sampler"]] if "sampler" in texture else {}
                names += [f"{name}.{key}" for key, usual in USUAL.items() if use.get(key, usual) != usual]
                names += [f"{name}.{key}" for key, usual in USUAL_SAMPLER.items() if sampler.get(key, usual) != usual]
                names += [f"{name}.{key}" for key in (use.get("extensions", {}) | texture.get("extensions", {}))]
    return [name for name in dict.fromkeys(names) if not name.endswith(READ)]


def _is_white(tree, accessor, content):
    """Whether an accessor, by its number, holds white alone, which changes no material."""
    with suppress(*MALFORMED):
        numbers = numbers_of(tree, tree["accessors"][accessor], content)
        return bool((numbers == (1 if numbers.dtype.kind == "f" else np.iinfo(numbers.dtype).max)).all())
    return False


def _header(content):
    """The JSON part of a GLB's bytes; empty for others."""
    try:
        return opened(content)[0] if content[:4] == b"glTF" else {}
    except ValueError:
        return {}


def _stated_in(tree, name):
    """The dicts in the list of a name."""
    entries = tree.get(name) if isinstance(tree, dict) else None
    return [entry for entry in entries if isinstance(entry, dict)] if isinstance(entries, list) else []


def _uses(material):
    """[(name of a picture, how a glTF material uses it)]."""
    return [(name, use) for name, use in _flat(material).items() if isinstance(use, dict) and "index" in use]


def _flat(material):
    """The properties of a glTF material and of its metal and roughness, in one dict."""
    return material | material.get("pbrMetallicRoughness", {})


def join_parts(
    loaded: trimesh.parent.Geometry, order: np.ndarray | None = None, every_colour: bool = False
) -> Mesh | None:
    """One Mesh of a loaded Trimesh or Scene; vertices with equal position and colour are merged. None without faces.

    Texture coordinates stay per face corner. order: (n, 3) vertices in the order of the file, whose ids the merged
    vertices take; None numbers them by first appearance. every_colour: the texture has the colours per vertex, too, of
    parts that stand beside others with materials, or that have a plain material.
    """
    parts = _placed(loaded) if isinstance(loaded, trimesh.Scene) else [loaded]
    parts = [part for part in parts if isinstance(part, trimesh.Trimesh) and len(part.faces)]
    if not parts:
        return None
    starts = np.cumsum([0, *(len(part.vertices) for part in parts)])
    faces = np.concatenate([part.faces + start for part, start in zip(parts, starts, strict=False)])
    vertices = np.concatenate([part.vertices for part in parts])
    colors = _colours_of_all(parts)
    if colors is not None and _tears(parts, vertices, faces, colors):
        colors = None
    if every_colour and colors is None:
        parts = [_as_picture(part) for part in parts]
    texture = texture_of(parts) if colors is None else None
    if order is not None and colors is None:
        first, ids = merge_equal_rows(np.concatenate([order, vertices]))
        if first.max() < len(order):
            return Mesh(order, first[ids[len(order) :]][faces], None, texture)
    first, ids = merge_equal_rows(vertices if colors is None else np.column_stack([vertices, colors]))
    return Mesh(vertices[first], ids[faces], None if colors is None else colors[first], texture)


def _placed(scene):
    """The meshes of a Scene at their places, as its `dump` has them, which copies the picture of each."""
    parts = []
    for transform, name in map(scene.graph.get, scene.graph.nodes_geometry):
        source = scene.geometry[name]
        if isinstance(source, trimesh.Trimesh):
            visual = source.visual
            part = source.copy(include_visual=not isinstance(visual, trimesh.visual.TextureVisuals))
            if isinstance(visual, trimesh.visual.TextureVisuals):
                part.visual = trimesh.visual.TextureVisuals(visual.uv, visual.material)
                if "color" in visual.vertex_attributes:
                    part.visual.vertex_attributes["color"] = visual.vertex_attributes["color"]
                part.vertex_attributes.update(source.vertex_attributes)
            parts.append(part.apply_transform(transform))
    return parts


def _colours_of_all(parts):
    """(n, 3) u1 of the vertices of all parts where one has colours per vertex and none has a picture; else None.

    As in glTF, the plain colour of a material is a factor, and a part without colours is white.
    """
    if any(_colours_per_vertex(part) is not None for part in parts) and all(map(_is_plain, parts)):
        return np.concatenate([_plain_colours(part) for part in parts])
    return None


def _tears(parts, vertices, faces, colors):
    """Whether colours beside materials would open the surface: two colours at one place are two vertices."""
    if all(isinstance(part.visual, trimesh.visual.ColorVisuals) for part in parts):
        return False
    used = np.unique(faces)
    rows = vertices[used]
    return len(np.unique(np.column_stack([rows, colors[used]]), axis=0)) > len(np.unique(rows, axis=0))


def _colours_per_vertex(part):
    """(n, 3) u1 or None: the colours of a part's vertices, also of those beside a glTF material.

    White beside a material, as many programs write it, says nothing.
    """
    beside = getattr(part.visual, "vertex_attributes", {}).get("color")
    if beside is None:
        return vertex_colors(part)
    colors = trimesh.visual.color.to_rgba(beside)[:, :3]
    return None if (colors == 255).all() else colors


def _is_plain(part):
    """Whether a part has neither a picture nor colours of its faces nor a material other than glTF's."""
    if isinstance(part.visual, trimesh.visual.ColorVisuals):
        return part.visual.kind != "face"
    material = getattr(part.visual, "material", None)
    without_picture = getattr(material, "baseColorTexture", None) is None or part.visual.uv is None
    return isinstance(material, trimesh.visual.material.PBRMaterial) and without_picture


def _plain_colours(part):
    """(n, 3) u1: the colours of a part's vertices, white by default, times the colour of its material."""
    colors, factor = _colours_per_vertex(part), getattr(getattr(part.visual, "material", None), "baseColorFactor", None)
    colors = np.full((len(part.vertices), 3), 255, dtype=np.uint8) if colors is None else colors
    return colors if factor is None else multiplied(colors, decoded(np.asarray(factor)[:3] / 255))


def vertex_colors(part: trimesh.Trimesh, of_faces: bool = False) -> np.ndarray | None:
    """(n, 3) u1, or None when the colours are not per vertex. of_faces: else the mean of the faces around a vertex."""
    visual = part.visual
    kinds = ("vertex", "face") if of_faces else ("vertex",)
    if isinstance(visual, trimesh.visual.ColorVisuals) and visual.kind in kinds:
        return visual.vertex_colors[:, :3]
    return None


def scale_colors(parts: list[dict[str, Any]]) -> None:
    """Makes bytes of the colours in arguments of Trimesh, where they are of 0..65535, or floats of 0..255.

    The others, bytes and floats of 0..1, stay as they are: trimesh takes all colours for one of these.
    """
    for name in ("vertex_colors", "face_colors"):
        coloured_parts = [part for part in parts if part.get(name) is not None]
        highest = max((np.max(part[name], initial=0) for part in coloured_parts), default=0)
        for part in coloured_parts:
            floats = part[name].dtype.kind == "f"
            if highest > (BRIGHT if floats else 255):
                scaled = np.nan_to_num(part[name]) * (1 if floats else 255 / 65535)
                part[name] = np.clip(np.rint(scaled), 0, 255).astype(np.uint8)


def _as_picture(part):
    """The part; its colours per vertex become a picture, where it has no other one."""
    colors, beside = vertex_colors(part), part.vertex_attributes.get("color")
    if colors is None and beside is not None and _image(part).size == 4:  # an OBJ with colours and a plain material
        colors = trimesh.visual.color.to_rgba(beside)[:, :3]
    if colors is None:
        return part
    uv, picture = picture_of_corners(colors[part.faces])
    visual = trimesh.visual.TextureVisuals(uv.reshape(-1, 2), image=Image.fromarray(picture[..., :3]))
    corners = np.arange(part.faces.size).reshape(-1, 3)
    pictured = trimesh.Trimesh(part.vertices[part.faces.ravel()], corners, visual=visual, process=False)
    if part.metadata.get(BESIDE):
        pictured.metadata[BESIDE] = part.metadata[BESIDE] | {"baseColorTexture": True}
    return pictured


def picture_of_corners(colors: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(uv (m, 3, 2), picture (h, w, 4) u1) of faces with a colour at each corner, (m, 3, 3) u1: four pixels each.

    A viewer interpolates between pixels. The fourth continues the other three, so that a face shows what it would show
    with colours of its vertices.
    """
    side = max(int(np.ceil(len(colors) ** 0.5)), 1)
    first, second, third = colors.astype(np.int64).transpose(1, 0, 2)
    four = np.stack([first, second, third, np.clip(second + third - first, 0, 255)], axis=1)
    blocks = np.full((side * side, 2, 2, 4), 255, dtype=np.uint8)
    blocks[..., :3] = np.resize(four, (side * side, 2, 2, 3))  # the rest repeats colours: a viewer mixes pixels
    picture = blocks.reshape(side, side, 2, 2, 4).swapaxes(1, 2).reshape(2 * side, 2 * side, 4)
    row, column = np.divmod(np.arange(len(colors))[:, None], side)
    x, y = 2 * column + [0.5, 1.5, 0.5], 2 * row + [0.5, 0.5, 1.5]
    return np.stack([x, 2 * side - y], axis=2) / (2 * side), picture


def shown_at_corners(texture: Texture) -> np.ndarray:
    """(m,) boolean: faces whose picture is a `picture_of_corners`.

    All faces of the picture then have their corners in the middles of three pixels of one block of 2 x 2.
    """
    found = np.zeros(len(texture.image), dtype=bool)
    for number in np.unique(texture.image):
        faces = np.flatnonzero(texture.image == number)
        size = np.array(texture.images[number].shape[1::-1])
        pixels = texture.uv[faces] * size - 0.5
        whole = np.rint(pixels)  # of any size: texture coordinates may exceed integers
        of_block, in_block = np.divmod(whole, 2)
        corner = np.sort(in_block @ [1, 2], axis=1)
        own = (of_block == of_block[:, :1]).all() and (np.diff(corner, axis=1) > 0).all()
        found[faces] = own and (size > 1).all() and bool(np.abs(pixels - whole).max() < MIDDLE)
    return found


def without_corner_pictures(texture: Texture) -> Texture:
    """The Texture with one place for all faces `shown_at_corners`, whose own places say nothing of the surface."""
    return replace(texture, uv=np.where(shown_at_corners(texture)[:, None, None], 0.0, texture.uv))


def corner_colours(texture: Texture, faces: np.ndarray) -> np.ndarray:
    """(k, 3, 3) u1: the colours that the picture shows at the corners of faces (k,)."""
    return texture.sample(np.repeat(faces, 3), texture.uv[faces].reshape(-1, 2)).reshape(-1, 3, 3)


def flat_texture(colors: np.ndarray) -> Texture:
    """The Texture of faces that have one colour each, (m, 3) u1."""
    palette, ids = np.unique(colors, axis=0, return_inverse=True)
    side = int(np.ceil(len(palette) ** 0.5))
    pixels = np.full((side * side, 4), 255, dtype=np.uint8)
    pixels[: len(palette), :3] = palette
    row, column = np.divmod(ids.ravel(), side)
    uv = np.stack([(column + 0.5) / side, 1 - (row + 0.5) / side], axis=1)
    return Texture(np.repeat(uv[:, None], 3, axis=1), np.zeros(len(ids), int), (pixels.reshape(side, side, 4),))


def obj_vertices(content: bytes) -> np.ndarray:
    """(n, 3) f8: the vertices of an OBJ file's bytes, in the order of the `v` lines."""
    lines = (line.split() for line in content.splitlines())
    return np.array([line[1:4] for line in lines if line[:1] == [b"v"]]).astype(np.float64).reshape(-1, 3)


def merge_equal_rows(rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Merges bit-equal rows (n, d), or numbers (n,), in the order of first appearance: first (k,) and ids (n,)."""
    _, first, inverse = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return first[order], rank[inverse.ravel()]


def texture_of(parts: list[trimesh.Trimesh]) -> Texture | None:
    """The Texture of all parts, one behind the other, or None when no material states anything."""
    properties = [_beside(part) for part in parts]
    stated = [{name for name, value in (material or {}).items() if value is not False} for material in properties]
    if not any(_stated(part) or names for part, names in zip(parts, stated, strict=True)):
        return None
    image_cache = {}
    images = [_image(part, image_cache) for part in parts]
    uv = [_corners(part) for part in parts]
    sizes = [len(part.faces) for part in parts]
    names = {}
    contents = {place: image.tobytes() for place, image in {id(image): image for image in images}.items()}
    keys = [
        (image.shape, contents[id(image)], *content_of(material))
        for image, material in zip(images, properties, strict=True)
    ]
    numbers = [names.setdefault(key, len(names)) for key in keys]
    first = [numbers.index(number) for number in range(len(names))]
    distinct, materials = zip(*((images[place], properties[place]) for place in first), strict=True)
    return Texture(np.concatenate(uv), np.repeat(numbers, sizes), distinct, materials)


def _beside(part):
    return part.metadata.get(BESIDE) or beside_colour(getattr(part.visual, "material", None))


def _stated(part):
    """Whether the file states a colour or a picture for the part; where it does not, trimesh makes one up."""
    material = getattr(part.visual, "material", None)
    if any(getattr(material, name, None) is not None for name in ("baseColorTexture", "baseColorFactor")):
        return True
    image = getattr(material, "image", None)
    _check_size(image)
    unread: Any = trimesh.visual.material.color_image()  # what trimesh paints a material with whose file is not there
    made_up = image is None or np.array_equal(image.convert("RGBA"), unread)
    return not made_up or "kd" in getattr(material, "kwargs", {})


def _image(part, known=None):
    """The image of a part's material, (h, w, 4) u1; one pixel for a plain colour.

    known: the images of pictures by their ids, so that parts that share a picture share its image.
    """
    known = {} if known is None else known
    material = getattr(part.visual, "material", None) if _stated(part) else None
    image = getattr(material, "baseColorTexture", None) or getattr(material, "image", None)
    if image is not None and getattr(part.visual, "uv", None) is not None:
        _check_size(image)
        if id(image) not in known:
            known[id(image)] = pixels_of(image)
        return known[id(image)]
    unstated = WHITE if part.metadata.get(BESIDE) else GREY
    return np.asarray(getattr(material, "main_color", unstated), dtype=np.uint8).reshape(1, 1, 4)


def _check_size(image):
    """Raises MeshError for a picture that would fill the memory; only its header was read so far."""
    if image is not None and image.width * image.height > MAX_TEXTURE**2:
        size = f"{image.width:,} x {image.height:,} pixels"
        raise MeshError(f"a texture of {size} is larger than {MAX_TEXTURE:,} x {MAX_TEXTURE:,}: scale it down")


def _corners(part):
    """(m, 3, 2) texture coordinates of a part's face corners; 0 for NaN and for those that no file of ours holds."""
    uv = getattr(part.visual, "uv", None)
    if uv is None or len(uv) != len(part.vertices):
        return np.zeros((len(part.faces), 3, 2))
    uv = np.asarray(uv, dtype=np.float64)[:, :2]
    return np.where(np.abs(uv) <= MOST_UV, uv, 0.0)[part.faces]


COLOURS = ("vertex", "own", "palette")  # what meshes.colours may be
# The eighteen colours of the ColorChecker chart in sRGB, as its maker states them: skin, foliage, sky, flowers, fruit
# and primaries (McCamy, Marcus and Davidson, A color-rendition chart, J. Applied Photographic Engineering 2(3), 1976).
PALETTE = np.array([
    (115, 82, 68), (194, 150, 130), (98, 122, 157), (87, 108, 67), (133, 128, 177), (103, 189, 170),
    (214, 126, 44), (80, 91, 166), (193, 90, 99), (94, 60, 108), (157, 188, 64), (224, 163, 46),
    (56, 61, 150), (70, 148, 73), (175, 54, 60), (231, 199, 31), (187, 86, 149), (8, 133, 161),
], dtype=np.uint8)  # fmt: skip


def coloured(mesh: Mesh, name: str, colours: str, suffix: str = "") -> Mesh:
    """The mesh with a colour at each vertex: its own, or with colours=palette one of PALETTE where it has none.

    A texture becomes the colours of the vertices (bake_texture). The palette's colour follows from the name alone, so
    that it is the same in every run. Raises MeshError for a mesh without colours where colours=own; suffix: that of its
    file, for the reason.
    """
    mesh = bake_texture(mesh)
    if mesh.colors is not None:
        return mesh
    if colours == "own":
        reason = "no vertex has a colour, and those of an OFF's faces are not read (save it as PLY)"
        reason = reason if suffix == ".off" else "has no colours of its own"
        raise MeshError(f"{reason}: set meshes.colours=palette to paint it, or leave it out")
    colour = PALETTE[zlib.crc32(name.encode()) % len(PALETTE)]
    return replace(mesh, colors=np.tile(colour, (len(mesh.vertices), 1)))


def bake_texture(mesh: Mesh) -> Mesh:
    """The Mesh with its texture's colour at each vertex, the mean over the corners there, instead of the texture.

    Materials that state no colour, but for example a normal map, leave the mesh without colours.
    """
    if mesh.texture is None:
        return mesh
    if not any(material is None or COLOURS_OF & set(material) for material in mesh.texture.materials):
        return replace(mesh, texture=None)
    texture, ids = mesh.texture, mesh.faces.ravel()
    rgb = texture.sample(np.repeat(np.arange(len(mesh.faces)), 3), texture.uv.reshape(-1, 2))
    count = np.maximum(np.bincount(ids, minlength=len(mesh.vertices)), 1)
    colors = [np.bincount(ids, weights=column, minlength=len(mesh.vertices)) / count for column in rgb.T]
    return replace(mesh, colors=np.rint(np.stack(colors, axis=1)).astype(np.uint8), texture=None)
