"""From settings and data/ to a Scene, its meshes, and how their salient places are minded."""

import sys

from stages.kit.files import read_mesh
from stages.kit.run import DATA
from stages.lod.cell import Subject, wished
from stages.lod.variant import variant
from stages.salient_points import read_saliency, read_strong_points

from .camera import fly
from .place import Placed, Scene


def scene_of(settings, known, factor=1.0):
    """(Scene, names left out since they are not among `known`), the tolerance times `factor`.

    Where none of its objects is known, as with meshes of one's own, those that are known stand in their places, in
    their order, once each. Raises ValueError where the scene has no place, and for what Scene and fly refuse.
    """
    missing = list(dict.fromkeys(item.name for item in settings.objects if item.name not in known))
    there = [(item.name, item) for item in settings.objects if item.name in known]
    there = there or list(zip(known, settings.objects, strict=False))
    if not there:
        raise ValueError(f"scene {settings.name} names no object, or data/meshes is empty: take another")
    placed = tuple(Placed(name, _place(item), item.turn, item.size) for name, item in there)
    if len(settings.screen) != 2:
        raise ValueError(f"scene.screen is {settings.screen}: give rows and columns")
    eyes, targets = ([getattr(key, end) for key in settings.camera] for end in ("eye", "target"))
    cameras = tuple(fly(eyes, targets, settings.frames, settings.angle, settings.screen))
    scene = Scene(placed, cameras, settings.tolerance * factor, settings.kind, settings.limit, settings.hold)
    return scene, missing


def _place(item):
    if len(item.position) != 3:
        raise ValueError(f"{item.name} stands at {item.position}: give x, y, z in metres")
    return tuple(item.position)


def say_missing(settings, scene, missing):
    """Tells a person which objects the scene goes on without, and which stand in where it has none of its own."""
    if missing:
        named = {item.name for item in settings.objects}
        others = ", ".join(dict.fromkeys(item.name for item in scene.objects if item.name not in named))
        on = f"with {others} in their places" if others else "on without them"
        print(f"scene: {settings.name} goes {on}; not in data/meshes: {', '.join(missing)}", file=sys.stderr)


def read_object(name, method):
    """(Mesh, options of simplify, saliency (n,) or None) of an object in data/, by the name of a method of lod."""
    path = DATA / "salient_points" / f"{name}.npz"
    mesh, saliency = read_mesh(DATA / "meshes" / f"{name}.npz"), read_saliency(path)
    wish = wished(Subject(name, mesh, read_strong_points(path), saliency, None), variant(method))
    options = {"keep": wish.keep, "rings": wish.rings, "weights": wish.weights}
    return mesh, options, saliency.get(variant(method).method)
