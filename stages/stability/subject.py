"""One object of a test of stability: the points of every method, undisturbed and under each perturbation."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from haptic_glance.base.rng import rng
from haptic_glance.base.timing import Stopwatch
from haptic_glance.disturb.objects import PERTURBATIONS
from haptic_glance.disturb.perturbed import Conditions, Perturbed
from haptic_glance.look.points.methods import find_all, method_named
from haptic_glance.look.points.options import Detection, Options
from haptic_glance.mesh import normalise
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.repair import orient

from .repeatability import (
    TOLERANCE,
    at_original_vertices,
    chance_repeatability,
    drift,
    maps_under_conditions,
    repeatability,
)

UNPERTURBED = "none"  # the perturbation in the rows of the unperturbed object


@dataclass(frozen=True, eq=False)
class Findings:
    """The findings of the methods on one mesh, per method, with the seconds that each took."""

    perturbed: Perturbed
    detections: dict[str, Detection]
    seconds: dict[str, float]


class Subject:
    """An object and the methods tried on it; `unperturbed` are the Findings without a perturbation.

    mesh: normalised; options: its seed and name decide all random numbers; count: points per method; size: (rows,
    columns) of the views.
    """

    def __init__(self, mesh: Mesh, methods: Sequence[str], options: Options, count: int, size: Sequence[int]) -> None:
        self.mesh, self.methods, self.options, self.count, self.size = mesh, methods, options, count, tuple(size)
        self.channels = tuple(dict.fromkeys(name for method in methods for name in method_named(method).channels))
        self.unperturbed = self._findings(Perturbed(mesh, mesh.vertices, Conditions()), UNPERTURBED)

    def rows(self, perturbation: str, severity: float) -> list[dict]:
        """Rows under one perturbation: repeatability, chance (of as many random points), points, drift of a map.

        Where this mesh cannot be perturbed in this way, or not be rendered afterwards, one row per method says why.
        """
        label = f"{perturbation} {severity:g}"
        try:
            case = self._disturbed(perturbation, severity, label)
        except ValueError as error:
            return [
                self._row(method, perturbation, severity, "repeatability", None, None, str(error))
                for method in self.methods
            ]
        rows = []
        for method, detection in case.detections.items():
            before = self.mesh.vertices[self.unperturbed.detections[method].points]
            tolerance = TOLERANCE * self.mesh.diagonal
            draws = rng(self.options.seed, f"{self.options.name} {label} {method} chance")
            values = {
                "repeatability": repeatability(before, case.perturbed.original_positions[detection.points], tolerance),
                "chance": chance_repeatability(before, case.perturbed, len(detection.points), draws, tolerance),
                "points": detection.strong,
            }
            saliency = self.unperturbed.detections[method].saliency
            if saliency is not None and detection.saliency is not None:
                back = at_original_vertices(self.mesh, case.perturbed, detection.saliency)
                values["drift"] = drift(saliency, back, self.mesh.vertex_areas)
            seconds = case.seconds[method]
            rows += [self._row(method, perturbation, severity, *item, seconds) for item in values.items()]
        return rows

    def unperturbed_rows(self) -> list[dict]:
        """Rows of the unperturbed object: how many points each method has, and its seconds."""
        return [
            self._row(method, UNPERTURBED, None, "points", detection.strong, self.unperturbed.seconds[method])
            for method, detection in self.unperturbed.detections.items()
        ]

    def _disturbed(self, perturbation: str, severity: float, label: str) -> Findings:
        generator = rng(self.options.seed, f"{self.options.name} {perturbation}")
        changed = PERTURBATIONS[perturbation].apply(self.mesh, severity, generator)
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

    def _row(self, method, perturbation, severity, metric, value, seconds, note=None):
        return {
            "item": self.options.name, "method": method, "perturbation": perturbation, "severity": severity,
            "note": note, "metric": metric, "value": value, "seconds": seconds,
        }  # fmt: skip
