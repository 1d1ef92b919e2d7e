"""One sampling of one set of objects, explored under all splits, likelihoods and ways."""

from collections import defaultdict

import numpy as np
from threadpoolctl import threadpool_limits

from stages.classification import classifier, features
from stages.imprints import read_imprints
from stages.kit import Stopwatch
from stages.kit.files import write_arrays
from stages.kit.rng import rng
from stages.kit.run import DATA

from .choose import WAYS
from .explore import explore, stop
from .hold_out import hold_out
from .trial import Trial

# With places, `apart` would measure the split alone: only the right object has no known touch near the place.
EXPERIMENTS = {
    ("anywhere", "imprint"): tuple(WAYS),
    ("anywhere", "imprint_place"): tuple(WAYS),
    ("anywhere", "imprint_product"): ("random",),
    ("apart", "imprint"): tuple(WAYS),
    ("apart", "imprint_product"): ("random",),
}
UNORDERED = "random"  # the sampling whose points are drawn blindly: none is more salient than another
ORDERS = 10  # of the places of an object, where they are drawn at random


def read_set(objects, method):
    """(features (k, 41), places (k, 3), truth (k,), width of the array) of objects with equally many touches each.

    Raises ValueError that says why they cannot be told apart by touch.
    """
    missing = [one for one in objects if not (DATA / "imprints" / f"{one}.npz").exists()]
    if missing:
        raise ValueError(f"no imprints of {', '.join(missing)}")
    if len(objects) < 2:
        raise ValueError("at least two objects are needed to tell apart")
    touched = [read_imprints(DATA / "imprints" / f"{one}.npz").get(method) for one in objects]
    lacking = [one for one, found in zip(objects, touched, strict=True) if found is None]
    if lacking:
        raise ValueError(f"no imprints by {method} of {', '.join(lacking)}")
    count = min(len(one.images) for one in touched)
    samples = np.concatenate([features(one.images[:count]) for one in touched])
    places = np.concatenate([one.positions[:count] for one in touched]).astype(np.float64)
    return samples, places, np.repeat(np.arange(len(objects)), count), max(one.width for one in touched)


def process(item, folder, sets, settings, seed):
    """One sampling of one set, all splits, likelihoods and ways; a row with the reason where it cannot be explored."""
    name, _, method = item.rpartition(".")
    common, rows, kept = {"object": name, "method": method}, [], defaultdict(list)
    try:
        touched = read_set(sorted(sets[name]), method)
        with threadpool_limits(1):  # equal sums on any number of cores
            for (split, likelihood), ways in EXPERIMENTS.items():
                for repetition in range(settings.repetitions):
                    random = rng(seed, f"{item} {split} {repetition}")  # equal hold-outs for all likelihoods
                    trial = _trial(*touched, split, likelihood, random)
                    for way in ways:
                        if (method, way) == (UNORDERED, "saliency"):
                            continue
                        where = {"split": split, "likelihood": likelihood, "way": way, "repetition": repetition}
                        found, beliefs, truth = _explored(trial, way, settings, random)
                        rows += [common | where | {"note": None} | row for row in found]
                        kept[f"{split}.{likelihood}.{way}.belief"].append(np.exp(beliefs.max(axis=2)))
                        kept[f"{split}.{likelihood}.{way}.right"].append(beliefs.argmax(axis=2) == truth[:, None])
    except ValueError as error:
        return [common | {"metric": "accuracy", "value": None, "note": f"{name}, {method}: {error}"}]
    write_arrays(folder / f"{name}.{method}.npz", **{key: np.array(found) for key, found in kept.items()})
    return rows


def _trial(samples, places, truth, width, split, likelihood, random):
    train, test = hold_out(truth, places, split, width, random)
    components = classifier("knn")[:-1].fit(samples[train]).transform(samples)
    return Trial(components, places, truth, train, test, likelihood, split, width, random)


def _explored(trial, way, settings, random):
    """(rows, log beliefs, truth) of all objects explored one way."""
    orders = ORDERS if way == "random" else 1
    most = min(settings.most, trial.felt.shape[1])
    given = (trial.felt, trial.foreseen, trial.chances, trial.calibration, most, random)
    with Stopwatch() as watch:
        beliefs = np.concatenate([explore(way, *given) for _ in range(orders)])
    truth = np.tile(trial.truth, orders)
    seconds = watch.seconds / (len(truth) * most)
    return [row | {"seconds": seconds} for row in _rows(beliefs, truth, settings.confidences)], beliefs, truth


def _rows(beliefs, truth, confidences):
    """Rows of explorations that stop after a number of touches, and of such that stop at a confidence."""
    rows = []
    for touches in range(1, beliefs.shape[1] + 1):
        last, belief, right = stop(beliefs[:, :touches], truth, np.inf)
        rows.append(_row("fixed", touches, "accuracy", right, last, belief, None))
    for level in confidences:
        last, belief, right = stop(beliefs, truth, level)
        sure = belief >= level
        rows.append(_row("confidence", level, "accuracy", right, last, belief, sure.mean()))
        rows.append(_row("confidence", level, "accuracy_decided", right[sure], last[sure], belief[sure], sure.mean()))
    return rows


def _row(how, level, metric, right, touches, belief, decided):
    means = [float(values.mean()) if len(values) else None for values in (right, touches, belief)]
    row = {"stop": how, "level": level, "metric": metric, "decided": decided}
    return row | dict(zip(("value", "touches", "belief"), means, strict=True))
