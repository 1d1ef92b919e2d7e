"""Meshes as the bytes of files, to be handed to the browser."""

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from haptic_glance.lod.export import write_any
from haptic_glance.lod.weight_files import write_weights
from haptic_glance.mesh.materials import bake_texture
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.up import upright_for


def as_bytes(mesh: Mesh, suffix: str, weights: np.ndarray | None = None) -> bytes:
    """The file of a Mesh (.glb, .obj, .ply, .off, .stl), upright as its format has it.

    weights (n,): of the vertices, for the formats of `write_weights` (.ply, .glb, .usda, .npz).

    An OBJ gets the texture's colour at each vertex, since its pictures would be files of their own.
    """
    with TemporaryDirectory() as folder:
        path = Path(folder) / f"mesh{suffix}"
        upright_mesh, _ = upright_for(path, bake_texture(mesh) if suffix == ".obj" else mesh)
        write_any(path, upright_mesh) if weights is None else write_weights(path, upright_mesh, weights)
        return path.read_bytes()
