"""The turnable meshes of the page."""

import base64

import numpy as np
import point_cloud_utils
from scipy.spatial import cKDTree

from .drawing import colour_map, vivid
from .packing import SHADES, Store, ordered
from .results import NotRun
from .style import label

METHODS = [  # those that the page offers, as far as they were run: each costs an object up to 5 kB
    "enhanced", "itti", "thesis_ssim", "mesh_saliency", "salient_points", "heat_kernel", "random",
]  # fmt: skip
INDEX_LIMIT = 65535  # 16-bit vertex ids
FINEST = 0.6  # of the object's faces: a finer level looks like the object itself and costs the page most


def pack_viewer(results):
    """dict for the page's script: objects, colours. Raises NotRun without meshes or points.

    Objects are taken in the order of the settings; those that no longer fit into `viewer_kilobytes` are left out.
    """
    settings = results.settings
    objects, left_out, room = [], [], 1000 * settings.viewer_kilobytes
    for name in results.choose(settings.viewer_objects, settings.viewer_count):
        packed = pack_object(results, name)
        if len(packed["store"]) > room:
            left_out.append(name)
            continue
        room -= len(packed["store"])
        objects.append(packed)
    if not objects:
        raise NotRun(f"no mesh fits into report.viewer_kilobytes={settings.viewer_kilobytes}; raise it", "report")
    shades = (255 * colour_map(np.linspace(0, 1, SHADES))).round().astype(np.uint8)
    return {"objects": objects, "left_out": left_out, "colours": base64.b64encode(shades.tobytes()).decode("ascii")}


def pack_object(results, name):
    """One object: the full mesh, saliency and points by method, and ladders of simplified meshes by method."""
    original, store = results.mesh(name), Store()
    full, nearest = shown_mesh(original, results.settings.viewer_faces)
    place = cKDTree(full.vertices)
    found = results.points(name)
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
    packed = {"name": name, "full": _mesh(full, store), "saliency": saliency, "points": points, "ladders": {}}
    for method in results.settings.viewer_lod_methods:
        try:
            found = [ordered(mesh)[0] for _, mesh in results.lods(name, method)]
        except NotRun:
            continue
        levels = [_level(mesh, full, place, store) for mesh in found if len(mesh.faces) <= FINEST * len(full.faces)]
        packed["ladders"][method] = {"label": label(method), "levels": levels}
    return packed | {"store": store.text()}


def shown_mesh(mesh, faces):
    """(mesh, ids): the mesh, simplified where it has more faces; ids: the original vertex nearest to each of its."""
    small = mesh
    if len(mesh.faces) > faces or len(np.unique(mesh.faces)) > INDEX_LIMIT:
        from stages.lod import simplify  # MeshLab takes a second to load, and few data sets need it

        small = simplify(mesh, faces)
    small = ordered(small)[0]
    return small, cKDTree(mesh.vertices).query(small.vertices)[1]


def surface_distance(mesh, other):
    """(n,) distance of each vertex of `mesh` to the surface of `other`, in units."""
    faces = np.ascontiguousarray(other.faces, dtype=np.int64)
    vertices = np.ascontiguousarray(mesh.vertices)
    return point_cloud_utils.closest_points_on_mesh(vertices, np.ascontiguousarray(other.vertices), faces)[0]


def _mesh(mesh, store):
    positions, triangles = store.put_positions(mesh.vertices), store.put_triangles(mesh.faces)
    return {"faces": len(mesh.faces), "positions": positions, "triangles": triangles}


def _level(mesh, full, place, store):
    """A simplified mesh: each vertex names its nearest full one, whose saliency it takes, and carries an error.

    The error is the distance of the full mesh to this one, the largest over the full vertices nearest to the vertex.
    """
    error = np.zeros(len(mesh.vertices))
    np.maximum.at(error, cKDTree(mesh.vertices).query(full.vertices)[1], surface_distance(full, mesh))
    worst = float(error.max())
    return _mesh(mesh, store) | {
        "nearest": store.put_words(place.query(mesh.vertices)[1]),
        "error": store.put_shades(error / worst if worst else error),
        "error_max": round(100 * worst / full.diagonal, 3),
    }
