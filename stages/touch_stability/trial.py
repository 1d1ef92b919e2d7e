"""One repetition: who recognises the disturbed touches, anywhere and on unseen regions."""

import numpy as np
from threadpoolctl import threadpool_limits

from stages.exploration import SPLITS
from stages.kit.files import read_arrays

from .one_object import DRAWS
from .perturbations import PERTURBATIONS
from .recognise import recognise


def trial(item, folder, objects, settings, width, seed):
    """The rows of one repetition, whose number the item's name ends on."""
    repetition = int(item.rpartition(" ")[2])
    stored = [read_arrays(folder / f"{name}.npz") for name in objects]

    def gathered(key):
        return np.concatenate([one[key] for one in stored])

    def disturbed(perturbation, severity, features):
        draw = repetition % DRAWS if PERTURBATIONS[perturbation].drawn else 0
        key = f"{perturbation}.{severity:g}.{draw}"
        if not all(key in one for one in stored):
            return None
        return gathered(key) if features == "imprint" else np.hstack([gathered(key), gathered(f"{key}.positions")])

    places = gathered("positions")
    clean = {"imprint": gathered("clean"), "imprint_place": np.hstack([gathered("clean"), places])}
    truth = np.repeat(np.arange(len(objects)), len(places) // len(objects))
    common = {"object": settings.set, "method": settings.method, "repetition": repetition, "chance": 1 / len(objects)}
    rows = []
    with threadpool_limits(1):  # equal sums on any number of cores
        for split in SPLITS:
            given = (places, truth, split, width, settings.severities, settings.classifiers, repetition, seed)
            try:
                rows += [common | row | {"note": None} for row in recognise(clean, disturbed, *given)]
            except ValueError as error:
                rows.append(common | {"split": split, "value": None, "note": f"set {settings.set}, {split}: {error}"})
    return rows
