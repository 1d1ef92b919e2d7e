"""Looks at an object and presses the array on it, with the seconds of each part; what was felt once is kept.

Where an object is looked at and how it feels is learned from a mesh of as many faces as were chosen. The touches that
ask are pressed on the object itself, with all its faces: a coarse model must know the real thing.
"""

from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import cv2
import numpy as np

from haptic_glance.base.files import read_arrays, read_json, read_mesh, write_arrays, write_json
from haptic_glance.base.timing import Stopwatch
from haptic_glance.lod import InfeasibleTarget, simplify
from haptic_glance.lod.export import face_count
from haptic_glance.look.points.methods import METHODS, method_named
from haptic_glance.look.points.options import Options

from .looking import MOST, looks
from .pressing import press_both
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
        found = self._touches(name, choice)
        first = found["rank"] < choice.points
        seconds = dict(zip(SECONDS, found["seconds"].tolist(), strict=True))
        return Felt(
            found["learned"][first], found["asked"][first], found["places"][first], int(found["faces"]), seconds
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
        found = read_arrays(path, look)
        return found[f"{look} points"], float(found[f"{look} seconds"])

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
