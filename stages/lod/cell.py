"""One cell of the comparison: an object, a method and a target, simplified and measured."""

from dataclasses import dataclass

import numpy as np

from stages.kit import Mesh, Stopwatch
from stages.kit.files import write_mesh
from stages.views import viewpoint_set

from .feasibility import InfeasibleTarget, smallest_feasible
from .metro import metro
from .perceptual import picture_errors, take_pictures
from .simplify import simplify
from .targets import face_count, file_name

PLAIN = "qem"


@dataclass(frozen=True)
class Subject:
    """What all cells of one object share: its mesh, its points by method, and its own pictures."""

    name: str
    mesh: Mesh
    points: dict[str, np.ndarray]
    pictures: np.ndarray


def measure_cells(subject, method, folder, settings, seed):
    """The rows of one object and method at every target; meshes go to folder/NAME/METHOD_TARGET.npz.

    Every cell has at least its row `faces`: where there is no mesh its value is empty and `note` says why.
    """
    if method != PLAIN and method not in subject.points:
        return [
            _row(subject, method, target, note="salient_points has none by this name") for target in settings.targets
        ]
    keep = None if method == PLAIN else subject.points[method]
    smallest = smallest_feasible(subject.mesh, keep, settings.rings)
    rows = []
    for target in settings.targets:
        found, row = _simplified(subject, method, target, keep, settings)
        row["smallest_feasible"] = smallest
        rows.append(row)
        if found is not None:
            write_mesh(folder / subject.name / file_name(method, target), found)
            rows += _errors(subject, found, row, settings, seed)
    return rows


def _simplified(subject, method, target, keep, settings):
    """(Mesh or None, the row `faces`)."""
    total = len(subject.mesh.faces)
    row = _row(subject, method, target, points=0 if keep is None else len(keep), asked=face_count(target, total))
    if row["asked"] >= total:
        return None, row | {"note": f"the object has only {total} faces"}
    try:
        with Stopwatch() as watch:
            found = simplify(subject.mesh, row["asked"], keep, settings.rings, settings.backend)
    except InfeasibleTarget as error:
        return None, row | {"note": f"infeasible: {error}", "infeasible": True}
    except Exception as error:  # whatever pymeshlab says: the other cells go on, this one says why
        return None, row | {"note": " ".join(str(error).split()) or type(error).__name__}
    count = len(found.faces)
    return found, row | {"faces": count, "value": count, "seconds": watch.seconds}


def _errors(subject, found, row, settings, seed):
    with Stopwatch() as watch:
        errors = metro(subject.mesh, found, settings.samples, seed)
    rows = [row | {"metric": f"metro_{name}", "value": errors[name], "seconds": watch.seconds} for name in errors]
    try:
        with Stopwatch() as watch:
            pictures = take_pictures(found, viewpoint_set(settings.viewpoints), tuple(settings.size))
            value, note = picture_errors(subject.pictures, pictures)["ssim"], ""
    except ValueError as error:
        value, note = None, str(error)
    return [*rows, row | {"metric": "ssim_error", "value": value, "seconds": watch.seconds, "note": note}]


def _row(subject, method, target, points=None, asked=None, note=""):
    return {
        "object": subject.name, "method": method, "target": str(target), "asked": asked, "faces": None,
        "points": points, "smallest_feasible": None, "infeasible": False, "metric": "faces", "value": None,
        "seconds": None, "note": note,
    }  # fmt: skip
