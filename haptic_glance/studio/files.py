"""Meshes as the bytes of files, to be handed to the browser."""

from pathlib import Path
from tempfile import TemporaryDirectory

from haptic_glance.lod.export import write_any
from haptic_glance.mesh.materials import bake_texture
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.up import upright_for


def as_bytes(mesh: Mesh, suffix: str) -> bytes:
    """The file of a Mesh (.glb, .obj, .ply, .off, .stl), upright as its format has it.

    An OBJ gets the texture's colour at each vertex, since its pictures would be files of their own.
    """
    with TemporaryDirectory() as folder:
        path = Path(folder) / f"mesh{suffix}"
        turned, _ = upright_for(path, bake_texture(mesh) if suffix == ".obj" else mesh)
        write_any(path, turned)
        return path.read_bytes()
