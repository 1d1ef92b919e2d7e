"""A coloured mesh as a GLB for the page: matte, its colours without the encoding of sRGB, as glTF has them."""

from typing import Any

import numpy as np
import trimesh
from trimesh.exchange.gltf import export_glb

from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.srgb import decoded

MATERIAL = {"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.8}, "doubleSided": True}


def glb(mesh: Mesh, colors: np.ndarray, flat: bool = False) -> bytes:
    """The GLB of a Mesh with colours (n, 3) u1; flat: without normals, so that every face is lit by its own."""
    rgb = np.full((len(colors), 4), 2**16 - 1, dtype=np.uint16)  # 16 bits: eight would lose the dark ones
    rgb[:, :3] = np.rint(decoded(colors / 255) * (2**16 - 1))
    normals = None if flat else mesh.vertex_normals
    model = trimesh.Trimesh(mesh.vertices, mesh.faces, vertex_normals=normals, process=False)
    model.vertex_attributes["rgb"] = rgb
    return export_glb(model, include_normals=not flat, tree_postprocessor=_matte)


def _matte(tree: dict[str, Any]) -> None:
    """Turns trimesh's attribute into the colours of glTF, and adds the material: trimesh writes colours of 8 bits."""
    (primitive,) = tree["meshes"][0]["primitives"]
    number = primitive["attributes"]["COLOR_0"] = primitive["attributes"].pop("_rgb")
    tree["accessors"][number]["normalized"] = True
    tree["materials"], primitive["material"] = [MATERIAL], 0
