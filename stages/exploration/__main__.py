"""Touches one place after another until the belief in one object is strong enough (T4.2.3.5).

Reads data/imprints/NAME.npz of the objects of each set. A quarter of each object's touches is held out, `anywhere` or
`apart`; the rest are known. Then each object is explored at its held-out places: what it is, the robot believes by the
likelihood of the imprints felt (`imprint`), of imprints and their places (`imprint_place`), or of imprints as if they
were independent (`imprint_product`, for comparison); where to touch next, it chooses by saliency (not where the
points themselves are blind), at random, or where it expects the belief to gain most.

Writes data/exploration/SET.METHOD.npz (belief in the likeliest object and whether it is the right one: repetitions,
explorations, touches) and reports/measurements/exploration.csv, a row a repetition: split, likelihood, way, stop
(`fixed` at `level` touches, or `confidence` `level`), metric, value, and the means of touches, stated belief and share
decided (stopped by confidence). Metrics: accuracy, and accuracy_decided of those alone that reached the confidence,
with the belief that they stated. Seconds are a touch's: choosing it and updating the belief.
"""

import functools
from collections import defaultdict

from stages.kit import StageRun, arguments, params
from stages.kit.stats import interval_metrics

from .one_sampling import process

HEADLINE = {"split": "anywhere", "likelihood": "imprint", "stop": "confidence", "level": 0.95}  # in the metrics


def summary(rows, seed):
    """{set: {method: {way: {accuracy, touches, belief: {mean, low, high}}}}} at the headline confidence."""
    tree, values = {}, defaultdict(list)
    for row in rows:
        if row["metric"] == "accuracy" and all(row.get(key) == wanted for key, wanted in HEADLINE.items()):
            for key in ("value", "touches", "belief"):
                values[row["object"], row["method"], row["way"], key].append(row[key])
    for (name, method, way, key), found in values.items():
        branch = tree.setdefault(name, {}).setdefault(method, {}).setdefault(way, {})
        branch["accuracy" if key == "value" else key] = interval_metrics(found, seed)
    return tree


def check(settings, sets):
    """ValueError that names the setting which makes no exploration."""
    unknown = [name for name in settings.sets if name not in sets]
    if unknown:
        raise ValueError(f"exploration.sets: no set {', '.join(unknown)}; classification.sets: {', '.join(sets)}")
    if not all(0 < level < 1 for level in settings.confidences):
        raise ValueError(f"exploration.confidences must lie between 0 and 1: {settings.confidences}")
    if min(settings.most, settings.repetitions) < 1:
        raise ValueError("exploration: most and repetitions must be 1 or more")


def main():
    arguments(__doc__)
    settings, sets = params("exploration"), params("classification").sets
    check(settings, sets)
    with StageRun("exploration", inputs=("imprints",)) as run:
        items = [f"{name}.{method}" for name in settings.sets for method in settings.methods]
        rows = run.each(functools.partial(process, sets=sets, settings=settings, seed=run.seed), items)
        run.metrics(summary(rows, run.seed))
    for note in sorted({row["note"] for row in rows if row["note"]}):
        print(f"exploration: {note}")
    print(f"exploration: {len(settings.sets)} sets, {len(settings.methods)} samplings, {len(rows)} rows")


if __name__ == "__main__":
    main()
