"""Tells objects apart by one touch or a few: T tables 4.1, 4.2, 4.3, 4.5 and 4.6.

Reads data/imprints/NAME.npz, writes data/classification/SET.SAMPLING.npz (confusion matrices of the hold-outs),
reports/measurements/classification.csv (one row a repetition; column variant: plain, or a name in trials.py) and
reports/metrics/classification.json.

The mean in the metrics comes with a bootstrap interval over the repetitions. It covers the luck of the split and of
the training. It does not cover the choice of objects and of touches: all repetitions share the same imprints, and
their hold-outs overlap, so it is narrower than the interval of a fresh experiment.
"""

import functools
from collections import defaultdict

import numpy as np
from threadpoolctl import threadpool_limits

from stages.imprints import read_imprints
from stages.kit import StageRun, arguments, params
from stages.kit.files import write_arrays
from stages.kit.run import DATA
from stages.kit.stats import interval_metrics

from .classifiers import check_name
from .gathered import alike, costs, gather
from .protocol import check_counts, evaluate_features
from .several import Several
from .variants import evaluate_variants


def plan(sets, folder):
    """{"SET.SAMPLING": imprints an object, or why the sampling is left out}.

    All samplings of a set use equally many imprints of every object. A set with an object that has no imprints is left
    out as a whole, under the name "SET.".
    """
    planned = {}
    for name, objects in sets.items():
        missing = [one for one in objects if not (folder / f"{one}.npz").exists()]
        if missing:
            there = ", ".join(sorted(file.stem for file in folder.glob("*.npz"))) or "nothing"
            remedy = f"name some of these in +classification.sets.NAME=[...]: {there}"
            planned[f"{name}."] = f"set {name} left out: no imprints of {', '.join(missing)}; {remedy}"
            continue
        counts = {one: _counts(one, folder) for one in objects}
        samplings = sorted({sampling for found in counts.values() for sampling in found})
        usable = {}
        for sampling in samplings:
            by_object = {one: found.get(sampling, 0) for one, found in counts.items()}
            try:
                check_counts(by_object)
                usable[f"{name}.{sampling}"] = min(by_object.values())
            except ValueError as error:
                planned[f"{name}.{sampling}"] = f"{name}, {sampling}: {error}"
        planned |= dict.fromkeys(usable, min(usable.values(), default=0))
    return planned


def _counts(one, folder):
    imprints = read_imprints(folder / f"{one}.npz")
    return {sampling: len(found.images) for sampling, found in imprints.items()}


def process(item, folder, planned, settings, seed):
    """One sampling of one set through all classifiers; what fails or is left out gives a row with the reason."""
    name, _, sampling = item.rpartition(".")
    if isinstance(planned[item], str):
        return [{"object": name, "method": sampling or None, "variant": None, "value": None, "note": planned[item]}]
    common = {"object": name, "method": sampling}
    touched, labels = gather(DATA / "imprints", settings.sets[name], sampling, planned[item])
    rows, confusions = [], {}
    for classifier in settings.classifiers:
        try:
            with threadpool_limits(1):  # equal sums on any number of cores
                found, confusion = evaluate_features(
                    touched.samples, labels, classifier, settings.repetitions, seed, touched.places, touched.width
                )
        except Exception as error:  # whatever one classifier trips over, the others still count
            found = [{"classifier": classifier, "metric": "accuracy_holdout", "value": None}]
            found[0]["note"] = f"{classifier} failed: {error}"
        else:
            confusions[f"{classifier}.confusion"] = confusion
        rows += [{**common, "variant": "plain", "imprints": len(labels), "note": None, **row} for row in found]
    able = [key.removesuffix(".confusion") for key in confusions]
    with threadpool_limits(1):
        rows += [{**common, **row} for row in further(name, sampling, touched, able, settings, seed)]
    rows += [{**common, **row} for row in [*alike(touched, sorted(settings.sets[name])), *costs(touched)]]
    write_arrays(folder / f"{item}.npz", objects=np.unique(labels), **confusions)
    return rows


def further(name, sampling, touched, classifiers, settings, seed):
    """Rows of the variants, as far as the settings ask for them."""
    several = None
    if sampling in settings.closer and name == next(iter(settings.sets)):
        every = sampling == settings.closer[0]
        several = Several(tuple(settings.touches), settings.combinations, every)
    closer = sampling in settings.closer
    return evaluate_variants(touched, classifiers, settings.repetitions, seed, several, closer)


def summary(rows, seed, closest=None):
    """{set: {sampling: {classifier: {metric: {mean, low, high}}}}} over the repetitions.

    closest: (sampling, classifier) of which the variants are told too, under {"variants": {set: {variant: ...}}}.
    """
    values = defaultdict(list)
    for row in rows:
        if row["value"] is None or not row.get("classifier"):
            continue
        if row.get("variant", "plain") == "plain":
            values[row["object"], row["method"], row["classifier"], row["metric"]].append(row["value"])
        elif (row["method"], row["classifier"]) == closest:
            values["variants", row["object"], row["variant"], row["metric"]].append(row["value"])
    tree = {}
    for (first, second, third, metric), found in values.items():
        branch = tree.setdefault(first, {}).setdefault(second, {}).setdefault(third, {})
        branch[metric] = interval_metrics(found, seed)
    return tree


def main():
    arguments(__doc__)
    settings = params("classification")
    for name in settings.classifiers:
        check_name(name)
    planned = plan(settings.sets, DATA / "imprints")
    with StageRun("classification", inputs=("imprints",)) as run:
        rows = run.each(functools.partial(process, planned=planned, settings=settings, seed=run.seed), planned)
        run.metrics(summary(rows, run.seed, (settings.closer[0], settings.classifiers[0]) if settings.closer else None))
    for note in sorted({row["note"] for row in rows if row["note"]}):
        print(f"classification: {note}")
    print(f"classification: {len(settings.sets)} sets, {len(planned)} samplings, {len(rows)} rows")


if __name__ == "__main__":
    main()
