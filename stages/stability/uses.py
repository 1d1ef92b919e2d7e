"""The worth of the points of a disturbed object: the whole object is simplified around them, and recognised there.

Recognition by touch is tested at the points of the disturbed object, with touches learned on undisturbed objects.
"""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np
from scipy.spatial import KDTree

from haptic_glance.base.files import read_arrays
from haptic_glance.base.rng import rng
from haptic_glance.know import classifier, features
from haptic_glance.lod import simplify, surface_errors
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import Surface, press_many, touchable
from stages.engine.run import Rows

from .disturbance import Disturbance
from .subject import UNPERTURBED, Findings, Subject

# Among half of the faces there is room around ten points: the error where undisturbed objects are salient falls by
# about 15 %. At a quarter, or around thirty points, what is kept leaves too little for the rest.
TARGET, KEPT = 0.5, 10
SAMPLES = 3000  # of a surface: the mean error is then exact to 2 %
SENSOR_NOISE = 0.02  # sigma of a reading, share of full scale: nothing is felt twice in the same way
PLAIN = "plain"  # the perturbation in the rows of a simplification that keeps nothing
LEARNED = "learned"  # touches of the object as it is, with which those of a disturbed one are compared


class Uses:
    """The uses of the points that methods find on one Subject; `rows` and `touches` grow by each `add`."""

    def __init__(self, subject: Subject, methods: Sequence[str]) -> None:
        self.subject, self.methods, self.mesh = subject, methods, subject.mesh
        self.surface, self.used = Surface(subject.mesh), np.unique(subject.mesh.faces)
        self.rows: list[dict] = []
        self.touches: dict[str, np.ndarray] = {}  # METHOD.PERTURBATION: (k, 41) features of what is felt
        self._errors: dict[tuple[str, bytes], dict[str, float]] = {}
        for method in methods:
            self._measure(method, PLAIN, None, np.zeros(0, dtype=np.int64))
            self._touch(method, LEARNED, self._at_original(subject.unperturbed, method))
        self.add(None, subject.unperturbed)

    def add(self, disturbance: Disturbance | None, case: Findings) -> None:
        """Measures the points found under a disturbance; None: on the object as it is."""
        name, severity = (disturbance.name, disturbance.severity) if disturbance else (UNPERTURBED, None)
        for method in self.methods:
            points = self._at_original(case, method)
            self._measure(method, name, severity, points)
            self._touch(method, name, points)

    def _at_original(self, case: Findings, method: str) -> np.ndarray:
        """(k,) vertices of the object as it is, nearest to where a method's points lie on it, each one time."""
        places = case.perturbed.original_positions[case.detections[method].points].reshape(-1, 3)
        nearest = self.used[KDTree(self.mesh.vertices[self.used]).query(places)[1]]
        return np.array(list(dict.fromkeys(nearest.tolist())), dtype=np.int64)

    def _measure(self, method, perturbation, severity, points):
        key = method, points.tobytes()  # what cannot be seen changes no point
        if key not in self._errors:
            self._errors[key] = _errors(self.mesh, points[:KEPT], self.subject.unperturbed.detections[method].saliency)
        common = {"item": self.subject.options.name, "method": method, "perturbation": perturbation}
        self.rows += [
            common | {"severity": severity, "metric": f"lod_{metric}", "value": value}
            for metric, value in self._errors[key].items()
        ]

    def _touch(self, method, perturbation, points):
        images = press_many(self.surface, points[touchable(self.mesh, points)])
        noise = rng(self.subject.options.seed, f"{self.subject.options.name} {perturbation} {method} touch")
        noisy_images = images + SENSOR_NOISE * noise.standard_normal(images.shape)
        self.touches[f"{method}.{perturbation}"] = features(noisy_images.clip(0, 1))


def _errors(mesh: Mesh, points: np.ndarray, saliency: np.ndarray | None) -> dict[str, float]:
    """Metro's mean error of the mesh simplified around points, and that weighted by a saliency, where there is one."""
    simplified = simplify(mesh, max(int(TARGET * len(mesh.faces)), 1), keep=points, shrink=True)
    judges = {} if saliency is None or not saliency.any() else {"salient": np.clip(saliency, 0, None)}
    errors = surface_errors(mesh, simplified, judges, SAMPLES)
    return {name: errors[name] for name in ("mean", *judges)}


SET = 10  # objects that are told apart
PARTITIONS = 5  # of all objects into such sets
FOLDER = "touches"


def recognise(
    item: str, folder: Path, made: Path, objects: list[str], severities: Mapping[str, float], seed: int
) -> Rows:
    """Rows of each object, method and perturbation: the share of its touches that are recognised among SET objects.

    made: the folder of the stage, whose touches/NAME.npz have METHOD.PERTURBATION: (k, 41) features. severities: of
    each perturbation that has one. A nearest neighbour learned the touches METHOD.learned of all objects of a set.
    """
    touches = {name: read_arrays(made / FOLDER / f"{name}.npz") for name in objects}
    recognised: dict[tuple[str, str], list[float]] = {}
    for group in partitions(objects, seed):
        for method in (key.removesuffix(f".{LEARNED}") for key in touches[group[0]] if key.endswith(f".{LEARNED}")):
            learned = [touches[name][f"{method}.{LEARNED}"] for name in group]
            model = classifier("knn", seed).fit(np.concatenate(learned), np.repeat(group, list(map(len, learned))))
            for name in group:
                for key, felt in touches[name].items():
                    if key.startswith(f"{method}.") and len(felt) and key != f"{method}.{LEARNED}":
                        recognised.setdefault((name, key), []).append(float((model.predict(felt) == name).mean()))
    rows = []
    for (name, key), shares in recognised.items():
        method, _, perturbation = key.partition(".")
        common = {"item": name, "group": f"sets of {min(SET, len(objects))}", "method": method, "metric": "recognised"}
        severity = severities.get(perturbation)
        rows.append(common | {"perturbation": perturbation, "severity": severity, "value": float(np.mean(shares))})
    return rows


def partitions(objects: list[str], seed: int) -> Iterator[list[str]]:
    """The sets of PARTITIONS divisions of all objects, each of SET objects or a few more, or of all there are."""
    for number in range(PARTITIONS):
        mixed = rng(seed, f"partition {number}").permutation(sorted(objects))
        yield from (part.tolist() for part in np.array_split(mixed, max(len(objects) // SET, 1)))
