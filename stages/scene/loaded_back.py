"""GLB files read again after they were written, and compared with what was written."""

import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import trimesh

from haptic_glance.mesh.mesh import Mesh

EXTENSION = "MSFT_lod"
SINGLE = 1e-6  # of the largest coordinate: glTF stores 4 bytes a number


def check_glb(path: Path, meshes: Sequence[Mesh], names: Sequence[str]) -> None:
    """Raises ValueError that names the file unless it holds these Meshes under these names, in their order."""
    try:
        found = trimesh.load_scene(path, file_type="glb", process=False).geometry
    except Exception as error:  # whatever the reader raises: the file is at fault
        raise ValueError(f"{path} cannot be loaded back: {error}") from error
    if list(found) != list(names):
        raise ValueError(f"{path} came back with {', '.join(found) or 'nothing'} in place of {', '.join(names)}")
    for name, mesh in zip(names, meshes, strict=True):
        fault = _fault(found[name], mesh)
        if fault:
            raise ValueError(f"{path}: {name} came back with other {fault} than were written")


def _fault(found, mesh):
    """What of a loaded mesh differs from the Mesh: "faces", "positions" or "colours"; or ""."""
    if not np.array_equal(found.faces, mesh.faces):
        return "faces"
    tolerance = SINGLE * np.abs(mesh.vertices).max(initial=0)
    if found.vertices.shape != mesh.vertices.shape or np.abs(found.vertices - mesh.vertices).max(initial=0) > tolerance:
        return "positions"
    same = mesh.colors is None or np.array_equal(found.visual.vertex_colors[:, :3], mesh.colors)
    return "" if same else "colours"


def read_lod(path: Path) -> list[str]:
    """Names of the levels, finest first, of a GLB with MSFT_lod. Raises ValueError where it has none."""
    content = path.read_bytes()
    length = int.from_bytes(content[12:16], "little")
    try:
        nodes = json.loads(content[20 : 20 + length])["nodes"]
        for k, node in enumerate(nodes):
            if EXTENSION in node.get("extensions", {}):
                return [nodes[j]["name"] for j in (k, *node["extensions"][EXTENSION]["ids"])]
    except (ValueError, LookupError, TypeError, AttributeError, RecursionError) as error:
        raise ValueError(f"{path} is damaged: {error}") from None
    raise ValueError(f"{path} has no {EXTENSION}")
