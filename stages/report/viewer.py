"""Packs each object beside its levels, coloured by saliency or by error, for the viewer of the front page."""

from contextlib import suppress
from typing import Any

import numpy as np
from scipy.spatial import KDTree

from haptic_glance.base.packing import SHADES, Level, ordered, pack, viewer_data
from haptic_glance.lod import vertex_errors
from haptic_glance.lod.export import shown_mesh
from haptic_glance.mesh.mesh import Mesh
from stages.charts.drawing import colour_map, label, vivid
from stages.charts.results import NotRun, Results, require_rows
from stages.lod.levels import levels_of
from stages.salient_points.measure import read_points, read_saliency, read_strong_points

METHODS = [  # those that the page offers, as far as they were run: each costs an object up to 5 kB
    "glance", "itti", "thesis_ssim", "mesh_saliency", "salient_points", "heat_kernel", "random",
]  # fmt: skip
FINEST = 0.6  # of the object's faces: a finer level looks like the object itself and costs the page most
STEP = 0.75  # of the faces of the finer level before it: a closer one looks the same


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
    require_rows(objects, f"no mesh fits into report.viewer_kilobytes={settings.viewer_kilobytes}; raise it", "report")
    colours = 255 * colour_map(np.linspace(0, 1, SHADES))
    return viewer_data(objects, colours, left_out)


def viewer_or_reason(results: Results) -> dict[str, Any] | str:
    """`pack_viewer`; the reason where there is nothing to pack, and for a folder of a person's own meshes."""
    if results.own_meshes:
        return "the page of an own folder has no viewer"
    try:
        return pack_viewer(results)
    except NotRun as missing:
        return str(missing)


def pack_object(results: Results, name: str) -> dict[str, Any]:
    """One object: the full mesh, saliency and points by method, and chains of simplified meshes by method.

    `faces` counts those of the object itself; the full mesh has at most `viewer_faces`. A level has `error`, the
    distance of each vertex of the full mesh to it.
    """
    original, points_by_method = results.mesh(name), results.by_method("salient_points", read_points, name)
    full, nearest = shown_mesh(original, results.settings.viewer_faces)
    place = KDTree(full.vertices)
    methods = [method for method in METHODS if method in points_by_method] or list(points_by_method)
    saliency = {
        method: (f"saliency: {label(method)}", vivid(values)[nearest])
        for method, values in results.by_method("salient_points", read_saliency, name).items()
        if method in methods
    }
    points = {
        method: (label(method), np.asarray(place.query(original.vertices[vertices])[1]))
        for method, vertices in results.by_method("salient_points", read_strong_points, name).items()
        if method in methods
    }
    ladders = {}
    for method in results.settings.viewer_lod_methods:
        with suppress(NotRun):
            meshes = [ordered(mesh)[0] for _, mesh in levels_of(results, name, method)]
            levels = apart([mesh for mesh in meshes if len(mesh.faces) <= FINEST * len(full.faces)])
            ladders[method] = (
                label(method),
                [Level(mesh, 100 * vertex_errors(mesh, full) / full.diagonal, len(mesh.faces)) for mesh in levels],
            )
    return pack(name, len(original.faces), full, saliency, points, ladders)


def apart(levels: list[Mesh]) -> list[Mesh]:
    """The meshes, most faces first, that have STEP of the faces of the one kept before, or fewer."""
    spaced_meshes = []
    for mesh in levels:
        if not spaced_meshes or len(mesh.faces) <= STEP * len(spaced_meshes[-1].faces):
            spaced_meshes.append(mesh)
    return spaced_meshes
