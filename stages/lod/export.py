"""Meshes for other programs, with their colours and pictures, in their own coordinates."""

import io
from contextlib import ExitStack
from pathlib import Path

import numpy as np
import trimesh
from PIL import Image

from stages.kit import Mesh
from stages.kit.files import whole_file

FORMATS = (".glb", ".obj", ".off", ".ply", ".stl")
PICTURED = (".glb", ".obj")  # the formats that hold texture coordinates and pictures
COLORLESS = (".off", ".stl")
DIGITS = 9  # of the diagonal


def write_any(path, mesh):
    """Writes a Mesh in the format of the path's suffix: glb, obj, off, ply or stl; the file is whole or absent.

    Textures go into glb and obj (NAME.mtl and NAME_K.png beside it), where seams double vertices; ply takes the
    picture's colour at each vertex instead; off and stl hold neither. obj and off keep nine digits or more, the others
    single precision, as their formats are read. Coordinates are those of the mesh: glTF itself asks for +y up and
    metres, and nothing is turned here. Raises ValueError for another suffix.
    """
    path = Path(path)
    suffix = path.suffix.lower()
    if suffix not in FORMATS:
        raise ValueError(f"{path.name}: meshes are written as {', '.join(FORMATS)}, not as {suffix or 'no suffix'}")
    loaded = to_trimesh(mesh if suffix in PICTURED else painted(mesh), path.stem)
    digits = max(DIGITS - int(np.floor(np.log10(mesh.diagonal or 1.0))), 1)
    if suffix == ".obj":
        options = {"return_texture": True, "mtl_name": f"{path.stem}.mtl", "digits": digits}
        content, beside = loaded.export(file_type="obj", **options)
    else:
        content, beside = loaded.export(file_type=suffix[1:], **({"digits": digits} if suffix == ".off" else {})), {}
    with ExitStack() as parts:  # all are written before the first is moved into place, the mesh itself last
        for name, extra in {path.name: content, **beside}.items():
            part = parts.enter_context(whole_file(path.parent / name))
            part.write_bytes(extra.encode() if isinstance(extra, str) else extra)


def to_trimesh(mesh, name="mesh"):
    """The Mesh as trimesh's: a Trimesh, or with a texture a Scene of one part an image, vertices doubled at seams.

    name: how the names of its parts and materials begin.
    """
    if mesh.texture is None:
        return trimesh.Trimesh(mesh.vertices, mesh.faces, vertex_colors=mesh.colors, process=False)
    parts = {f"{name}_{number}": number for number in np.unique(mesh.texture.image)}
    return trimesh.Scene({part: _part(mesh, number, part) for part, number in parts.items()})


def painted(mesh):
    """The Mesh with its picture's colour at each vertex instead of the texture: the mean over the corners there."""
    if mesh.texture is None:
        return mesh
    texture, ids = mesh.texture, mesh.faces.ravel()
    seen = texture.sample(np.repeat(np.arange(len(mesh.faces)), 3), texture.uv.reshape(-1, 2))
    count = np.maximum(np.bincount(ids, minlength=len(mesh.vertices)), 1)
    colors = [np.bincount(ids, weights=column, minlength=len(mesh.vertices)) / count for column in seen.T]
    return Mesh(mesh.vertices, mesh.faces, np.rint(np.stack(colors, axis=1)).astype(np.uint8))


def _part(mesh, number, name):
    """The faces that show one image, as a Trimesh whose vertices each have one pair of texture coordinates."""
    own = mesh.texture.of(mesh.texture.image == number)
    faces = mesh.faces[mesh.texture.image == number]
    rows = np.column_stack([faces.ravel(), own.uv.reshape(-1, 2)])
    found, first, inverse = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    picture = own.images[number]
    material = trimesh.visual.material.PBRMaterial(
        name=name, doubleSided=True, metallicFactor=0.0, roughnessFactor=1.0, **_look(picture)
    )
    visual = trimesh.visual.TextureVisuals(uv=found[:, 1:], material=material)
    vertices = mesh.vertices[faces.ravel()[first]]
    return trimesh.Trimesh(vertices, inverse.reshape(-1, 3), visual=visual, process=False)


def _look(picture):
    """The picture, or its colour where it is one pixel, as glTF calls it."""
    see_through = {"alphaMode": "MASK"} if (picture[..., 3] < 255).any() else {}
    if picture.shape[:2] == (1, 1):
        return {"baseColorFactor": picture[0, 0], **see_through}
    image = Image.fromarray(picture if see_through else picture[..., :3])
    packed = io.BytesIO()
    image.save(packed, "PNG")  # trimesh writes a picture in the format that it was read in
    packed.seek(0)
    return {"baseColorTexture": Image.open(packed), **see_through}
