"""How coarse the models may be from which touches are learned, so that those of real objects are still recognised."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from sklearn.model_selection import StratifiedKFold

from haptic_glance.base.files import read_arrays
from haptic_glance.know import classifier
from stages.kit.run import Rows

from .need import coarsest
from .one_object import row
from .schema import Params

PRECISION = 1e-9  # of an accuracy


def recognise(item: str, folder: Path, made: Path, names: Sequence[str], settings: Params, seed: int) -> Rows:
    """Rows of the faces of the model with which each object's touches are recognised, and of the accuracy of full ones.

    The last row is of the level at which the mean of all objects is within the slack, far less a matter of chance: the
    median of the objects' faces there. made: the folder with what `process` wrote.
    """
    stored = {name: read_arrays(made / f"{name}.npz") for name in names}
    found = accuracies({name: own["features"] for name, own in stored.items()}, settings, seed)
    rows = []
    for name, accuracy in found.items():
        faces = stored[name]["faces"]
        rows.append(row(name, "recognised", settings.slack, faces[_enough(accuracy[: len(faces)], settings)]))
        rows.append({"item": name, "task": "recognised", "metric": "accuracy", "value": float(accuracy[0])})
    level = _enough(np.mean(list(found.values()), axis=0), settings)
    together = np.median([own["faces"][min(level, len(own["faces"]) - 1)] for own in stored.values()])
    return [*rows, row(None, "recognised", settings.slack, together) | {"metric": "faces_together"}]


def _enough(accuracy, settings):
    return coarsest(accuracy >= accuracy[0] - settings.slack - PRECISION)


def accuracies(samples: Mapping[str, np.ndarray], settings: Params, seed: int) -> dict[str, np.ndarray]:
    """dict name -> (levels,) share of an object's real touches that kNN names, by the level that it was learned from.

    samples: dict name -> (levels, k, features), finest first. All objects are learned from the same level, one that has
    fewer levels from its last; asked about are touches of the full meshes. Each place is held out once a folding.
    """
    levels = max(len(own) for own in samples.values())
    learned = [np.concatenate([own[min(level, len(own) - 1)] for own in samples.values()]) for level in range(levels)]
    truth = np.repeat(np.arange(len(samples)), [own.shape[1] for own in samples.values()])
    right = np.zeros((levels, len(truth)))
    for repetition in range(settings.repetitions):
        folds = StratifiedKFold(settings.folds, shuffle=True, random_state=seed + repetition)
        for train, test in folds.split(truth, truth):
            for level, known in enumerate(learned):
                model = classifier("knn").fit(known[train], truth[train])
                right[level, test] += model.predict(learned[0][test]) == truth[test]
    share = right / settings.repetitions
    return {name: share[:, truth == number].mean(axis=1) for number, name in enumerate(samples)}
