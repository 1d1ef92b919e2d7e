"""One cell of the comparison of levels: an object, a method and a target, simplified and measured.

The cells of an object share its inputs. Each error has its cost. A first call loads compiled code before seconds are
measured.
"""

import functools
from dataclasses import dataclass, field, replace
from functools import cached_property
from hashlib import sha256
from pathlib import Path

import numpy as np

from haptic_glance.base.files import write_mesh
from haptic_glance.base.lazy import trimesh
from haptic_glance.base.timing import Stopwatch
from haptic_glance.lod.errors import metro, surface_errors
from haptic_glance.lod.export import face_count, file_name
from haptic_glance.lod.feasibility import InfeasibleTarget, frozen_faces, smallest_feasible
from haptic_glance.lod.neighbourhood import neighbourhoods, shrunk_rings
from haptic_glance.lod.perceptual import Analysis, analyse, picture_errors, take_pictures
from haptic_glance.lod.simplify import BACKEND, simplify
from haptic_glance.lod.task import SOFT, Variant, variant
from haptic_glance.look.views import viewpoint_set
from haptic_glance.look.weights.weights import GLANCE
from haptic_glance.mesh.mesh import Mesh

from . import Params


@dataclass(frozen=True)
class ObjectInputs:
    """The inputs that all cells of one object share.

    Its mesh; the points and the saliency (n,) by method; its own pictures (views, rows, columns), or None where they
    are not compared; human gaze spread over the surface (n,), or None; and a cache of its simplified meshes and their
    errors, since many methods keep the same faces, above all where nothing can be kept.
    """

    name: str
    mesh: Mesh
    points: dict[str, np.ndarray]
    saliency: dict[str, np.ndarray]
    pictures: np.ndarray | None = None
    gaze: np.ndarray | None = None
    cache: dict = field(default_factory=dict, repr=False)

    @cached_property
    def analyses(self) -> list[Analysis] | None:
        """The analyses of its own pictures, for comparisons."""
        return None if self.pictures is None else analyse(self.pictures)


@dataclass(frozen=True)
class KeepRule:
    """The vertices that a method keeps: ids, most salient first, and rings around each, or a weight (n,) per vertex."""

    vertices: np.ndarray
    rings: np.ndarray
    weights: np.ndarray | None = None


@dataclass(frozen=True)
class SimplifiedMesh:
    """A simplified mesh, the seconds it took, and its errors as parts of rows."""

    mesh: Mesh
    seconds: float
    errors: list[dict]


def measure_cells(inputs: ObjectInputs, method: str, folder: Path, settings: Params, seed: int) -> list[dict]:
    """The rows of one object and method at every target; writes the meshes to folder/NAME/METHOD_TARGET.npz.

    Every cell has at least its row `faces`: where there is no mesh its value is empty and `note` gives the reason.
    """
    lod_variant = variant(method)
    settings = replace(settings, backend=lod_variant.backend or settings.backend)
    try:
        keep = keep_rule(inputs, lod_variant, settings.rings)
    except ValueError as error:
        return [_row(inputs, method, target) | {"note": str(error)} for target in settings.targets]
    smallest = smallest_feasible(inputs.mesh, keep.vertices, keep.rings)
    facts = {"points": len(keep.vertices), "smallest_feasible": smallest}
    cells = [_row(inputs, method, target) | facts for target in settings.targets]
    return [row for cell in cells for row in _cell_rows(inputs, cell, keep, folder, settings, seed)]


def keep_rule(inputs: ObjectInputs, chosen: Variant, rings: int = 3) -> KeepRule:
    """The KeepRule of a Variant for one object; ValueError where salient_points lacks the points or the saliency."""
    no_points = np.zeros(0, dtype=np.int64)
    if chosen.method is None:
        return KeepRule(no_points, no_points)
    if chosen.method not in inputs.points:
        raise ValueError(f"salient_points has no {chosen.method}")
    saliency = inputs.saliency.get(chosen.method)
    if chosen.rule in (SOFT, "area") and saliency is None:
        raise ValueError(f"salient_points has no saliency of {chosen.method} on the vertices")
    if chosen.rule == SOFT:
        return KeepRule(no_points, no_points, saliency)
    vertices = inputs.points[chosen.method]
    return KeepRule(vertices, neighbourhoods(inputs.mesh, vertices, chosen.rule or "fixed", saliency, rings))


def _cell_rows(inputs, row, keep, folder, settings, seed):
    """All rows of one cell."""
    if row["asked"] >= len(inputs.mesh.faces):
        return [row | {"note": f"the object has only {len(inputs.mesh.faces)} faces"}]
    try:
        with Stopwatch() as watch:
            rings = keep.rings
            if settings.shrink:
                rings = shrunk_rings(inputs.mesh, row["asked"], keep.vertices, rings)
        simplified = _simplified(inputs, row["asked"], keep, rings, settings, seed)
    except InfeasibleTarget as error:
        return [row | {"note": f"infeasible: {error}", "infeasible": True}]
    except Exception as error:  # whatever pymeshlab raises: noted, and the other cells go on
        return [row | {"note": " ".join(str(error).split()) or type(error).__name__}]
    write_mesh(folder / inputs.name / file_name(row["method"], row["target"]), simplified.mesh)
    kept_rings, count = rings[rings >= 0], len(simplified.mesh.faces)
    row |= {"faces": count, "kept": len(kept_rings), "shrunk": bool((rings < keep.rings).any())}
    row |= {"rings": float(kept_rings.mean()) if len(kept_rings) else None}
    return [
        row | {"value": count, "seconds": watch.seconds + simplified.seconds},
        *(row | part for part in simplified.errors),
    ]


def _simplified(inputs, faces, keep, rings, settings, seed):
    frozen = frozen_faces(inputs.mesh, keep.vertices, rings)
    key = settings.backend, faces, frozen.tobytes(), None if keep.weights is None else keep.weights.tobytes()
    if key not in inputs.cache:
        with Stopwatch() as watch:
            mesh = simplify(inputs.mesh, faces, keep.vertices, rings, settings.backend, weights=keep.weights)
        inputs.cache[key] = SimplifiedMesh(mesh, watch.seconds, _errors(inputs, mesh, settings, seed))
    return inputs.cache[key]


def _errors(inputs, mesh, settings, seed):
    """Computes the errors once when two backends return the same mesh."""
    key = sha256(mesh.vertices.tobytes() + mesh.faces.tobytes()).digest()
    if key not in inputs.cache:
        inputs.cache[key] = measure_errors(inputs, mesh, settings, seed)
    return inputs.cache[key]


def _row(inputs, method, target):
    return {
        "item": inputs.name, "method": method, "target": str(target),
        "asked": face_count(target, len(inputs.mesh.faces)), "faces": None, "points": None, "kept": None,
        "rings": None, "smallest_feasible": None, "infeasible": False, "shrunk": False, "metric": "faces",
        "value": None, "seconds": None, "note": "",
    }  # fmt: skip


SALIENCY_METHOD = GLANCE  # its saliency weights the salient error of all methods


def measure_errors(inputs: ObjectInputs, mesh: Mesh, settings: Params, seed: int) -> list[dict]:
    """Parts of rows {metric, value, seconds, note} of one mesh; seconds are those of the call behind the metric."""
    parts = []
    for measure in (_surface, _pictures, _sizes):
        with Stopwatch() as watch:
            values, note = measure(inputs, mesh, settings, seed)
        for name, value in values.items():
            parts.append({"metric": name, "value": value, "seconds": watch.seconds, "note": note})
    return parts


def _surface(inputs, mesh, settings, seed):
    saliencies = {"salient_error": inputs.saliency.get(SALIENCY_METHOD), "gaze_error": inputs.gaze}
    saliencies = {name: values for name, values in saliencies.items() if values is not None and values.any()}
    errors = surface_errors(inputs.mesh, mesh, saliencies, settings.samples, seed)
    return {name if name in saliencies else f"metro_{name}": value for name, value in errors.items()}, ""


def _pictures(inputs, mesh, settings, _):
    try:
        pictures = take_pictures(mesh, viewpoint_set(settings.viewpoints), tuple(settings.size))
        errors = picture_errors(inputs.pictures, pictures, inputs.analyses)
    except ValueError as error:  # a mesh that leaves the frame
        return {"ssim_error": None}, str(error)
    return {"ssim_error" if name == "ssim" else name: value for name, value in errors.items()}, ""


def _sizes(_inputs, mesh, *_):
    areas = mesh.face_areas
    return {"area_deviation": float(areas.std() / areas.mean())}, ""  # T3.2.7: triangles of roughly equal size


FACES = 200  # of 1,280: few enough that every step of the backends runs


@functools.cache
def warm_up(backend: str = BACKEND) -> None:
    """Simplifies a small ball and measures it, once per process and backend."""
    ball = trimesh.creation.icosphere(subdivisions=3, radius=0.5)
    mesh = Mesh(ball.vertices, ball.faces)
    metro(mesh, simplify(mesh, FACES, [0], 1, backend, shrink=True), samples=100)
    simplify(mesh, FACES, backend=backend, weights=np.linspace(0, 1, len(mesh.vertices)))
