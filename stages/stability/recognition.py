"""Recognition by touch where a disturbed object says it should be touched, with what was learned on whole ones."""

from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np

from haptic_glance.base.files import read_arrays
from haptic_glance.base.rng import rng
from haptic_glance.know import classifier
from stages.kit.run import Rows

from .uses import LEARNED

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
    found: dict[tuple[str, str], list[float]] = {}
    for group in partitions(objects, seed):
        for method in methods_of(touches[group[0]]):
            learned = [touches[name][f"{method}.{LEARNED}"] for name in group]
            model = classifier("knn", seed).fit(np.concatenate(learned), np.repeat(group, list(map(len, learned))))
            for name in group:
                for key, felt in touches[name].items():
                    if key.startswith(f"{method}.") and len(felt) and key != f"{method}.{LEARNED}":
                        found.setdefault((name, key), []).append(float((model.predict(felt) == name).mean()))
    rows = []
    for (name, key), shares in found.items():
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


def methods_of(touches: Mapping[str, np.ndarray]) -> list[str]:
    """The methods whose touches are stored."""
    return [key.removesuffix(f".{LEARNED}") for key in touches if key.endswith(f".{LEARNED}")]
