"""Turns one mesh file of a source into a mesh that the later stages can use, and a row of its metadata."""

import hashlib
from dataclasses import replace

import numpy as np
from scipy.sparse.csgraph import connected_components
from trimesh.resolvers import ZipResolver

from haptic_glance.base.fetch import FetchError
from haptic_glance.mesh.axes import AUTO
from haptic_glance.mesh.clouds import DEPTH
from haptic_glance.mesh.files import parse
from haptic_glance.mesh.headers import MeshError
from haptic_glance.mesh.materials import coloured
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.plane import remove_plane
from haptic_glance.mesh.repair import clean, normalise, rotate_to_z_up
from haptic_glance.mesh.upright import settled

from .sources import MeshFile


def prepare_mesh(item: MeshFile, remove_table: bool = False, colours: str = "vertex") -> tuple[Mesh, dict]:
    """The mesh of a MeshFile, repaired, turned upright, centred and scaled, and its row of the manifest (a dict).

    remove_table: first removes the plane that a scanned object stands on (remove_plane). colours: one of COLOURS. The
    mesh has no texture: `own` and `palette` turn it into the colours of the vertices, `vertex` drops it. Raises
    MeshError with the reason when the file gives no usable mesh.
    """
    try:
        content, painted = item.content(), colours != "vertex"
        needed = painted or item.suffix == DEPTH
        beside = item.beside() if needed else {}
        there = ZipResolver({name: data for name, data in beside.items() if data})
        parsed = parse(content, item.suffix, there if needed else None, every_colour=painted)
        raw, notes = clean(settled(parsed if item.up == AUTO else replace(parsed, up=item.up)))
        notes += [f"{name}, which it names, is not there" for name, data in beside.items() if not data]
        if remove_table:
            raw, notes = _without_table(raw, notes)
        mesh = normalise(rotate_to_z_up(raw))
        mesh = coloured(mesh, item.name, colours, item.suffix) if painted else mesh
    except (FetchError, ValueError, OSError) as error:
        raise MeshError(str(error)) from error
    used = np.unique(mesh.faces)
    counts = mesh.edge_counts[1]
    components = connected_components(mesh.adjacency[used][:, used])[0]
    return mesh, {
        "object": item.name, "file": item.file, "licence": item.licence, "creator": item.creator, "unit": item.unit,
        "up": raw.up, "size": float(np.ptp(raw.vertices[np.unique(raw.faces)], axis=0).max()),
        "vertices": len(mesh.vertices), "faces": len(mesh.faces), "parts": int(components),
        "watertight": mesh.watertight, "open_edges": int((counts == 1).sum()),
        "nonmanifold_edges": int((counts > 2).sum()), "colors": mesh.colors is not None,
        "repairs": "; ".join(notes), "sha256": hashlib.sha256(content).hexdigest(),
    }  # fmt: skip


def _without_table(mesh, notes):
    remaining = remove_plane(mesh)
    removed = len(mesh.faces) - len(remaining.faces)
    return remaining, [
        *notes,
        f"supporting plane removed with {removed} faces" if removed else "no supporting plane found",
    ]
