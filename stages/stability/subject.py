"""One object of a test of stability: the points of every method, undisturbed and under each disturbance.

Several draws of one disturbance count as one: the mean of the measured values.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from haptic_glance.base.rng import rng
from haptic_glance.base.timing import Stopwatch
from haptic_glance.disturb.perturbed import Conditions, Perturbed
from haptic_glance.look.agreement import METRICS, GroundTruth
from haptic_glance.look.points.methods import find_all, method_named
from haptic_glance.look.points.options import Detection, Options
from haptic_glance.mesh import normalise
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.repair import orient
from stages.engine.run import Rows

from .disturbance import Disturbance
from .measures import TOLERANCE, at_original_vertices, chance_repeatability, drift, maps_under_conditions, repeatability

UNPERTURBED = "none"  # the perturbation in the rows of the unperturbed object
AGREEMENT = "nss", "auc"  # with people, of the saliency on the object that they saw


@dataclass(frozen=True, eq=False)
class Findings:
    """The findings of the methods on one mesh, per method, with the seconds that each took."""

    perturbed: Perturbed
    detections: dict[str, Detection]
    seconds: dict[str, float]


class Subject:
    """An object and the methods tried on it; `unperturbed` are the Findings without a perturbation.

    mesh: normalised; options: its seed and name decide all random numbers; count: points per method; size: (rows,
    columns) of the views; truth: what people looked at, where that is known.
    """

    def __init__(
        self, mesh: Mesh, methods: Sequence[str], options: Options, count: int, size: Sequence[int],
        truth: GroundTruth | None = None,
    ) -> None:  # fmt: skip
        self.truth = truth
        self.mesh, self.methods, self.options, self.count, self.size = mesh, methods, options, count, tuple(size)
        self.channels = tuple(dict.fromkeys(name for method in methods for name in method_named(method).channels))
        self.unperturbed = self._findings(Perturbed(mesh, mesh.vertices, Conditions()), UNPERTURBED)

    def disturbed(self, disturbance: Disturbance) -> Findings:
        """The Findings under one disturbance.

        Raises ValueError where this mesh cannot be perturbed in this way, or cannot be rendered afterwards.
        """
        changed, label = disturbance.apply(self.mesh, self.options.name, self.options.seed), str(disturbance)
        if changed.mesh.vertices is self.mesh.vertices and changed.mesh.faces is self.mesh.faces:
            return self._findings(changed, label, self._found_on_the_surface)
        return self._findings(replace(changed, mesh=normalise(orient(changed.mesh)[0])), label)

    @property
    def _found_on_the_surface(self):
        """The Detections that depend on vertices and faces alone.

        Random points are drawn anew each time: equal draws would look repeatable.
        """
        pairs = self.unperturbed.detections.items()
        return {
            name: detection
            for name, detection in pairs
            if not method_named(name).channels and detection.saliency is not None
        }

    def _findings(self, perturbed, label, known=None):
        """known: Detections that need not be found again; they keep the seconds that they took."""
        with Stopwatch() as watch:
            sight = maps_under_conditions(perturbed.mesh, self.channels, perturbed.conditions, self.size)
        options = replace(self.options, name=f"{self.options.name} {label}")
        detections, seconds = find_all(perturbed.mesh, sight, self.methods, options, self.count, known)
        seconds |= {method: self.unperturbed.seconds[method] for method in known or ()}
        image_based = [method for method in detections if method_named(method).channels]
        for method in image_based:
            seconds[method] += watch.seconds / len(image_based)
        return Findings(perturbed, detections, seconds)

    def unperturbed_rows(self) -> list[dict]:
        """Rows of the unperturbed object: how many points each method has, its agreement with people, its seconds."""
        return [
            self._row(method, None, *item, self.unperturbed.seconds[method])
            for method, detection in self.unperturbed.detections.items()
            for item in ({"points": detection.strong} | self._agreement(detection.saliency)).items()
        ]

    def rows(self, disturbance: Disturbance, case: Findings) -> list[dict]:
        """Rows of Findings: repeatability, chance (of as many random points), points; of a map drift and agreement."""
        rows = []
        for method, detection in case.detections.items():
            before = self.mesh.vertices[self.unperturbed.detections[method].points]
            tolerance = TOLERANCE * self.mesh.diagonal
            draws = rng(self.options.seed, f"{self.options.name} {disturbance} {method} chance")
            values = {
                "repeatability": repeatability(before, case.perturbed.original_positions[detection.points], tolerance),
                "chance": chance_repeatability(before, case.perturbed, len(detection.points), draws, tolerance),
                "points": detection.strong,
            }
            saliency = self.unperturbed.detections[method].saliency
            if saliency is not None and detection.saliency is not None:
                back = at_original_vertices(self.mesh, case.perturbed, detection.saliency)
                values |= {"drift": drift(saliency, back, self.mesh.vertex_areas)} | self._agreement(back)
            seconds = case.seconds[method]
            rows += [self._row(method, disturbance, *item, seconds) for item in values.items()]
        return rows

    def _agreement(self, saliency):
        if self.truth is None or saliency is None:
            return {}
        return {name: METRICS[name](saliency, self.truth) for name in AGREEMENT}

    def failed_rows(self, disturbance: Disturbance, why: str) -> list[dict]:
        """One row per method with the reason why there are no Findings."""
        return [self._row(method, disturbance, "repeatability", None, None, why) for method in self.methods]

    def _row(self, method, disturbance, metric, value, seconds, note=None):
        return {
            "item": self.options.name, "method": method,
            "perturbation": disturbance.name if disturbance else UNPERTURBED,
            "severity": disturbance.severity if disturbance else None,
            "note": note, "metric": metric, "value": value, "seconds": seconds,
        }  # fmt: skip


def worst_arrays(subject: Subject, cases: Sequence[tuple[Disturbance, Findings]]) -> dict[str, np.ndarray]:
    """Arrays of each method's worst case, for the figure: dict METHOD.KEY -> array.

    cases: of single perturbations. KEY: perturbation, severity, repeatability, points and saliency
    before and after, and vertices and faces of the perturbed mesh. Methods without a saliency are left out.
    """
    arrays = {}
    for method, plain in subject.unperturbed.detections.items():
        if plain.saliency is None or not cases:
            continue
        scores = [_score(subject, method, case) for _, case in cases]
        worst = int(np.argmin(scores))
        disturbance, case = cases[worst]
        detection, mesh = case.detections[method], case.perturbed.mesh
        assert detection.saliency is not None  # a method has one under every perturbation or under none
        values = {
            "perturbation": np.array(disturbance.name), "severity": np.float64(disturbance.severity or 0.0),
            "repeatability": np.float64(scores[worst]), "before_points": plain.points,
            "before_saliency": plain.saliency.astype(np.float32), "after_points": detection.points,
            "after_saliency": detection.saliency.astype(np.float32), "vertices": mesh.vertices, "faces": mesh.faces,
        }  # fmt: skip
        arrays |= {f"{method}.{key}": value for key, value in values.items()}
    return arrays


def _score(subject, method, case):
    before = subject.mesh.vertices[subject.unperturbed.detections[method].points]
    after = case.perturbed.original_positions[case.detections[method].points]
    return repeatability(before, after, TOLERANCE * subject.mesh.diagonal)


def mean_of_draws(draws: Sequence[Rows]) -> Rows:
    """Rows of one disturbance, those of the first draw with the means of all; a draw without values does not count.

    draws: the rows of each, in the same order, or fewer where it failed; those of the longest are taken.
    """
    longest = max(draws, key=len)
    groups: dict[tuple[str, str], list[dict]] = {}
    for row in (row for rows in draws for row in rows if row["value"] is not None):
        groups.setdefault((row["method"], row["metric"]), []).append(row)
    return [row | _means(groups.get((row["method"], row["metric"]), [])) for row in longest]


def _means(rows):
    return {key: sum(row[key] for row in rows) / len(rows) for key in ("value", "seconds") if rows}
