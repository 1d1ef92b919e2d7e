"""Files of levels: face counts as people write them, names of files, and meshes written for other programs.

A face count is absolute or a share of the object's own. Written meshes have their own coordinates, colours and
textures.
"""

from __future__ import annotations

import argparse
import io
import itertools
import re
from collections.abc import Mapping
from contextlib import ExitStack, suppress
from dataclasses import replace
from pathlib import Path
from typing import IO, Any

import numpy as np
from PIL import Image
from scipy.spatial import KDTree

from haptic_glance.base.files import whole_file
from haptic_glance.base.lazy import trimesh
from haptic_glance.base.packing import ordered
from haptic_glance.base.warner import warn_caller
from haptic_glance.mesh.gltf import with_linear_colours
from haptic_glance.mesh.materials import WHITE, bake_texture, corner_colours, pixels_of, shown_at_corners
from haptic_glance.mesh.mesh import Mesh, colour_factor
from haptic_glance.mesh.srgb import encoded, multiplied
from haptic_glance.mesh.up import with_stated_up

from .feasibility import InfeasibleTarget, SimplifyError
from .simplify import simplify
from .topology import Parts, shading

FORMATS = (".glb", ".obj", ".off", ".ply", ".stl")
PICTURED = (".glb", ".obj")  # the formats with texture coordinates and images
COLORLESS = (".off", ".stl")
DIGITS = 9  # of the diagonal
OF_ONE = 7  # digits of texture coordinates and colours, which trimesh writes with as many places as the vertices
SINGLE = (".glb", ".npz", ".ply", ".stl", ".usda")  # the formats of single precision
RUINED = 0.01  # of the diagonal: the written mesh would be another one than the mesh that was measured
MOST_MOVED = 1e-4  # of the diagonal: a vertex that single precision moves farther is seen to be elsewhere


def write_any(path: str | Path, mesh: Mesh, parts: Parts | None = None) -> None:
    """Writes a mesh in the format of the path's suffix: glb, obj, off, ply or stl; the file is whole or absent.

    Parameters
    ----------
    path : path
        The file.
    mesh : Mesh or any input of `as_mesh`
        The mesh.
    parts : mapping of str to (k,) array of int, optional
        In a glb the nodes, by name: the ids of their faces.

    Raises
    ------
    ValueError
        For another suffix, and for coordinates that the format does not hold.

    Warns
    -----
    UserWarning
        If single precision moves vertices, for example far from the origin.

    Notes
    -----
    Textures are written to glb and obj (with NAME.mtl and NAME_K.png beside it), where seams double vertices, and to
    glb with the factors and pictures of its materials, without samplers, scales of pictures, extensions and further
    texture coordinates. A glb gets the files of PNG and JPEG pictures that nobody changed; other pictures become PNG.
    ply gets the texture's colour at each vertex instead; off and stl have neither. Colours in a glb are linear, as glTF
    says, and sRGB in the other formats. A glb has normals, for which creases double vertices, too.
    obj and off have nine digits or more, the others single precision. Coordinates are those of the mesh: glTF expects
    +y up and metres, but nothing is turned here (`haptic_glance.mesh.up.upright_for`); the other formats get a comment
    that names the axis.

    Examples
    --------
    >>> from haptic_glance import Mesh, write_any
    >>> write_any("triangle.ply", Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]))
    """
    write_with_files(Path(path), mesh, parts)


def write_with_files(path: Path, mesh: Mesh, parts: Parts | None = None) -> list[Path]:
    """As `write_any`; returns the files that were written, the mesh first, then materials and pictures beside it."""
    suffix = path.suffix.lower()
    if suffix not in FORMATS:
        raise ValueError(f"{path.name}: meshes are written as {', '.join(FORMATS)}, not as {suffix or 'no suffix'}")
    check_precision(path, mesh)
    named = {name: ids for name, ids in (parts or {}).items() if len(ids)} if suffix == ".glb" else None
    if suffix not in PICTURED:
        mesh = bake_texture(mesh)
    elif suffix == ".obj" and mesh.texture is not None:  # its materials have no more
        mesh = replace(mesh, texture=_in_pictures(mesh.texture))
    loaded = for_glb(mesh, path.stem, named) if suffix == ".glb" else to_trimesh(mesh, path.stem)
    least = OF_ONE if suffix == ".obj" else 1
    digits = max(DIGITS - int(np.floor(np.log10(mesh.diagonal or 1.0))), least)
    options: dict[str, Any] = {"digits": digits} if suffix in (".obj", ".off") else {}
    if suffix == ".obj":
        options |= {"return_texture": True, "mtl_name": f"{path.stem}.mtl"}
    exported: Any = write_glb(loaded) if suffix == ".glb" else loaded.export(file_type=suffix[1:], **options)
    content, beside = exported if suffix == ".obj" else (exported, {})
    with ExitStack() as stack:  # all are written before the first is moved into place, the mesh itself last
        for name, extra in {path.name: content, **beside}.items():
            part = stack.enter_context(whole_file(path.parent / name))
            data = extra.encode() if isinstance(extra, str) else extra
            part.write_bytes(with_stated_up(data, suffix, mesh.up) if name == path.name else data)
    return [path, *(path.parent / name for name in beside)]


def files_beside(path: Path) -> list[Path]:
    """The files that exist under the names of materials and pictures that `write_any` writes beside an OBJ."""
    if path.suffix.lower() != ".obj" or not path.parent.is_dir():
        return []
    name = re.compile(re.escape(path.stem) + r"(\.mtl|_(0|[1-9]\d?)\.png)")  # scan_2024.png is no hundredth picture
    return sorted(file for file in path.parent.iterdir() if name.fullmatch(file.name))


def _in_pictures(texture):
    """The Texture without materials, whose colours go into its pictures."""
    images = [np.dstack([multiplied(image[..., :3], colour_factor(material)), image[..., 3]])
              for image, material in zip(texture.images, texture.materials, strict=True)]  # fmt: skip
    return replace(texture, images=tuple(images), materials=())


def check_precision(path: Path, mesh: Mesh, text: str = ", or write text (.obj, .off)") -> None:
    """Warns where the path's format moves vertices by more than MOST_MOVED of the diagonal.

    Raises ValueError where it moves them by more than RUINED, and where coordinates become infinite.
    """
    if path.suffix.lower() not in SINGLE or not mesh.diagonal:
        return
    with np.errstate(over="ignore", under="ignore"):
        rounding_error = float(np.abs(mesh.vertices - mesh.vertices.astype(np.float32)).max())
    if not np.isfinite(rounding_error):
        raise ValueError(f"{path.name}: its coordinates are too large for single precision: scale it, or write .obj")
    if rounding_error > MOST_MOVED * mesh.diagonal:
        share, remedy = rounding_error / mesh.diagonal, f"move it to the origin{text}"
        message = f"{path.name}: single precision moves vertices by {100 * share:.2g} % of the diagonal: {remedy}"
        if share > RUINED:
            raise ValueError(message)
        warn_caller(message)


def to_trimesh(mesh: Mesh, name: str = "mesh", parts: Parts | None = None) -> trimesh.Trimesh | trimesh.Scene:
    """Converts a mesh to an object of trimesh.

    Parameters
    ----------
    mesh : Mesh or any input of `as_mesh`
        The mesh.
    name : str
        Prefix of the names of its parts, and of materials that have none of their own.
    parts : mapping of str to (k,) array of int, optional
        Ids of faces by name, for a Scene with a part for each name and image, the further ones numbered.

    Returns
    -------
    trimesh.Trimesh or trimesh.Scene
        With a texture a Scene with one part per image, vertices doubled at seams. Colours are sRGB, also factors of
        materials; `write_any` makes them linear in a glb, as glTF says, and trimesh's own export does not.

    Examples
    --------
    >>> from haptic_glance import Mesh, to_trimesh
    >>> to_trimesh(Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])).faces.shape
    (1, 3)
    """
    return _converted(mesh, name, parts)


NORMAL = "normal"


def for_glb(
    mesh: Mesh, name: str = "mesh", parts: Parts | None = None, attributes: Mapping[str, np.ndarray] | None = None
) -> trimesh.Trimesh | trimesh.Scene:
    """As `to_trimesh`, with normals (haptic_glance.lod.topology.shading), for which creases double vertices: viewers
    show a glTF without normals flat. The pictures are those of files, which trimesh writes to a glb as they are.

    attributes: {name: (n,)} of the vertices, which those of the result get, too.
    """
    if not len(mesh.faces):
        raise ValueError("a mesh without faces cannot be written as glb: write .ply")
    faces, vertices, normals = shading(mesh)
    colors = None if mesh.colors is None else mesh.colors[vertices]
    carried = {NORMAL: normals} | {key: values[vertices] for key, values in (attributes or {}).items()}
    return _converted(Mesh(mesh.vertices[vertices], faces, colors, mesh.texture), name, parts, carried)


def write_glb(loaded: trimesh.Trimesh | trimesh.Scene) -> bytes:
    """The bytes of what `for_glb` returns; its colours, which are sRGB, become linear."""
    content: Any = loaded.export(file_type="glb", include_normals=True)
    return with_linear_colours(content)


def _converted(mesh, name, parts, carried=None) -> trimesh.Trimesh | trimesh.Scene:
    if mesh.texture is None and not parts:
        return _made(mesh, np.arange(len(mesh.vertices)), mesh.faces.copy(), carried, vertex_colors=mesh.colors)
    if mesh.texture is None:
        return trimesh.Scene({part: _plain_part(mesh, ids, carried) for part, ids in (parts or {}).items()})
    images, scene, parts = mesh.texture.image, {}, parts or {}
    if not parts:
        scene = {f"{name}_{number}": (number, np.flatnonzero(images == number)) for number in np.unique(images)}
    for part, ids in parts.items():
        numbered = (f"{part}_{place}" for place in itertools.count(1))
        free = (name for name in numbered if name not in scene and name not in parts)
        for place, number in enumerate(np.unique(images[ids])):
            scene[next(free) if place else part] = number, ids[images[ids] == number]
    materials = {
        number: _material(mesh.texture, number, carried is not None)
        for number in {number for number, _ in scene.values()}
    }
    return trimesh.Scene(
        {part: _part(mesh, materials[number], ids, part, carried) for part, (number, ids) in scene.items()}
    )


def _plain_part(mesh, ids, carried):
    vertex_ids, faces = np.unique(mesh.faces[ids], return_inverse=True)
    colors = None if mesh.colors is None else mesh.colors[vertex_ids]
    return _made(mesh, vertex_ids, faces.reshape(-1, 3), carried, vertex_colors=colors)


def _made(mesh, vertices, faces, carried, **looks):
    """A Trimesh of some vertices of the mesh, in arrays of its own, with what they carry."""
    carried = {key: values[vertices] for key, values in (carried or {}).items()}
    normals = carried.pop(NORMAL, None)
    model = trimesh.Trimesh(mesh.vertices[vertices], faces, vertex_normals=normals, process=False, **looks)
    model.vertex_attributes.update(carried)
    return model


def _part(mesh, material, ids, name, carried):
    """Faces of one image, as a Trimesh whose vertices each have one pair of texture coordinates, or one colour.

    A glb has the colours of a `picture_of_corners`, to which no material adds anything, at the vertices.
    """
    faces, texture = mesh.faces[ids], mesh.texture.of(ids)
    stated = {key for key, value in (texture.materials[texture.image[0]] or {}).items() if value is not False}
    has_colors = carried is not None and stated <= {"baseColorTexture"} and shown_at_corners(texture).all()
    looks = corner_colours(texture, np.arange(len(ids))) if has_colors else texture.uv
    rows = np.column_stack([faces.ravel(), looks.reshape(faces.size, -1)])
    vertices, first, inverse = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    if has_colors:
        colors = vertices[:, 1:].astype(np.uint8)
        return _made(mesh, faces.ravel()[first], inverse.reshape(-1, 3), carried, vertex_colors=colors)
    pbr = trimesh.visual.material.PBRMaterial(**{"name": name} | material)
    factor = np.asarray(material.get("baseColorFactor", ()))
    if carried is not None and factor.dtype.kind == "f" and len(factor):  # an assignment would make bytes of it
        pbr._data["baseColorFactor"] = np.append(encoded(factor[:3]), factor[3:])
    visual = trimesh.visual.TextureVisuals(uv=vertices[:, 1:], material=pbr)
    return _made(mesh, faces.ravel()[first], inverse.reshape(-1, 3), carried, visual=visual)


def _material(texture, number, glb):
    """The arguments of a PBRMaterial: the image, or its colour where it is one pixel, and what a file said besides."""
    pixels, arguments = texture.images[number], texture.materials[number]
    clear, plain = (pixels[..., 3] < 255).any(), pixels.shape[:2] == (1, 1)
    if arguments is None:
        arguments = {"doubleSided": True, "metallicFactor": 0.0, "roughnessFactor": 1.0}
        arguments |= {"alphaMode": "MASK"} if clear else {}
        arguments |= {"baseColorFactor": pixels[0, 0]} if plain else {"baseColorTexture": True}
    arguments = {"metallicFactor": 1.0, "roughnessFactor": 1.0, **arguments}  # what glTF takes for none
    if "baseColorTexture" in arguments:
        arguments["baseColorTexture"] = _colour_picture(arguments["baseColorTexture"], pixels, clear)
        if not glb:
            arguments.setdefault("baseColorFactor", WHITE)  # trimesh would darken the picture to 40 %
    return {name: _picture(value, glb) if name.endswith("Texture") else value for name, value in arguments.items()}


def _colour_picture(content, pixels, clear):
    """The picture's own file, where the pixels are still those of the file; else an image of the pixels."""
    if isinstance(content, bytes) and np.array_equal(pixels_of(Image.open(io.BytesIO(content))), pixels):
        return content
    return Image.fromarray(pixels if clear else pixels[..., :3])


class _File:
    """A picture's file, which trimesh writes to a glb without decoding it."""

    def __init__(self, content: bytes) -> None:
        self.content = content
        self.format = "PNG" if content.startswith(b"\x89PNG") else "JPEG"

    def save(self, file: IO[bytes], format: str) -> None:
        file.write(self.content)


def _picture(picture, glb):
    """The picture of a file's bytes or a PIL image, as a PIL image that has a format, or as a _File."""
    if not isinstance(picture, bytes):
        stream = io.BytesIO()
        picture.save(stream, "PNG")
        picture = stream.getvalue()
    return _File(picture) if glb else Image.open(io.BytesIO(picture))


def face_count(target: str | int, total: int = 1, name: str = "") -> int:
    """The face count of a `target` ("25%", "1500") for a mesh of `total` faces; a check of the target without a total.

    Raises ValueError, which names the option `name`, for anything else, shares outside 0 to 100 %, and counts below 1.
    """
    shown = f"{name}={target!r}" if name else repr(target)
    match = re.fullmatch(r"(\d+(?:\.\d+)?)(%?)", str(target).strip())
    if match is None:
        raise ValueError(f"{shown} is not a face count: write one like 1500 or 25%")
    number = float(match[1])
    if match[2] and not 0 < number < 100:
        raise ValueError(f"{shown} must lie between 0% and 100%")
    share = round(total * number / 100, 6)  # 32.3 % of 1000 are 322.99999999999994 in binary fractions
    count = int(share if match[2] else number)
    if count < 1 and not match[2]:
        remedy = f"; for a share write {100 * number:g}%" if number else ""
        raise ValueError(f"{shown} must be 1 or more{remedy}")
    if count != number and not match[2]:
        raise ValueError(f"{shown} is not a whole number of faces")
    return max(count, 1)


def file_name(method: str, target: str) -> str:
    """The name of a mesh's file, for example `glance_25pct.npz`."""
    return f"{method}_{str(target).strip().replace('%', 'pct')}.npz"


def levels(text: str) -> list[str]:
    """["50%", "25%"] of the text `50%,25%`; argparse.ArgumentTypeError for what is no face count."""
    try:
        targets = [part.strip() for part in text.split(",")]
        counts = [(face_count(part, 10**9, "--levels"), "%" in part) for part in targets]
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None
    return [part for k, part in enumerate(targets) if counts[k] not in counts[:k]]  # 50% and 50.0% are one level


def level_path(folder: Path, name: str, source: Path, target: str, kind: str | None = None) -> Path:
    """folder/NAME_50pct.glb; kind: such as glb; None for that of the source where it can be written, or else glb."""
    extension = source.suffix.lower()
    suffix = f".{kind}" if kind else extension if extension in FORMATS else ".glb"
    return folder / f"{name}_{target.replace('%', 'pct')}{suffix}"


MOST_SHOWN = 65535 // 3  # faces: the page's script has 16-bit ids of vertices, and each face may have three of its own


def shown_mesh(mesh: Mesh, faces: int) -> tuple[Mesh, np.ndarray]:
    """(mesh, ids): the mesh, simplified where it has more faces, or more than MOST_SHOWN; ids: the original vertex
    nearest to each of its."""
    faces = min(faces, MOST_SHOWN)
    small = ordered(_fewer(mesh, faces) if len(mesh.faces) > faces else mesh)[0]
    return small, np.asarray(KDTree(mesh.vertices).query(small.vertices)[1])


def _fewer(mesh, faces):
    """The mesh simplified to so many faces; where it has too many parts for that, its largest faces."""
    for free in (False, True):
        with suppress(InfeasibleTarget, SimplifyError):
            return simplify(mesh, faces, free_borders=free)
    return Mesh(mesh.vertices, mesh.faces[np.argsort(-mesh.face_areas, kind="stable")[:faces]], up=mesh.up)
