"""The levels that a plan shows as GLB files that a viewer or an engine reads, with a manifest.

glTF has +y up and metres, so meshes are turned and scaled; colours go along as vertex colours. MSFT_lod is a vendor
extension of the Khronos registry: one node a level, the finest first, and as a hint the least share of the screen at
which each is to be shown, here of its height. manifest.json says the same, and the errors, without an extension. Every
file is loaded back once it is written.
"""

import numpy as np
import trimesh

from stages.kit import Mesh
from stages.kit.files import read_mesh, read_table, whole_file, write_json
from stages.kit.run import DATA

from .compare import OURS
from .ladder import finest
from .loaded_back import EXTENSION, check_glb, read_lod
from .place import world_mesh
from .read import scene_of
from .storage import read_ladder

FOLDER, MANIFEST = "export", "manifest.json"
Y_UP = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])


def export(folder, settings, objects):
    """Writes the GLB files of what the plan in folder/plan.csv shows, and the manifest.

    Raises ValueError that names the file where one cannot be loaded back as it was meant.
    """
    scene, _ = scene_of(settings, objects)
    plan, rows = read_table(folder / "plan.csv"), []
    plan = plan[plan["in_view"]]
    meshes = {name: read_mesh(DATA / "meshes" / f"{name}.npz") for name in sorted(set(plan["object"]))}
    ladders = {name: read_ladder(folder / "levels" / name, OURS, finest(mesh)) for name, mesh in meshes.items()}
    sizes = {placed.name: placed.size for placed in reversed(scene.objects)}  # of the first of several copies
    for name, ladder in ladders.items():
        used = sorted(set(plan.loc[plan["object"] == name, "level"]))
        levels = [ladder[k] for k in used]
        found = [describe(name, level, size_in_metres(ladder[0].mesh, sizes[name]), scene) for level in levels]
        for level, row in zip(levels, found, strict=True):
            write_glb(folder / FOLDER / row["file"], [to_gltf(level.mesh, row["metres_a_unit"])], [row["file"][:-4]])
        if settings.msft_lod:
            write_lod(folder / FOLDER / f"{name}.glb", levels, found, scene.cameras[0].size[0])
        rows += found
    nearest = _frame_with_most(plan)
    if len(plan):
        write_scene(folder / FOLDER / "scene.glb", scene, meshes, ladders, plan[plan["frame"] == nearest])
    manifest = {"scene": settings.name, "tolerance": scene.tolerance, "kind": scene.kind}
    manifest |= {"screen_rows": scene.cameras[0].size[0], "scene_of_frame": nearest, "levels": rows}
    write_json(folder / FOLDER / MANIFEST, manifest)


def describe(name, level, metres, scene):
    """The manifest's row of a level.

    error: 99 % quantile of its distance to the full surface, metres. enough_up_to: rows of the screen that the
    object's longest side may take while that error stays within the tolerance; None for the full mesh, which is always
    enough, and where the tolerance is not in pixels.
    """
    error = level.error["q99"] * metres
    longest = metres * float(np.ptp(level.mesh.vertices[np.unique(level.mesh.faces)], axis=0).max())
    enough = scene.tolerance * longest / error if error > 0 and scene.kind == "pixels" else None
    return {
        "object": name, "level": f"{name}_{level.faces}", "file": f"{name}_{level.faces}.glb", "faces": level.faces,
        "error": float(f"{error:.6g}"), "size": float(f"{longest:.6g}"), "metres_a_unit": float(f"{metres:.9g}"),
        "enough_up_to": None if enough is None else float(f"{enough:.6g}"),
    }  # fmt: skip


def size_in_metres(mesh, longest):
    """Metres a unit of the mesh, for a longest side of the bounding box in metres."""
    return longest / float(np.ptp(mesh.vertices[np.unique(mesh.faces)], axis=0).max())


def to_gltf(mesh, metres=1.0):
    """A Mesh in metres with +y up."""
    return Mesh(mesh.vertices @ Y_UP.T * metres, mesh.faces, mesh.colors)


def write_glb(path, meshes, names, edit=None):
    """Writes Meshes, as they are, to one GLB, a node each, and loads it back.

    edit: function of the glTF's JSON tree, or None. Raises ValueError where other meshes come back.
    """
    scene = trimesh.Scene()
    for mesh, name in zip(meshes, names, strict=True):
        scene.add_geometry(_trimesh(mesh), node_name=name, geom_name=name)
    content = trimesh.exchange.gltf.export_glb(scene, include_normals=True, tree_postprocessor=edit)
    with whole_file(path) as part:
        part.write_bytes(content)
    check_glb(path, meshes, names)


def write_lod(path, levels, rows, screen_rows):
    """Writes one GLB with all levels of an object, finest first, joined by MSFT_lod; rows: what `describe` says."""
    meshes = [to_gltf(level.mesh, row["metres_a_unit"]) for level, row in zip(levels, rows, strict=True)]
    names = [row["level"] for row in rows]

    def join(tree):
        # trimesh puts a node above all: it goes, so that the coarser levels hang on the extension alone.
        places = {node.get("name"): node for node in tree["nodes"]}
        tree["nodes"], tree["scenes"] = [places[each] for each in names], [{"nodes": [0]}]
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


def write_scene(path, scene, meshes, ladders, plan):
    """Writes a frame's rows of the plan as one GLB: every object that it shows at its level, where it stands."""
    shown, names = [], []
    for row in plan.itertuples():
        placed = scene.objects[row.item]
        mesh = world_mesh(ladders[placed.name][row.level].mesh, placed.pose(meshes[placed.name]))
        shown.append(to_gltf(mesh))
        names.append(f"{row.item}_{placed.name}_{row.faces}")
    write_glb(path, shown, names)


def _trimesh(mesh):
    return trimesh.Trimesh(mesh.vertices, mesh.faces, vertex_colors=mesh.colors, process=False)


def _frame_with_most(plan):
    shown = plan.groupby("frame")["faces"].sum()
    return int(shown.idxmax()) if len(shown) else 0
