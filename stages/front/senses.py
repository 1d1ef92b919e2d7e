"""Looks at an object and presses the array on it, with the seconds of each part; both are cached.

Looking and learning use a mesh with the chosen number of faces. Test touches are pressed on the object itself, with all
its faces, since a coarse model must recognise the real object. The cost of a method is the cost of this method alone.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import numpy as np
from scipy.spatial import KDTree

from haptic_glance.base.files import read_arrays, read_json, read_mesh, write_arrays, write_json
from haptic_glance.base.lazy import cv2
from haptic_glance.base.timing import Stopwatch
from haptic_glance.know import features
from haptic_glance.lod import InfeasibleTarget, simplify
from haptic_glance.lod.export import face_count
from haptic_glance.look.camera import Viewpoint
from haptic_glance.look.channels import ViewMaps, conspicuity
from haptic_glance.look.channels.channels import mask_at_size
from haptic_glance.look.points.methods import METHODS, method_named
from haptic_glance.look.points.options import Options
from haptic_glance.look.views import TWELVE, render, viewpoint_set
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import Surface, press_many, touchable

from .space import SPACE, WHOLE, Choice, settings_of

SECONDS: tuple[str, ...] = ("simplifying", "looking", "surfaces", "pressing")  # of a Felt
FEW = 200  # faces of the mesh that everything is tried on before seconds count


@dataclass(frozen=True)
class Felt:
    """The touches of one object, the most salient place first.

    learned, asked: (k, 41) features of the imprints on the simplified mesh, and at the same places of the object;
    places: (k, 3); faces: of the simplified mesh; seconds: simplifying, looking, pressing (one touch) and surfaces
    (what is done once before the first touch).
    """

    learned: np.ndarray
    asked: np.ndarray
    places: np.ndarray
    faces: int
    seconds: dict[str, float]


class Senses:
    """Feels the objects of data sets: files {object: its mesh}; what was found is kept below `folder`."""

    def __init__(self, files: dict[str, Path], folder: Path, seed: int) -> None:
        cv2.setNumThreads(1)  # the seconds are those of one core
        self.files, self.folder, self.seed = files, folder, seed
        self._warm = False

    def feel(self, name: str, choice: Choice) -> Felt:
        """The first `choice.points` touches of an object; those where the array cannot stand are left out."""
        arrays = self._touches(name, choice)
        first = arrays["rank"] < choice.points
        seconds = dict(zip(SECONDS, arrays["seconds"].tolist(), strict=True))
        return Felt(
            arrays["learned"][first], arrays["asked"][first], arrays["places"][first], int(arrays["faces"]), seconds
        )

    def _touches(self, name, choice):
        """Arrays of an object's touches at the MOST places of a choice, from the disk where they were felt before."""
        sight = [part for part in (choice.method, choice.viewpoints, choice.image_rows) if part]
        path = self.folder / name / "-".join(map(str, [_folder(choice.level), *sight, f"{choice.cells}.npz"]))
        if not path.exists():
            self._warm_up()
            mesh, simplifying = self._level(name, choice.level)
            points, looking = self._places(name, choice, mesh)
            write_arrays(path, **press_both(mesh, _mesh(self.files[name]), points, choice, [simplifying, looking]))
        return read_arrays(path)

    def _level(self, name, level):
        """(the mesh of an object at a level, the seconds that it took to simplify), equal whenever it is asked for."""
        mesh, path = _mesh(self.files[name]), self.folder / name / f"{_folder(level)}.json"
        if level == WHOLE:
            return mesh, 0.0
        with Stopwatch() as watch:
            simple = _simplified(replace(mesh), face_count(level, len(mesh.faces)))
        if not path.exists():
            write_json(path, watch.seconds)
        return simple, read_json(path)

    def _places(self, name, choice, mesh):
        """((k,) vertices of the mesh, seconds of looking)."""
        settings = settings_of(choice).salient_points
        options = Options(selection=settings.selection, radius=settings.radius, smoothing=settings.smoothing,
                          seed=self.seed, name=name)  # fmt: skip
        if not choice.image_rows:
            with Stopwatch() as watch:
                points = METHODS[choice.method].find(replace(mesh), None, options, MOST).points
            return points, watch.seconds
        path = self.folder / name / f"{_folder(choice.level)}-{choice.image_rows}.npz"
        if not path.exists():
            write_arrays(path, **dict(looks(mesh, choice, options)))
        look = f"{choice.method}-{choice.viewpoints}"
        arrays = read_arrays(path, look)
        return arrays[f"{look} points"], float(arrays[f"{look} seconds"])

    def _warm_up(self):
        """Looks at and presses a small mesh in every way, once, so that no seconds hold the loading of code."""
        if self._warm:
            return
        self._warm = True
        mesh = simplify(_mesh(next(iter(self.files.values()))), FEW)
        for method in SPACE["method"]:
            choice = Choice(method, "four", 225, 20, 16, WHOLE, 1, "knn")
            if method_named(method).channels:
                points = dict(looks(mesh, choice, Options()))[f"{method}-four points"]
            else:
                points = METHODS[method].find(mesh, None, Options(), MOST).points
            press_both(mesh, mesh, points, choice, [0.0, 0.0])


def _simplified(mesh, count):
    """The mesh at a count of faces, or at the smallest that its parts allow."""
    try:
        return simplify(mesh, count)
    except InfeasibleTarget as error:
        return simplify(mesh, error.smallest)


@lru_cache(maxsize=128)
def _mesh(path):
    return read_mesh(path)


def _folder(level):
    return level.replace("%", "pct")


MOST = max(SPACE["points"])  # places that are looked for; fewer are the first of these
LOOKING = [name for name in SPACE["method"] if METHODS[name].channels]  # methods that need pictures
CHANNELS = tuple(dict.fromkeys(channel for name in LOOKING for channel in METHODS[name].channels))


def looks(mesh: Mesh, choice: Choice, options: Options) -> Iterator[tuple[str, np.ndarray]]:
    """(METHOD-VIEWPOINTS points, (k,)) and (... seconds, ()) of all methods that look, at one image size.

    Pictures, maps and lines of sight are made once, and each method pays for those that it needs by itself.
    """
    settings = settings_of(choice)
    pictures, cost = {}, {}
    for viewpoint in TWELVE:
        pictures[viewpoint], cost[viewpoint] = _picture(mesh, viewpoint, settings)
    for name in SPACE["viewpoints"]:
        viewpoints = viewpoint_set(name)
        maps = {channel: np.stack([pictures[view][channel] for view in viewpoints]) for channel in CHANNELS}
        mask = np.stack([pictures[view]["mask"] for view in viewpoints])
        with Stopwatch() as lines:
            sight = ViewMaps(replace(mesh), viewpoints, maps, mask)
            sight.vertex_values(sight.maps[CHANNELS[0]])  # factors the equations of the smoothing, which all need
        for method in LOOKING:
            with Stopwatch() as finding:
                points = METHODS[method].find(sight.mesh, sight, options, MOST).points
            parts = ("picture", *METHODS[method].channels)
            seconds = sum(cost[view][part] for view in viewpoints for part in parts)
            yield f"{method}-{name} points", points
            yield f"{method}-{name} seconds", np.array(seconds + lines.seconds + finding.seconds)


def _picture(mesh: Mesh, viewpoint: Viewpoint, settings) -> tuple[dict[str, np.ndarray], dict[str, float]]:
    """({channel: its map, "mask"}, {"picture", channel: seconds}) of one view."""
    size = tuple(settings.conspicuity.size)
    with Stopwatch() as watch:
        view = render(mesh, viewpoint, settings.views.size, settings.views.renderer)
        maps = {"mask": mask_at_size(view.mask, size)}
    seconds = {"picture": watch.seconds}
    for channel in CHANNELS:
        with Stopwatch() as watch:
            maps |= conspicuity(mesh, view, [channel], size)
        seconds[channel] = watch.seconds
    return maps, seconds


def press_both(
    mesh: Mesh, whole: Mesh, points: np.ndarray, choice: Choice, before: Sequence[float]
) -> dict[str, np.ndarray]:
    """Arrays of the touches at vertices (k,) of a mesh, and at the nearest vertices of the whole one.

    before: the seconds that it took to come so far, which those of pressing follow.
    """
    sensor = settings_of(choice).imprints
    cells = sensor.cells[0], sensor.cells[1]
    with Stopwatch() as once:
        surface = Surface(replace(whole))
        near = whole.used[KDTree(whole.vertices[whole.used]).query(mesh.vertices[points])[1]]
        is_touchable = touchable(surface.mesh, near)
    rank = np.flatnonzero(is_touchable & touchable(mesh, points))
    with Stopwatch() as pressing:
        queries = features(press_many(surface, near[rank], cells, sensor.pitch, contact=sensor.contact))
    learned = queries
    if mesh is not whole:
        learned = features(press_many(Surface(mesh), points[rank], cells, sensor.pitch, contact=sensor.contact))
    seconds = np.array([*before, once.seconds, pressing.seconds / max(len(rank), 1)])
    return {"learned": learned, "asked": queries, "places": mesh.vertices[points[rank]], "rank": rank,
            "faces": np.array(len(mesh.faces)), "seconds": seconds}  # fmt: skip
