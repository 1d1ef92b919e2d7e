"""One cell of the comparison: an object, a method and a target, simplified and measured."""

from dataclasses import dataclass, replace
from hashlib import sha256
from pathlib import Path

import numpy as np

from haptic_glance.base.files import write_mesh
from haptic_glance.base.timing import Stopwatch
from haptic_glance.lod.export import face_count, file_name
from haptic_glance.lod.feasibility import InfeasibleTarget, frozen_faces, smallest_feasible
from haptic_glance.lod.neighbourhood import neighbourhoods, shrunk_rings
from haptic_glance.lod.simplify import simplify
from haptic_glance.lod.task import SOFT, Variant, variant
from haptic_glance.mesh.mesh import Mesh

from .errors import measure_errors
from .inputs import ObjectInputs
from .schema import Params


@dataclass(frozen=True)
class KeepRule:
    """What a method preserves: vertex ids, most salient first, and rings around each, or a weight (n,) per vertex."""

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
    chosen = variant(method)
    settings = replace(settings, backend=chosen.backend or settings.backend)
    try:
        keep = keep_rule(inputs, chosen, settings.rings)
    except ValueError as error:
        return [_row(inputs, method, target) | {"note": str(error)} for target in settings.targets]
    smallest = smallest_feasible(inputs.mesh, keep.vertices, keep.rings)
    facts = {"points": len(keep.vertices), "smallest_feasible": smallest}
    cells = [_row(inputs, method, target) | facts for target in settings.targets]
    return [row for cell in cells for row in _cell_rows(inputs, cell, keep, folder, settings, seed)]


def keep_rule(inputs: ObjectInputs, chosen: Variant, rings: int = 3) -> KeepRule:
    """The KeepRule of a Variant for one object; ValueError where salient_points lacks the points or the saliency."""
    nothing = np.zeros(0, dtype=np.int64)
    if chosen.method is None:
        return KeepRule(nothing, nothing)
    if chosen.method not in inputs.points:
        raise ValueError(f"salient_points has no {chosen.method}")
    saliency = inputs.saliency.get(chosen.method)
    if chosen.rule in (SOFT, "area") and saliency is None:
        raise ValueError(f"salient_points has no saliency of {chosen.method} on the vertices")
    if chosen.rule == SOFT:
        return KeepRule(nothing, nothing, saliency)
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
        made = _simplified(inputs, row["asked"], keep, rings, settings, seed)
    except InfeasibleTarget as error:
        return [row | {"note": f"infeasible: {error}", "infeasible": True}]
    except Exception as error:  # whatever pymeshlab raises: noted, and the other cells go on
        return [row | {"note": " ".join(str(error).split()) or type(error).__name__}]
    write_mesh(folder / inputs.name / file_name(row["method"], row["target"]), made.mesh)
    kept, count = rings[rings >= 0], len(made.mesh.faces)
    row |= {"faces": count, "kept": len(kept), "shrunk": bool((rings < keep.rings).any())}
    row |= {"rings": float(kept.mean()) if len(kept) else None}
    return [row | {"value": count, "seconds": watch.seconds + made.seconds}, *(row | part for part in made.errors)]


def _simplified(inputs, faces, keep, rings, settings, seed):
    frozen = frozen_faces(inputs.mesh, keep.vertices, rings)
    key = settings.backend, faces, frozen.tobytes(), None if keep.weights is None else keep.weights.tobytes()
    if key not in inputs.cache:
        with Stopwatch() as watch:
            mesh = simplify(inputs.mesh, faces, keep.vertices, rings, settings.backend, weights=keep.weights)
        inputs.cache[key] = SimplifiedMesh(mesh, watch.seconds, _errors(inputs, mesh, settings, seed))
    return inputs.cache[key]


def _errors(inputs, mesh, settings, seed):
    """Of a mesh that two backends make alike, as where there is nothing to fit, measured once."""
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
