"""The rows of one object: what is right after each number of touches, undisturbed, disturbed, and of unseen objects."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from pathlib import Path
from typing import Any

import numpy as np

from haptic_glance.base.files import read_mesh
from haptic_glance.know import SURE, Library, learn
from haptic_glance.know.split import Split
from haptic_glance.lod import simplify
from haptic_glance.lod.feasibility import InfeasibleTarget, SimplifyError
from haptic_glance.look.points import find_points
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import warm_up
from stages.salient_points.measure import read_points

from . import Params
from .protocol import ATTENTION, Case, Disturbance, touch_on

CLEAN = "none"
PLACES = 60  # of attention, of each object
SEEN = {  # sight: the policies that are tried after it
    "blind": ("planned", "spread", "random", "glance", "touch", "thesis_ssim"),
    "look": ("planned", "spread", "random", "glance", "touch", "thesis_ssim"),
    "look_told": ("planned",),
    "dark": ("planned",),
    "siblings": ("planned", "spread", "glance"),
}
DISTURBED, DISTURBED_TOUCHES = ("blind", "look"), 1
UNSEEN_TOUCHES = 3


@dataclass(frozen=True)
class Perturbation:
    """unit: of its severities, in words; unharmed: the severity that changes nothing; harder: what changes."""

    unit: str
    unharmed: float
    harder: Callable[[float], Disturbance] | None = None


def _with(name: str, change: Callable[[float], float] = float) -> Callable[[float], Disturbance]:
    """A function from a severity to a Disturbance that differs in one field."""
    return lambda severity: replace(Disturbance(), **{name: change(severity)})


PERTURBATIONS = {
    "hidden": Perturbation("share of the object's pixels", 0.6, _with("hidden")),
    "darkness": Perturbation("share of the light that is absent", 0.0, _with("light", lambda absent: 1 - absent)),
    "noise": Perturbation("times the sensor's noise", 1.0, _with("noise")),
    "position": Perturbation("diameters beside the place", 0.01, _with("position")),
    "size": Perturbation("times the known size", 1.0, _with("size")),
    "coarse_mesh": Perturbation("faces of the known meshes", 20_000.0),
}


@lru_cache(maxsize=8)  # as they are, and each number of faces
def library_of(folder: Path, names: tuple[str, ...], faces: int = 0) -> Library:
    """The Library of the meshes of a folder, simplified to a number of faces, 0 for as they are."""
    meshes = {name: read_mesh(folder / f"{name}.npz") for name in names}
    if faces:
        meshes = {name: coarse(mesh, faces) for name, mesh in meshes.items()}
    return learn(meshes)


def coarse(mesh: Mesh, faces: int) -> Mesh:
    """The mesh with a number of faces at most, or with the fewest of twice, four times ... as many that it can have."""
    while len(mesh.faces) > faces:
        try:
            return simplify(mesh, faces)
        except (InfeasibleTarget, SimplifyError):
            faces *= 2
    return mesh


def process(
    name: str, folder: Path, data: Path, names: Sequence[str], classes: dict[str, str], settings: Params, seed: int
) -> list[dict[str, Any]]:
    """The rows of one object; it is looked at and touched in each of its poses."""
    warm_up()
    meshes = data / "meshes"
    mesh, library = read_mesh(meshes / f"{name}.npz"), library_of(meshes, tuple(names))
    places = attention(mesh, data / "salient_points" / f"{name}.npz")
    case = partial(Case, library, name, mesh, seed=seed, places=places)
    kin = [other for other in names if classes[other] == classes[name]]
    common = {"item": name, "group": classes[name]}
    rows = undisturbed(case, places, kin, settings)
    rows += disturbed(case, settings) if settings.disturbed else []
    for faces in settings.severities.get("coarse_mesh", ()) if settings.disturbed else ():
        rough = library_of(meshes, tuple(names), int(faces))
        other = partial(Case, rough, name, mesh, seed=seed, places=places)
        rows += _disturbed(other, settings, "coarse_mesh", faces, Disturbance())
    if len(kin) > 2:
        rows += unseen(case, kin, classes, settings)
    return [common | row for row in rows]


def attention(mesh: Mesh, points: Path) -> dict[str, np.ndarray]:
    """{policy: positions (p, 3)} of the places where attention goes."""
    chosen = read_points(points)
    places = {method: chosen[method][:PLACES] for method in ("glance", "thesis_ssim") if method in chosen}
    places["touch"] = find_points(mesh, purpose="touch", count=PLACES)
    return {policy: mesh.vertices[ids] for policy, ids in places.items() if len(ids)}


def undisturbed(
    case: Callable[..., Case], places: dict[str, np.ndarray], kin: Sequence[str], settings: Params
) -> list[dict[str, Any]]:
    """Rows `right` after each number of touches, `touches_to_sure`, `sure` and `sure_right`, for each sight and way."""
    rows = []
    for sight, policies in SEEN.items():
        if sight == "siblings" and len(kin) < 2:
            continue
        for policy in policies:
            if policy in ATTENTION and policy not in places:
                continue
            rows += _followed(case, sight, policy, kin, settings)
    return rows


def _followed(case, sight, policy, kin, settings):
    """The rows of one sight and one way to choose touches, over all poses."""
    right, stated, seconds = [], [], []
    for pose in range(settings.poses):
        one = case(pose)
        course = touch_on(one, one.look(sight, kin), policy, settings.touches)
        right.append(course.probabilities.argmax(axis=1) == one.library.names.index(one.name))
        stated.append(course.probabilities.max(axis=1))
        seconds.append(course.seconds)
    common = {"method": policy, "sight": sight, "perturbation": CLEAN, "severity": 0.0}
    right, stated = np.array(right), np.array(stated)
    sure = stated >= SURE
    is_sure, last = sure.any(axis=1), np.where(sure.any(axis=1), sure.argmax(axis=1), settings.touches)
    ends = right[np.arange(len(right)), last]
    cost = float(np.mean(seconds))
    rows = [
        {"metric": "right", "touches": count, "value": float(share), "seconds": cost}
        for count, share in enumerate(right.mean(axis=0))
    ]
    rows += [
        {"metric": "touches_to_sure", "value": float(last.mean())},
        {"metric": "sure", "value": float(is_sure.mean())},
        {"metric": "sure_right", "value": float((is_sure & ends).mean())},
    ]
    rows[0]["_answers"] = np.stack([stated.ravel(), right.ravel()], axis=1).round(4).tolist()
    return [common | row for row in rows]


def disturbed(case: Callable[..., Case], settings: Params) -> list[dict[str, Any]]:
    """Rows `right` of planned touches, blind and after a look, at each severity of each perturbation."""
    return [
        row
        for name, severities in settings.severities.items()
        if (harder := PERTURBATIONS[name].harder)
        for severity in severities
        for row in _disturbed(case, settings, name, severity, harder(severity))
    ]


def _disturbed(case, settings, name, severity, disturbance):
    rows = []
    for sight in DISTURBED:
        right = []
        for pose in range(settings.poses):
            one = case(pose, disturbance)
            course = touch_on(one, one.look(sight), "planned", DISTURBED_TOUCHES)
            right.append(course.probabilities.argmax(axis=1) == one.library.names.index(one.name))
        common = {"method": "planned", "sight": sight, "perturbation": name, "severity": float(severity)}
        rows += [
            common | {"metric": "right", "touches": count, "value": float(share)}
            for count, share in enumerate(np.mean(right, axis=0))
        ]
    return rows


def unseen(
    case: Callable[..., Case], kin: Sequence[str], classes: dict[str, str], settings: Params
) -> list[dict[str, Any]]:
    """Rows `class_right`: whether the class of an object is found that is not among the known ones itself."""
    rows = []
    for sight in DISTURBED:
        right = []
        for pose in range(settings.poses):
            one = case(pose)
            library, others = one.library, [other for other in one.library.names if other != one.name]
            course = touch_on(one, one.look(sight).among(others), "planned", UNSEEN_TOUCHES)
            kinds = np.array([classes[other] for other in library.names])
            sums = np.stack([course.probabilities[:, kinds == kind].sum(axis=1) for kind in np.unique(kinds)], axis=1)
            right.append(np.unique(kinds)[sums.argmax(axis=1)] == classes[one.name])
        common = {"method": "planned", "sight": sight, "perturbation": CLEAN, "severity": 0.0, "split": Split.OBJECTS}
        rows += [
            common | {"metric": "class_right", "touches": count, "value": float(share)}
            for count, share in enumerate(np.mean(right, axis=0))
        ]
    return rows
