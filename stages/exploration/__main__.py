"""Touches one place after another until the belief in one object is strong enough (T4.2.3.5).

Reads data/SET/imprints/NAME.npz of the objects of each group (classification.sets). A quarter of each object's touches
is held out, at random or as a region; the others are training touches. Then each object is explored at its held-out
places. The belief in an object follows from the likelihood of the imprints (`imprint`), of imprints and their places
(`imprint_place`), or of imprints as if they were independent (`imprint_product`, for comparison). The next place is
chosen by saliency (not where the points themselves are blind), at random, or where the expected gain of the belief is
highest.

Writes data/SET/exploration/GROUP.METHOD.npz (belief in the likeliest object and whether it is the right one:
repetitions, explorations, touches) and reports/measurements/SET/exploration.csv.gz: one row per group, method, split,
likelihood, way, stop and repetition. Metrics: accuracy, and accuracy_decided of those alone that reached the
confidence, with the belief that they stated. Seconds are those of one touch: choosing it and updating the belief.
"""

import functools
from collections import defaultdict
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from haptic_glance.base.files import write_arrays
from haptic_glance.base.rng import rng
from haptic_glance.base.timing import Stopwatch
from haptic_glance.know import classifier, features
from haptic_glance.know.exploration_trial import SPLITS, Trial, split_touches
from haptic_glance.know.planner import STRATEGIES, explore, stop
from haptic_glance.know.split import Split
from stages.classification import Params as Classification
from stages.engine.run import Rows, StageRun
from stages.engine.settings import Workspace, workspace_of_arguments
from stages.engine.statistics import interval_tree
from stages.imprints.imprints import read_imprints

from . import COLUMNS, Params

HEADLINE = {"split": Split.RANDOM, "likelihood": "imprint", "stop": "confidence", "level": 0.95}  # in the metrics
# With places, `regions` would measure the split alone: only the true object has no training touch near the place.
EXPERIMENTS = {
    (Split.RANDOM, "imprint"): tuple(STRATEGIES),
    (Split.RANDOM, "imprint_place"): tuple(STRATEGIES),
    (Split.RANDOM, "imprint_product"): ("random",),
    (Split.REGIONS, "imprint"): tuple(STRATEGIES),
    (Split.REGIONS, "imprint_product"): ("random",),
}
UNORDERED = "random"  # the method whose points are drawn at random: none is more salient than another
ORDERS = 10  # random orders of the places of an object


def read_set(folder: Path, objects: list[str], method: str) -> tuple[np.ndarray, np.ndarray, np.ndarray, float]:
    """(features (k, 41), places (k, 3), truth (k,), width of the array) of objects with equally many touches each.

    folder: data/SET/imprints. Raises ValueError with the reason if they cannot be compared.
    """
    missing = [entry for entry in objects if not (folder / f"{entry}.npz").exists()]
    if missing:
        raise ValueError(f"no imprints of {', '.join(missing)}")
    if len(objects) < 2:
        raise ValueError("at least two objects are needed")
    imprint_files = {entry: read_imprints(folder / f"{entry}.npz") for entry in objects}
    names_without = [entry for entry, by_method in imprint_files.items() if method not in by_method]
    if names_without:
        raise ValueError(f"no imprints by {method} of {', '.join(names_without)}")
    imprints = [by_method[method] for by_method in imprint_files.values()]
    count = min(len(entry.images) for entry in imprints)
    samples = np.concatenate([features(entry.images[:count]) for entry in imprints])
    places = np.concatenate([entry.positions[:count] for entry in imprints]).astype(np.float64)
    return samples, places, np.repeat(np.arange(len(objects)), count), max(entry.width for entry in imprints)


def process(item: str, folder: Path, data: Path, sets: dict[str, list[str]], settings: Params, seed: int) -> Rows:
    """Rows of one item GROUP.METHOD, or one row with the reason if it cannot be explored."""
    name, _, method = item.rpartition(".")
    common, rows, arrays = {"group": name, "method": method}, [], defaultdict(list)
    try:
        touch_data = read_set(data / "imprints", sorted(sets[name]), method)
        with threadpool_limits(1):  # equal sums on any number of cores
            for (split, likelihood), strategies in EXPERIMENTS.items():
                for repetition in range(settings.repetitions):
                    random = rng(seed, f"{item} {SPLITS[split]} {repetition}")  # equal hold-outs for all likelihoods
                    trial = _trial(*touch_data, split, likelihood, random)
                    for strategy in strategies:
                        if (method, strategy) == (UNORDERED, "saliency"):
                            continue
                        where = {"split": split, "likelihood": likelihood, "way": strategy, "repetition": repetition}
                        strategy_rows, beliefs, truth = _explore_all(trial, strategy, settings, random)
                        rows += [common | where | {"note": None} | row for row in strategy_rows]
                        arrays[f"{split}.{likelihood}.{strategy}.belief"].append(np.exp(beliefs.max(axis=2)))
                        arrays[f"{split}.{likelihood}.{strategy}.right"].append(
                            beliefs.argmax(axis=2) == truth[:, None]
                        )
    except ValueError as error:
        return [common | {"metric": "accuracy", "value": None, "note": f"{name}, {method}: {error}"}]
    write_arrays(folder / f"{name}.{method}.npz", **{key: np.array(parts) for key, parts in arrays.items()})
    return rows


def _trial(samples, places, truth, width, split, likelihood, random):
    train, test = split_touches(truth, places, split, width, random)
    components = classifier("knn")[:-1].fit(samples[train]).transform(samples)
    return Trial(components, places, truth, train, test, likelihood, split, width, random)


def _explore_all(trial, strategy, settings, random):
    """(rows, log beliefs, truth) of all objects explored with one strategy."""
    orders = ORDERS if strategy == "random" else 1
    max_touches = min(settings.most, trial.observed.shape[1])
    arguments = (trial.observed, trial.predicted, trial.probabilities, trial.calibration, max_touches, random)
    with Stopwatch() as watch:
        beliefs = np.concatenate([explore(strategy, *arguments) for _ in range(orders)])
    truth = np.tile(trial.truth, orders)
    seconds = watch.seconds / (len(truth) * max_touches)
    return [row | {"seconds": seconds} for row in _rows(beliefs, truth, settings.confidences)], beliefs, truth


def _rows(beliefs, truth, confidences):
    """Rows of explorations that stop after a number of touches, and of explorations that stop at a confidence."""
    rows = []
    for touches in range(1, beliefs.shape[1] + 1):
        last, belief, right = stop(beliefs[:, :touches], truth, np.inf)
        rows.append(_row("fixed", touches, "accuracy", right, last, belief, None))
    for level in confidences:
        last, belief, right = stop(beliefs, truth, level)
        decided_mask = belief >= level
        rows.append(_row("confidence", level, "accuracy", right, last, belief, decided_mask.mean()))
        rows.append(
            _row(
                "confidence",
                level,
                "accuracy_decided",
                right[decided_mask],
                last[decided_mask],
                belief[decided_mask],
                decided_mask.mean(),
            )
        )
    return rows


def _row(stop_rule, level, metric, right, touches, belief, decided):
    means = [float(values.mean()) if len(values) else None for values in (right, touches, belief)]
    row = {"stop": stop_rule, "level": level, "metric": metric, "decided": decided}
    return row | dict(zip(("value", "touches", "belief"), means, strict=True))


def summary(rows: Rows, seed: int) -> dict[str, Any]:
    """{group: {method: {way: {accuracy, touches, belief: {mean, low, high}}}}} at the headline confidence."""
    values = defaultdict(list)
    for row in rows:
        if row["metric"] == "accuracy" and all(row.get(key) == setting for key, setting in HEADLINE.items()):
            for name, key in (("accuracy", "value"), ("touches", "touches"), ("belief", "belief")):
                values[row["group"], row["method"], row["way"], name].append(row[key])
    return interval_tree(values, seed)


def check(settings: Params, sets: Mapping[str, list[str]]) -> None:
    """Raises ValueError that names a setting with which nothing can be explored."""
    unknown = [name for name in settings.sets if name not in sets]
    if unknown:
        raise ValueError(f"exploration.sets: no set {', '.join(unknown)}; classification.sets: {', '.join(sets)}")
    if not all(0 < level < 1 for level in settings.confidences):
        raise ValueError(f"exploration.confidences must lie between 0 and 1: {settings.confidences}")
    if min(settings.most, settings.repetitions) < 1:
        raise ValueError("exploration: most and repetitions must be 1 or more")


def run(workspace: Workspace) -> None:
    """Runs the stage on the data set of a workspace."""
    settings, sets = workspace.settings(Params), workspace.settings(Classification).sets
    check(settings, sets)
    with StageRun(workspace, "exploration", COLUMNS, inputs=("imprints",)) as stage:
        items = [f"{name}.{method}" for name in settings.sets for method in settings.methods]
        work = functools.partial(process, data=workspace.data, sets=sets, settings=settings, seed=stage.seed)
        rows = stage.each(work, items, reads=("imprints",))
        stage.metrics(summary(rows, stage.seed))
    for note in sorted({row["note"] for row in rows if row["note"]}):
        print(f"exploration: {note}")
    print(
        f"exploration: {workspace.dataset}, {len(settings.sets)} groups, {len(settings.methods)} samplings, "
        f"{len(rows)} rows"
    )


if __name__ == "__main__":
    run(workspace_of_arguments(__doc__, "exploration"))
