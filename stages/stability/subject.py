"""One object: what every method finds on it as it is, and under a perturbation."""

from dataclasses import dataclass, replace

import numpy as np

from stages.kit import Mesh, Stopwatch
from stages.kit.rng import rng
from stages.meshes import normalise
from stages.salient_points.methods import find_all, method_named
from stages.salient_points.options import Found, Options

from .measures import REACH, carried_back, chance_repeatability, drift, repeatability
from .perturbations import PERTURBATIONS, Conditions, Perturbed
from .sights import look

NONE = "none"  # the perturbation of rows about the object as it is


@dataclass(frozen=True, eq=False)
class Case:
    """What the methods found on one mesh: the Perturbed as it was looked at, dict method -> Found, its seconds."""

    perturbed: Perturbed
    found: dict[str, Found]
    seconds: dict[str, float]


class Subject:
    """An object and the methods to be tried on it; `plain` is the Case without a perturbation.

    mesh: normalised; options: stages.salient_points.options.Options, its seed and name decide all draws; count: points
    a method; size: (rows, columns) of the views.
    """

    def __init__(self, mesh: Mesh, methods, options: Options, count, size):
        self.mesh, self.methods, self.options, self.count, self.size = mesh, methods, options, count, tuple(size)
        self.channels = tuple(dict.fromkeys(name for method in methods for name in method_named(method).channels))
        self.plain = self._case(Perturbed(mesh, mesh.vertices, Conditions()), NONE)

    def disturbed(self, perturbation, severity):
        """The Case under one perturbation; ValueError where this mesh cannot be so changed, or be looked at then."""
        name = f"{self.options.name} {perturbation}"
        changed = PERTURBATIONS[perturbation].apply(self.mesh, severity, rng(self.options.seed, name))
        return self._case(replace(changed, mesh=normalise(changed.mesh)), f"{perturbation} {severity:g}")

    def _case(self, perturbed, what):
        """Random points are drawn anew for each case: drawn alike, they would seem to be found again."""
        with Stopwatch() as looking:
            sight = look(perturbed.mesh, self.channels, perturbed.conditions, self.size)
        options = replace(self.options, name=f"{self.options.name} {what}")
        found, seconds = find_all(perturbed.mesh, sight, self.methods, options, self.count)
        lookers = [method for method in found if method_named(method).channels]
        for method in lookers:
            seconds[method] += looking.seconds / len(lookers)
        return Case(perturbed, found, seconds)

    def plain_rows(self):
        """Rows of the object as it is: how many points each method has, and its seconds."""
        return [
            self._row(method, NONE, None, "points", found.strong, self.plain.seconds[method])
            for method, found in self.plain.found.items()
        ]

    def rows(self, perturbation, severity, case):
        """Rows of a Case: repeatability, chance (of as many random points), drift where there is a map, points."""
        rows = []
        for method, found in case.found.items():
            before = self.mesh.vertices[self.plain.found[method].points]
            reach = REACH * self.mesh.diagonal
            draws = rng(self.options.seed, f"{self.options.name} {perturbation} {severity:g} {method} chance")
            values = {
                "repeatability": repeatability(before, case.perturbed.places[found.points], reach),
                "chance": chance_repeatability(before, case.perturbed, len(found.points), draws, reach),
                "points": found.strong,
            }
            if found.saliency is not None:
                back = carried_back(self.mesh, case.perturbed, found.saliency)
                values["drift"] = drift(self.plain.found[method].saliency, back, self.mesh.vertex_areas)
            seconds = case.seconds[method]
            rows += [self._row(method, perturbation, severity, *item, seconds) for item in values.items()]
        return rows

    def failed_rows(self, perturbation, severity, why):
        """A row a method that says why there is no Case."""
        return [self._row(method, perturbation, severity, "repeatability", None, None, why) for method in self.methods]

    def _row(self, method, perturbation, severity, metric, value, seconds, note=None):
        return {
            "object": self.options.name, "method": method, "perturbation": perturbation, "severity": severity,
            "note": note, "metric": metric, "value": value, "seconds": seconds,
        }  # fmt: skip


def worst_arrays(subject, cases):
    """Arrays of each method's worst case, for the picture: dict METHOD.KEY -> array.

    cases: list of (perturbation, severity, Case). KEY: perturbation, severity, repeatability, and before and after of
    points and saliency; vertices and faces of the perturbed mesh. Methods without a saliency are left out.
    """
    arrays = {}
    for method, plain in subject.plain.found.items():
        if plain.saliency is None or not cases:
            continue
        scores = [_score(subject, method, case) for *_, case in cases]
        worst = int(np.argmin(scores))
        perturbation, severity, case = cases[worst]
        found, mesh = case.found[method], case.perturbed.mesh
        values = {
            "perturbation": np.array(perturbation), "severity": np.float64(severity),
            "repeatability": np.float64(scores[worst]), "before_points": plain.points,
            "before_saliency": plain.saliency.astype(np.float32), "after_points": found.points,
            "after_saliency": found.saliency.astype(np.float32), "vertices": mesh.vertices, "faces": mesh.faces,
        }  # fmt: skip
        arrays |= {f"{method}.{key}": value for key, value in values.items()}
    return arrays


def _score(subject, method, case):
    before = subject.mesh.vertices[subject.plain.found[method].points]
    after = case.perturbed.places[case.found[method].points]
    return repeatability(before, after, REACH * subject.mesh.diagonal)
