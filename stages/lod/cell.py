"""One cell of the comparison: an object, a method and a target, simplified and measured."""

from dataclasses import dataclass, field

import numpy as np

from stages.kit import Mesh, Stopwatch
from stages.kit.files import write_mesh

from .errors import errors_of
from .feasibility import InfeasibleTarget, frozen_faces, smallest_feasible
from .neighbourhood import neighbourhoods
from .shrink import shrunk_rings
from .simplify import simplify
from .targets import face_count, file_name
from .variant import SOFT, variant


@dataclass(frozen=True)
class Subject:
    """What all cells of one object share.

    Its mesh; the points and the saliency (n,) by method; its own pictures (views, rows, columns), taken once; human
    gaze spread over the surface (n,), where there is some; and what was made of it already, since many methods keep the
    same faces, above all where nothing can be kept.
    """

    name: str
    mesh: Mesh
    points: dict[str, np.ndarray]
    saliency: dict[str, np.ndarray]
    pictures: np.ndarray
    gaze: np.ndarray | None = None
    made: dict = field(default_factory=dict, repr=False)


@dataclass(frozen=True)
class Wish:
    """What a method would keep: vertex ids, most salient first, rings around each, or a weight (n,) a vertex."""

    keep: np.ndarray
    rings: np.ndarray
    weights: np.ndarray | None = None


@dataclass(frozen=True)
class Made:
    """A simplified mesh, the seconds that it took, and its errors as parts of rows."""

    mesh: Mesh
    seconds: float
    errors: list[dict]


def measure_cells(subject, method, folder, settings, seed):
    """The rows of one object and method at every target; meshes go to folder/NAME/METHOD_TARGET.npz.

    Every cell has at least its row `faces`: where there is no mesh its value is empty and `note` says why.
    """
    try:
        wish = wished(subject, variant(method), settings.rings)
    except ValueError as error:
        return [_row(subject, method, target) | {"note": str(error)} for target in settings.targets]
    known = {
        "points": len(wish.keep),
        "smallest_feasible": smallest_feasible(subject.mesh, wish.keep, wish.rings),
    }
    cells = [_row(subject, method, target) | known for target in settings.targets]
    return [row for cell in cells for row in _measured(subject, cell, wish, folder, settings, seed)]


def wished(subject, chosen, rings=3):
    """The Wish of a Variant for one object; ValueError where salient_points has not what it needs."""
    nothing = np.zeros(0, dtype=np.int64)
    if chosen.method is None:
        return Wish(nothing, nothing)
    if chosen.method not in subject.points:
        raise ValueError(f"salient_points has no {chosen.method}")
    saliency = subject.saliency.get(chosen.method)
    if chosen.way in (SOFT, "area") and saliency is None:
        raise ValueError(f"salient_points has no saliency of {chosen.method} on the vertices")
    if chosen.way == SOFT:
        return Wish(nothing, nothing, saliency)
    keep = subject.points[chosen.method]
    return Wish(keep, neighbourhoods(subject.mesh, keep, chosen.way, saliency, rings))


def _measured(subject, row, wish, folder, settings, seed):
    """All rows of one cell."""
    if row["asked"] >= len(subject.mesh.faces):
        return [row | {"note": f"the object has only {len(subject.mesh.faces)} faces"}]
    try:
        with Stopwatch() as watch:
            rings = shrunk_rings(subject.mesh, row["asked"], wish.keep, wish.rings) if settings.shrink else wish.rings
        made = _made(subject, row["asked"], wish, rings, settings, seed)
    except InfeasibleTarget as error:
        return [row | {"note": f"infeasible: {error}", "infeasible": True}]
    except Exception as error:  # whatever pymeshlab says: the other cells go on, this one says why
        return [row | {"note": " ".join(str(error).split()) or type(error).__name__}]
    write_mesh(folder / subject.name / file_name(row["method"], row["target"]), made.mesh)
    held, count = rings[rings >= 0], len(made.mesh.faces)
    row |= {"faces": count, "kept": len(held), "shrunk": bool((rings < wish.rings).any())}
    row |= {"rings": float(held.mean()) if len(held) else None}
    return [row | {"value": count, "seconds": watch.seconds + made.seconds}, *(row | part for part in made.errors)]


def _made(subject, asked, wish, rings, settings, seed):
    frozen = frozen_faces(subject.mesh, wish.keep, rings)
    key = asked, frozen.tobytes(), None if wish.weights is None else wish.weights.tobytes()
    if key not in subject.made:
        with Stopwatch() as watch:
            found = simplify(subject.mesh, asked, wish.keep, rings, settings.backend, weights=wish.weights)
        subject.made[key] = Made(found, watch.seconds, errors_of(subject, found, settings, seed))
    return subject.made[key]


def _row(subject, method, target):
    return {
        "object": subject.name, "method": method, "target": str(target),
        "asked": face_count(target, len(subject.mesh.faces)), "faces": None, "points": None, "kept": None,
        "rings": None, "smallest_feasible": None, "infeasible": False, "shrunk": False, "metric": "faces",
        "value": None, "seconds": None, "note": "",
    }  # fmt: skip
