"""The colours of an object: those of its file, or one of a palette by its name."""

import zlib
from dataclasses import replace

import numpy as np

from stages.kit import Mesh

from .headers import MeshError

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
    """The Mesh with its texture's colour at each vertex, the mean over the corners there, instead of the texture."""
    if mesh.texture is None:
        return mesh
    texture, ids = mesh.texture, mesh.faces.ravel()
    rgb = texture.sample(np.repeat(np.arange(len(mesh.faces)), 3), texture.uv.reshape(-1, 2))
    count = np.maximum(np.bincount(ids, minlength=len(mesh.vertices)), 1)
    colors = [np.bincount(ids, weights=column, minlength=len(mesh.vertices)) / count for column in rgb.T]
    return replace(mesh, colors=np.rint(np.stack(colors, axis=1)).astype(np.uint8), texture=None)
