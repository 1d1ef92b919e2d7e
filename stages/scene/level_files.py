"""Exports the levels of a plan as GLB files with a manifest for viewers and engines, and checks the written files.

glTF has +y up and metres, so meshes are turned and scaled; colours become vertex colours. MSFT_lod is a vendor
extension of the Khronos registry: one node per level, the finest first, and as a hint the least share of the screen,
here of its height, at which to show each. manifest.json has the same, and the errors, without an extension. Every file
is loaded again after it is written, and checked.
"""

import io
import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import trimesh
from trimesh.exchange.gltf import export_glb

from haptic_glance.base.files import read_mesh, read_table, whole_file, write_json
from haptic_glance.lod.scene.camera import Scene, world_mesh
from haptic_glance.lod.scene.chain import Level, finest
from haptic_glance.mesh.gltf import parser_bytes, with_linear_colours
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.up import Y_UP

from . import Params
from .compare import OURS, read_chain
from .measure import MESH

FOLDER, MANIFEST = "export", "manifest.json"


def export(folder: Path, data: Path, scene: Scene, settings: Params) -> None:
    """Writes the GLB files of the plan in folder/plan.csv, and the manifest.

    Raises ValueError that names the file where one does not load back unchanged.
    """
    plan, rows = read_table(folder / "plan.csv"), []
    plan = plan[plan["in_view"]]
    meshes = {name: read_mesh(data / MESH.format(name)) for name in sorted(set(plan["item"]))}
    chains = {name: read_chain(folder / "levels" / name, OURS, finest(mesh)) for name, mesh in meshes.items()}
    sizes = {placed.name: placed.size for placed in reversed(scene.objects)}  # of several copies the first one's
    for name, chain in chains.items():
        level_numbers = sorted(set(plan.loc[plan["item"] == name, "level"]))
        levels = [chain[k] for k in level_numbers]
        entries = [describe(name, level, metres_per_unit(chain[0].mesh, sizes[name]), scene) for level in levels]
        for level, row in zip(levels, entries, strict=True):
            write_glb(folder / FOLDER / row["file"], [to_gltf(level.mesh, row["metres_a_unit"])], [row["file"][:-4]])
        if settings.msft_lod:
            write_lod(folder / FOLDER / f"{name}.glb", levels, entries, scene.cameras[0].size[0])
        rows += entries
    fullest = _fullest_frame(plan)
    if len(plan):
        write_scene(folder / FOLDER / "scene.glb", scene, meshes, chains, pd.DataFrame(plan[plan["frame"] == fullest]))
    manifest = {"scene": settings.name, "tolerance": scene.tolerance, "kind": scene.kind}
    manifest |= {"screen_rows": scene.cameras[0].size[0], "scene_of_frame": fullest, "levels": rows}
    write_json(folder / FOLDER / MANIFEST, manifest)


def describe(name: str, level: Level, metres: float, scene: Scene) -> dict[str, Any]:
    """The manifest's row of a level.

    error: 99 % quantile of its distance to the full surface, metres. enough_up_to: rows of the screen that the
    object's longest side may cover with that error within the tolerance; None for the full mesh, which is always
    enough, and where the tolerance is not in pixels.
    """
    error = level.error["q99"] * metres
    longest = metres * float(np.ptp(level.mesh.vertices[np.unique(level.mesh.faces)], axis=0).max())
    size_limit = scene.tolerance * longest / error if error > 0 and scene.kind == "pixels" else None
    return {
        "object": name, "level": f"{name}_{level.faces}", "file": f"{name}_{level.faces}.glb", "faces": level.faces,
        "error": float(f"{error:.6g}"), "size": float(f"{longest:.6g}"), "metres_a_unit": float(f"{metres:.9g}"),
        "enough_up_to": None if size_limit is None else float(f"{size_limit:.6g}"),
    }  # fmt: skip


def metres_per_unit(mesh: Mesh, longest: float) -> float:
    """Metres per unit of the mesh, for the longest side of its bounding box in metres."""
    return longest / float(np.ptp(mesh.vertices[np.unique(mesh.faces)], axis=0).max())


def to_gltf(mesh: Mesh, metres: float = 1.0) -> Mesh:
    """A Mesh in metres with +y up."""
    return Mesh(mesh.vertices @ Y_UP.T * metres, mesh.faces, mesh.colors, up="y")


def write_glb(
    path: Path, meshes: Sequence[Mesh], names: Sequence[str], edit: Callable[[dict], None] | None = None
) -> None:
    """Writes Meshes, unchanged, to one GLB, one node per mesh, and checks the file.

    edit: function of the glTF's JSON tree, or None. Raises ValueError where other meshes load back.
    """
    scene = trimesh.Scene()
    for mesh, name in zip(meshes, names, strict=True):
        shape = trimesh.Trimesh(mesh.vertices, mesh.faces, vertex_colors=mesh.colors, process=False)
        scene.add_geometry(shape, node_name=name, geom_name=name)
    content = with_linear_colours(export_glb(scene, include_normals=True, tree_postprocessor=edit))
    with whole_file(path) as part:
        part.write_bytes(content)
    check_glb(path, meshes, names)


def write_lod(path: Path, levels: Sequence[Level], rows: Sequence[dict], screen_rows: int) -> None:
    """Writes one GLB with all levels of an object, finest first, joined by MSFT_lod; rows: those of `describe`."""
    meshes = [to_gltf(level.mesh, row["metres_a_unit"]) for level, row in zip(levels, rows, strict=True)]
    names = [row["level"] for row in rows]

    def join(tree: dict) -> None:
        # trimesh adds a root node: removed, so that the coarser levels are referenced by the extension alone.
        places = {node.get("name"): node for node in tree["nodes"]}
        tree["nodes"], tree["scenes"] = [places[name] for name in names], [{"nodes": [0]}]
        if len(names) > 1:
            first, tree["extensionsUsed"] = tree["nodes"][0], [EXTENSION]
            first["extensions"] = {EXTENSION: {"ids": list(range(1, len(names)))}}
            sizes = [row["enough_up_to"] for row in rows[1:]]
            if None not in sizes:
                first["extras"] = {
                    "MSFT_screencoverage": [round(min(size / screen_rows, 1), 6) for size in sizes] + [0.0]
                }

    write_glb(path, meshes, names, join)
    if len(names) > 1 and read_lod(path) != names:
        raise ValueError(f"{path}: {EXTENSION} came back as {', '.join(read_lod(path))}")


def write_scene(
    path: Path, scene: Scene, meshes: Mapping[str, Mesh], chains: Mapping[str, Sequence[Level]], plan: pd.DataFrame
) -> None:
    """Writes a frame's rows of the plan as one GLB: every visible object at its level and place."""
    parts, names = [], []
    for item, level, faces in zip(plan["place"], plan["level"], plan["faces"], strict=True):
        placed = scene.objects[item]
        mesh = world_mesh(chains[placed.name][level].mesh, placed.pose(meshes[placed.name]))
        parts.append(to_gltf(mesh))
        names.append(f"{item}_{placed.name}_{faces}")
    write_glb(path, parts, names)


def _fullest_frame(plan):
    faces = plan.groupby("frame")["faces"].sum()
    return int(faces.idxmax()) if len(faces) else 0


EXTENSION = "MSFT_lod"
SINGLE = 1e-6  # of the largest coordinate: glTF stores 4 bytes a number


def check_glb(path: Path, meshes: Sequence[Mesh], names: Sequence[str]) -> None:
    """Raises ValueError that names the file unless it holds these Meshes under these names, in their order."""
    try:
        stream = io.BytesIO(parser_bytes(path.read_bytes()))
        loaded = trimesh.load_scene(stream, file_type="glb", process=False).geometry
    except Exception as error:  # whatever the reader raises: the file is at fault
        raise ValueError(f"{path} cannot be loaded back: {error}") from error
    if list(loaded) != list(names):
        raise ValueError(f"{path} came back with {', '.join(loaded) or 'nothing'} in place of {', '.join(names)}")
    for name, mesh in zip(names, meshes, strict=True):
        fault = _fault(loaded[name], mesh)
        if fault:
            raise ValueError(f"{path}: {name} came back with other {fault} than were written")


def _fault(loaded, mesh):
    """The part of a loaded mesh that differs from the Mesh: "faces", "positions" or "colours"; or ""."""
    if not np.array_equal(loaded.faces, mesh.faces):
        return "faces"
    tolerance = SINGLE * np.abs(mesh.vertices).max(initial=0)
    if (
        loaded.vertices.shape != mesh.vertices.shape
        or np.abs(loaded.vertices - mesh.vertices).max(initial=0) > tolerance
    ):
        return "positions"
    same_colors = mesh.colors is None or np.array_equal(loaded.visual.vertex_colors[:, :3], mesh.colors)
    return "" if same_colors else "colours"


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
