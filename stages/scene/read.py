"""From settings and data/ to a Scene, its meshes, and the options that spare their salient regions."""

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from haptic_glance.base.files import read_mesh, read_table
from haptic_glance.lod.scene.camera import Placed, Scene, bounds, fly
from haptic_glance.lod.task import variant
from haptic_glance.mesh.mesh import Mesh
from stages.lod.cell import keep_rule
from stages.lod.inputs import ObjectInputs
from stages.salient_points import read_saliency, read_strong_points

from .drawn import draw_scene
from .schema import Params

MESH, POINTS = "meshes/{}.npz", "salient_points/{}.npz"  # of an object, below data/SET
SIZES = "meshes/manifest.csv"  # in metres, of all objects


def scene_of(settings: Params, names: Sequence[str], factor: float = 1.0) -> tuple[Scene, list[str]]:
    """(Scene of the settings, its objects that are not among `names`), the tolerance times `factor`.

    Where none of its objects is among `names`, as with meshes of one's own, the named ones take their places in order,
    once each. Raises ValueError where the scene has no place, and as Scene and fly do.
    """
    missing = list(dict.fromkeys(item.name for item in settings.objects if item.name not in names))
    present = [(item.name, item) for item in settings.objects if item.name in names]
    present = present or list(zip(names, settings.objects, strict=False))
    if not present:
        raise ValueError(f"scene {settings.name} has no object, or data/SET/meshes is empty: choose another scene")
    placed = tuple(Placed(name, _place(item), item.turn, item.size) for name, item in present)
    if len(settings.screen) != 2:
        raise ValueError(f"scene.screen is {settings.screen}: give rows and columns")
    eyes, targets = ([getattr(key, end) for key in settings.camera] for end in ("eye", "target"))
    cameras = tuple(fly(eyes, targets, settings.frames, settings.angle, settings.screen))
    scene = Scene(placed, cameras, settings.tolerance * factor, settings.kind, settings.limit, settings.hold)
    return scene, missing


def _place(item):
    if len(item.position) != 3:
        raise ValueError(f"{item.name} stands at {item.position}: give x, y, z in metres")
    x, y, z = item.position
    return x, y, z


def scenes_of(settings: Params, names: Sequence[str], data: Path, seed: int) -> list[Params]:
    """The settings of each scene: the one that they are of, or as many as they let be drawn at random from `names`."""
    if not settings.random:
        return [settings]
    boxes = {name: bounds(read_mesh(data / MESH.format(name))) for name in names}
    table = read_table(data / SIZES, {"object": str})
    sizes = dict(zip(table["object"], table["size"].astype(float), strict=True))
    return [draw_scene(settings, number, boxes, sizes, seed) for number in range(settings.random)]


def report_missing(settings: Params, scene: Scene, missing: Sequence[str]) -> None:
    """Prints which objects are missing, and which take their places where none of the scene's own is present."""
    if missing:
        named = {item.name for item in settings.objects}
        others = ", ".join(dict.fromkeys(item.name for item in scene.objects if item.name not in named))
        how = f"with {others} in their places" if others else "without them"
        print(f"scene: {settings.name} continues {how}; not in data/SET/meshes: {', '.join(missing)}", file=sys.stderr)


def read_object(data: Path, name: str, method: str) -> tuple[Mesh, dict[str, Any], np.ndarray | None]:
    """(Mesh, options of simplify, saliency (n,) or None) of an object in data/SET, for a method of the lod stage."""
    path = data / POINTS.format(name)
    mesh, saliency = read_mesh(data / MESH.format(name)), read_saliency(path)
    chosen = variant(method)
    rule = keep_rule(ObjectInputs(name, mesh, read_strong_points(path), saliency), chosen)
    options = {"keep": rule.vertices, "rings": rule.rings, "weights": rule.weights}
    return mesh, options, saliency.get(chosen.method or "")
