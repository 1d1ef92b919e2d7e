"""One repetition: recognition of disturbed touches, at random places and on unseen regions."""

from functools import partial
from pathlib import Path

import numpy as np
from sklearn import config_context
from threadpoolctl import threadpool_limits

from haptic_glance.base.files import read_arrays
from haptic_glance.base.rng import rng
from haptic_glance.know import SPLITS, split_touches
from haptic_glance.know import features as features_of
from stages.kit.run import Rows

from .denoisers import DENOISERS
from .one_object import DRAWS
from .perturbations import PERTURBATIONS
from .recognition import recognition_rows
from .schema import Params


def trial(item: str, folder: Path, made: Path, objects: list[str], settings: Params, width: float, seed: int) -> Rows:
    """The rows of one repetition; the item's name ends with its number. made: the folder of the objects' touches."""
    repetition = int(item.rpartition(" ")[2])
    stored = [read_arrays(made / f"{name}.npz") for name in objects]

    def gathered(key):
        return np.concatenate([one[key] for one in stored])

    def perturbed_features(perturbation, severity, features, denoise):
        draw = repetition % DRAWS if PERTURBATIONS[perturbation].random_draws else 0
        key = f"{perturbation}.{severity:g}.{draw}"
        if not all(key in one for one in stored):
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
                found = recognition_rows(
                    samples, partial(perturbed_features, denoise=denoise), truth, random.permutation(train), test,
                    settings.severities, settings.classifiers, repetition,
                )  # fmt: skip
                rows += [common | {"split": split} | row | {"note": None} for row in found]
            except ValueError as error:
                note = f"set {settings.set}, {split}: {error}"
                rows.append(common | {"split": split, "metric": "accuracy", "value": None, "note": note})
    return rows
