"""The turnable meshes of the page: each object beside its simplified levels, coloured by saliency or by error."""

import base64
from contextlib import suppress
from typing import Any

import numpy as np
from scipy.spatial import KDTree

from stages.kit import Mesh
from stages.lod import simplify, vertex_errors

from .drawing import colour_map, vivid
from .packing import SHADES, Store, ordered
from .results import NotRun, Results, some
from .style import label

METHODS = [  # those that the page offers, as far as they were run: each costs an object up to 5 kB
    "enhanced", "itti", "thesis_ssim", "mesh_saliency", "salient_points", "heat_kernel", "random",
]  # fmt: skip
INDEX_LIMIT = 65535  # 16-bit vertex ids
FINEST = 0.6  # of the object's faces: a finer level looks like the object itself and costs the page most
STEP = 0.75  # of the faces of the finer level before it: a closer one looks the same
TOP = 0.99  # of the coarsest level's vertices have an error below the top of the scale; the others show as the top
# Blue is equal, green small, yellow, red large: the scale of CloudCompare.
ERROR_COLOURS = ((38, 70, 200), (34, 160, 74), (245, 215, 50), (214, 30, 30))


def pack_viewer(results: Results) -> dict[str, Any]:
    """dict for the page's script: objects, colours. Raises NotRun without meshes or points.

    Objects are taken in the order of the settings; those that no longer fit into `viewer_kilobytes` are left out.
    """
    settings = results.settings
    objects, left_out, room = [], [], 1000 * settings.viewer_kilobytes
    for name in results.choose(settings.viewer_objects, settings.viewer_count):
        packed = pack_object(results, name)
        if len(packed["store"]) > room:
            left_out.append(name)
        else:
            room -= len(packed["store"])
            objects.append(packed)
    some(objects, f"no mesh fits into report.viewer_kilobytes={settings.viewer_kilobytes}; raise it", "report")
    place, stops = (np.linspace(0, 1, count) for count in (SHADES, len(ERROR_COLOURS)))
    errors = np.stack([np.interp(place, stops, channel) for channel in np.transpose(ERROR_COLOURS)], axis=1)
    shades = np.concatenate([255 * colour_map(place), errors]).round().astype(np.uint8)
    return {"objects": objects, "left_out": left_out, "colours": base64.b64encode(shades.tobytes()).decode("ascii")}


def pack_object(results: Results, name: str) -> dict[str, Any]:
    """One object: the full mesh, saliency and points by method, and chains of simplified meshes by method.

    `faces` counts those of the object itself; the full mesh has at most `viewer_faces`. A level has `error`, the
    distance of each vertex of the full mesh to it. All levels of all chains share one scale, `error_top` in % of the
    diagonal, so that the error is seen to grow along the slider; shades are its square root.
    """
    original, found, store = results.mesh(name), results.points(name), Store()
    full, nearest = shown_mesh(original, results.settings.viewer_faces)
    place = KDTree(full.vertices)
    shown = [method for method in METHODS if method in found] or list(found)
    saliency = {
        method: {"label": label(method), "values": store.put_shades(vivid(values)[nearest])}
        for method, values in results.saliency(name).items()
        if method in shown
    }
    points = {
        method: {"label": label(method), "ids": store.put_words(place.query(original.vertices[found])[1])}
        for method, found in results.strong_points(name).items()
        if method in shown
    }
    ladders = {}
    for method in results.settings.viewer_lod_methods:
        with suppress(NotRun):
            found = [ordered(mesh)[0] for _, mesh in results.lods(name, method)]
            levels = apart([mesh for mesh in found if len(mesh.faces) <= FINEST * len(full.faces)])
            ladders[method] = [(mesh, 100 * vertex_errors(mesh, full) / full.diagonal) for mesh in levels]
    top = max((float(np.quantile(error, TOP)) for levels in ladders.values() for _, error in levels), default=0.0)
    packed = {"name": name, "faces": len(original.faces), "full": _mesh(full, store), "saliency": saliency}
    packed |= {"points": points, "error_top": top}
    packed["ladders"] = {
        method: {"label": label(method), "levels": [_level(mesh, error, top, store) for mesh, error in levels]}
        for method, levels in ladders.items()
    }
    return packed | {"store": store.text()}


def apart(levels: list[Mesh]) -> list[Mesh]:
    """Those of the meshes, most faces first, that have STEP of the faces of the one kept before, or fewer."""
    kept = []
    for mesh in levels:
        if not kept or len(mesh.faces) <= STEP * len(kept[-1].faces):
            kept.append(mesh)
    return kept


def shown_mesh(mesh: Mesh, faces: int) -> tuple[Mesh, np.ndarray]:
    """(mesh, ids): the mesh, simplified where it has more faces; ids: the original vertex nearest to each of its."""
    large = len(mesh.faces) > faces or len(np.unique(mesh.faces)) > INDEX_LIMIT
    small = ordered(simplify(mesh, faces) if large else mesh)[0]
    return small, np.asarray(KDTree(mesh.vertices).query(small.vertices)[1])


def _mesh(mesh: Mesh, store: Store) -> dict[str, Any]:
    positions, triangles = store.put_positions(mesh.vertices), store.put_triangles(mesh.faces)
    return {"faces": len(mesh.faces), "positions": positions, "triangles": triangles}


def _level(mesh: Mesh, error: np.ndarray, top: float, store: Store) -> dict[str, Any]:
    """A simplified mesh, with the error (n,) of the full mesh's vertices in % of the diagonal."""
    return _mesh(mesh, store) | {
        "error": store.put_shades(np.sqrt(error / (top or 1.0))),
        "error_max": round(float(error.max()), 3),
        "error_mean": round(float(error.mean()), 4),
    }
