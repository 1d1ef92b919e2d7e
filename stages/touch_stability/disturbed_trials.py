"""Trials of recognition by disturbed touches: train on clean touches, test on disturbed ones, and vice versa.

Test touches are at other places: at random, or on unseen regions.
"""

import itertools
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
from sklearn import config_context
from sklearn.pipeline import Pipeline
from threadpoolctl import threadpool_limits

from haptic_glance.base.files import files_below, read_arrays, read_mesh, write_arrays
from haptic_glance.base.rng import rng
from haptic_glance.base.timing import Stopwatch
from haptic_glance.disturb.touch_disturbances import SOFT, TOUCH_PERTURBATIONS, Touches
from haptic_glance.know import SPLITS, classifier, features, split_touches
from haptic_glance.know import features as features_of
from haptic_glance.look.weights.weights import GLANCE
from stages.engine.run import Rows
from stages.imprints.imprints import read_imprints
from stages.salient_points.measure import read_saliency

from . import Params
from .denoisers import DENOISERS


def trial(item: str, folder: Path, made: Path, objects: list[str], settings: Params, width: float, seed: int) -> Rows:
    """The rows of one repetition; the item's name ends with its number. made: the folder of the objects' touches."""
    repetition = int(item.rpartition(" ")[2])
    object_arrays = [read_arrays(made / f"{name}.npz") for name in objects]

    def gathered(key):
        return np.concatenate([arrays[key] for arrays in object_arrays])

    def perturbed_features(perturbation, severity, features, denoise):
        draw = repetition % DRAWS if TOUCH_PERTURBATIONS[perturbation].random_draws else 0
        key = f"{perturbation}.{severity:g}.{draw}"
        if not all(key in arrays for arrays in object_arrays):
            return None
        if features in denoise:
            return features_of(denoise[features](gathered(f"images.{key}")))
        return gathered(key) if features == "imprint" else np.hstack([gathered(key), gathered(f"{key}.positions")])

    places, images = gathered("positions"), gathered("images.clean")
    clean = {"imprint": gathered("clean"), "imprint_place": np.hstack([gathered("clean"), places])}
    truth = np.repeat(np.arange(len(objects)), len(places) // len(objects))
    common = {"group": settings.set, "method": settings.method, "repetition": repetition, "chance": 1 / len(objects)}
    rows = []
    # One thread gives equal sums on any number of cores. The fits are so small that checks would take longer.
    with threadpool_limits(1), config_context(assume_finite=True, skip_parameter_validation=True):
        for split in SPLITS:
            random = rng(seed, f"repetition {repetition} {SPLITS[split]}")
            try:
                train, test = split_touches(truth, places, split, width, random)
                denoise = {
                    f"imprint_{name}": DENOISERS[name](images[train], seed + repetition) for name in settings.denoisers
                }
                samples = clean | {name: features_of(apply(images)) for name, apply in denoise.items()}
                scores = recognition_rows(
                    samples, partial(perturbed_features, denoise=denoise), truth, random.permutation(train), test,
                    settings.severities, settings.classifiers, repetition,
                )  # fmt: skip
                rows += [common | {"split": split} | row | {"note": None} for row in scores]
            except ValueError as error:
                note = f"set {settings.set}, {split}: {error}"
                rows.append(common | {"split": split, "metric": "accuracy", "value": None, "note": note})
    return rows


DRAWS = 3  # of a random perturbation; the repetitions use them in turn


def touches_of(name: str, data: Path, settings: Params, count: int, seed: int) -> Touches:
    """The first `count` Touches of an object, with the simplified meshes that exist. data: data/SET."""
    imprints = read_imprints(data / "imprints" / f"{name}.npz")[settings.method]
    paths = [path for path in files_below(data / "lod" / name) if path.stem.rpartition("_")[0] in ("qem", SOFT)]
    levels = {path.stem: read_mesh(path) for path in paths}
    saliency = read_saliency(data / "salient_points" / f"{name}.npz").get(GLANCE)
    mesh, cells = read_mesh(data / "meshes" / f"{name}.npz"), imprints.images.shape[1:]
    return Touches(name, mesh, imprints.vertices[:count], cells, float(imprints.pitch), saliency, levels, seed)


def process(name: str, folder: Path, data: Path, settings: Params, count: int, seed: int) -> Rows:
    """Writes all disturbed touches of one object; returns a row per severity that is not available."""
    touches, rows = touches_of(name, data, settings, count, seed), []
    arrays = {"clean": features(touches.images), "positions": touches.positions}
    arrays["images.clean"] = touches.images
    for key, severity in perturbation_severities(settings.severities):
        perturbation = TOUCH_PERTURBATIONS[key]
        for draw in range(DRAWS if perturbation.random_draws else 1):
            if perturbation.apply is None:
                break
            try:
                perturbed = perturbation.apply(touches, severity, draw)
            except ValueError as error:
                note = f"{key} {severity:g} left out: {name}: {error}"
                where = {"item": name, "perturbation": key, "severity": severity}
                rows.append(where | {"metric": "accuracy", "value": None, "note": note})
                break
            arrays[f"{key}.{severity:g}.{draw}"] = features(perturbed.images)
            if settings.denoisers:
                arrays[f"images.{key}.{severity:g}.{draw}"] = perturbed.images
            if perturbed.positions is not None:
                arrays[f"{key}.{severity:g}.{draw}.positions"] = perturbed.positions
    write_arrays(folder / f"{name}.npz", **arrays)
    return rows


FEATURES = ("imprint", "imprint_place")  # imprints alone, and with their positions (T table 4.5)
CLEAN = "none"  # the perturbation in rows of undisturbed touches


def recognition_rows(
    clean: dict[str, np.ndarray],
    perturbed_features: Callable[[str, float, str], np.ndarray | None],
    truth: np.ndarray,
    order: np.ndarray,
    test: np.ndarray,
    severities: dict[str, list[float]],
    classifiers: list[str],
    repetition: int,
) -> list[dict]:
    """A list of row dicts: features, classifier, perturbation, severity, metric accuracy, value, seconds.

    clean: {features: (k, d)} of the touches of objects truth (k,), by names such as FEATURES; perturbed_features:
    function (perturbation, severity, features) -> (k, d) of the same touches when disturbed, or None if they are not
    available; order, test: indices of the training touches, in random order, and of the test touches. Seconds are those
    of prediction.
    """
    rows, train = [], np.sort(order)
    for name, kind in itertools.product(classifiers, clean):
        test_case = RecognitionTest(name, repetition, truth, test)
        clean_model = test_case.fit(clean[kind], train)
        common = {"features": kind, "classifier": name, "metric": "accuracy"}
        rows.append(common | test_case.score(clean_model, clean[kind]) | {"perturbation": CLEAN, "severity": 0.0})
        for perturbation, severity in perturbation_severities(severities):
            registered = TOUCH_PERTURBATIONS[perturbation]
            tested, model = clean[kind], clean_model
            if kind == "imprint_place" and not registered.moves_positions:
                continue
            if registered.apply is None:
                model = test_case.fit(clean[kind], first_of_each(order, truth, int(severity)))
            elif (samples := perturbed_features(perturbation, severity, kind)) is None:
                continue
            elif registered.in_training:
                model = test_case.fit(samples, train)
            else:
                tested = samples
            where = {"perturbation": perturbation, "severity": severity}
            rows.append(common | test_case.score(model, tested) | where)
    return rows


@dataclass(frozen=True)
class RecognitionTest:
    """One classifier in one repetition, tested on the touches `test` of truth (k,)."""

    name: str
    random_state: int
    truth: np.ndarray
    test: np.ndarray

    def fit(self, samples: np.ndarray, train: np.ndarray) -> Pipeline:
        """The classifier trained on some of the samples (k, d)."""
        return classifier(self.name, self.random_state).fit(samples[train], self.truth[train])

    def score(self, model: Pipeline, samples: np.ndarray) -> dict[str, float]:
        """The value and seconds of a row: the model's accuracy on the test part of the samples (k, d)."""
        with Stopwatch() as watch:
            correct = model.predict(samples[self.test]) == self.truth[self.test]
        return {"value": float(correct.mean()), "seconds": watch.seconds}


def perturbation_severities(severities: dict[str, list[float]]) -> list[tuple[str, float]]:
    """[(perturbation, severity)] of {perturbation: severities}."""
    return [(name, severity) for name, levels in severities.items() for severity in levels]


def first_of_each(indices: np.ndarray, truth: np.ndarray, count: int) -> np.ndarray:
    """The first `count` indices of each object, sorted: fewer only where an object has fewer."""
    return np.sort(np.concatenate([indices[truth[indices] == label][:count] for label in np.unique(truth)]))
