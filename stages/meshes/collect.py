"""Turns the mesh files of a source into meshes for the later stages, with metadata and classes (T4.3.2, T4.4.10)."""

import hashlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy.sparse.csgraph import connected_components
from trimesh.resolvers import ZipResolver

from haptic_glance.base.fetch import FetchError
from haptic_glance.base.files import read_table
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
        content, painted, needs_files = item.content(), colours != "vertex", reads_beside(item, colours)
        beside = item.beside() if needs_files else {}
        resolver = ZipResolver({name: data for name, data in beside.items() if data})
        parsed = parse(content, item.suffix, resolver if needs_files else None, painted, item.file)
        raw, notes = clean(settled(parsed if item.up == AUTO else replace(parsed, up=item.up)))
        notes += [f"{name}, which it names, is not there" for name, data in beside.items() if not data]
        if remove_table:
            raw, notes = _without_table(raw, notes)
        mesh = normalise(rotate_to_z_up(raw))
        mesh = coloured(mesh, item.name, colours, item.suffix) if painted else mesh
        if len(mesh.faces) < FEW:
            notes.append(f"only {len(mesh.faces)} faces: too few for what is measured on surfaces to say much")
    except (FetchError, ValueError, OSError) as error:
        raise MeshError(str(error)) from error
    vertex_ids = np.unique(mesh.faces)
    counts = mesh.edge_counts[1]
    components = connected_components(mesh.adjacency[vertex_ids][:, vertex_ids])[0]
    return mesh, {
        "object": item.name, "file": item.file, "licence": item.licence, "creator": item.creator, "unit": item.unit,
        "up": raw.up, "size": float(np.ptp(raw.vertices[np.unique(raw.faces)], axis=0).max()),
        "vertices": len(mesh.vertices), "faces": len(mesh.faces), "parts": int(components),
        "watertight": mesh.watertight, "open_edges": int((counts == 1).sum()),
        "nonmanifold_edges": int((counts > 2).sum()), "colors": mesh.colors is not None,
        "repairs": "; ".join(notes), "sha256": hashlib.sha256(content).hexdigest(),
    }  # fmt: skip


def reads_beside(item: MeshFile, colours: str) -> bool:
    """Whether a mesh is made of the files beside its own, too: those of its colours or of its geometry."""
    return colours != "vertex" or item.suffix in (DEPTH, ".gltf")


def _without_table(mesh, notes):
    remaining = remove_plane(mesh)
    removed = len(mesh.faces) - len(remaining.faces)
    return remaining, [
        *notes,
        f"supporting plane removed with {removed} faces" if removed else "no supporting plane found",
    ]


FEW = 20  # faces
CLASSES = "classes.csv"  # in data/SET/meshes: the class of each object, in the order of meshes.classes


def read_classes(folder: str | Path) -> dict[str, list[str]]:
    """{class: its objects} of data/SET/meshes, in the order of meshes.classes; objects that were refused are not there.

    Raises ValueError where the data set has no classes.
    """
    path = Path(folder) / CLASSES
    if not path.exists():
        raise ValueError(f"{path} is not there: name the classes of this data set in meshes.classes")
    table = read_table(path)
    return {str(name): list(rows["object"]) for name, rows in table.groupby("class", sort=False)}


def chosen_objects(objects: Sequence[str], classes: Mapping[str, Sequence[str]]) -> list[str]:
    """The objects to take: those named, or else those of all classes; an empty list stands for all of the source.

    Raises ValueError for a class without objects and for an object that is named twice.
    """
    if not all(classes.values()):
        raise ValueError("meshes.classes: every class must name at least one object")
    members = [name for names in classes.values() for name in names]
    twice = sorted({name for name in members if members.count(name) > 1})
    if twice:
        raise ValueError(f"meshes.classes: {', '.join(twice)} named twice; an object belongs to one class")
    return list(objects) or members


def small_classes(classes: Mapping[str, Sequence[str]], accepted: Sequence[str]) -> Iterator[dict[str, Any]]:
    """Rows with a note, one per class that is left with fewer than two objects."""
    for name, objects in classes.items():
        count = len(set(objects) & set(accepted))
        if count < 2:
            note = f"class {name} has {count} of its {len(objects)} objects: none of it can be held out"
            yield {"group": name, "metric": "objects", "value": count, "note": note}
