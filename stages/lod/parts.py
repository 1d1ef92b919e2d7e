"""The named nodes of a GLB: which faces of a mesh belong to which, before and after simplification."""

from pathlib import Path

import numpy as np
import trimesh

from stages.kit import Mesh

from .attributes import closest

Parts = dict[str, np.ndarray]  # name of a node -> (k,) ids of faces


def parts_of(path: Path) -> Parts:
    """The Parts of a file's mesh, as `stages.meshes.load` joins them; empty unless it is a GLB."""
    if path.suffix.lower() != ".glb":
        return {}
    loaded = trimesh.load(path, process=False)
    dumped = loaded.dump() if isinstance(loaded, trimesh.Scene) else []
    parts, start = {}, 0
    for part in dumped:
        count = len(part.faces) if isinstance(part, trimesh.Trimesh) else 0
        if count:
            name = str(part.metadata.get("node", path.stem))
            parts[name] = np.r_[parts.get(name, np.zeros(0, dtype=np.int64)), start : start + count]
        start += count
    return parts


def moved_parts(parts: Parts, mesh: Mesh, simplified: Mesh) -> Parts:
    """The Parts of a simplified mesh: each of its faces goes where the closest face of `mesh` belongs, which `parts`
    are of. Nodes without a face are left out.
    """
    if len(parts) < 2:
        return {name: np.arange(len(simplified.faces)) for name in parts}
    names = list(parts)
    owner = np.zeros(len(mesh.faces), dtype=np.int64)
    for number, name in enumerate(names):
        owner[parts[name]] = number
    face, _ = closest(mesh, simplified.vertices[simplified.faces].mean(axis=1))
    found = {name: np.flatnonzero(owner[face] == number) for number, name in enumerate(names)}
    return {name: ids for name, ids in found.items() if len(ids)}
