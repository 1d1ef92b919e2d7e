"""Recognises objects by one touch or a few: T tables 4.1, 4.2, 4.3, 4.5 and 4.6.

Reads data/SET/imprints/NAME.npz, writes data/SET/classification/GROUP.SAMPLING.npz (confusion matrices of the
hold-outs) and reports/measurements/SET/classification.csv.gz: one row per group of objects (classification.sets,
or classification.drawn random ones), sampling, variant, classifier, split and repetition. A row of drawn groups is the
mean over the repetitions.

The mean in the metrics comes with a bootstrap interval over the repetitions. It covers the luck of the split and of
the training. It does not cover the choice of objects and of touches: all repetitions share the same imprints, and
their hold-outs overlap, so it is narrower than the interval of a fresh experiment.
"""

import dataclasses
import functools
from collections import defaultdict
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from sklearn import config_context
from threadpoolctl import threadpool_limits

from haptic_glance.base.files import object_files, write_arrays
from haptic_glance.know.classifiers import TRAINING, check_name
from haptic_glance.know.protocol import check_counts, evaluate_prepared, prepare
from haptic_glance.know.split import Split
from stages.engine.run import Rows, StageRun
from stages.engine.settings import Workspace, workspace_of_arguments
from stages.engine.statistics import interval_tree
from stages.imprints.imprints import read_imprints

from . import COLUMNS, Params
from .multi_touch import MultiTouchTrials, evaluate_variants
from .touch_readers import alike, gather, similar_share_rows
from .touch_trials import OF_NAMED_SETS, TouchSet, drawn_sets, set_of

METRICS = {  # (metric, split): the name of their mean in reports/metrics
    ("accuracy", Split.RANDOM): "accuracy_holdout",
    ("accuracy", Split.FOLDS): "accuracy_fivefold",
    ("accuracy", Split.REGIONS): "accuracy_apart",
    ("accuracy", Split.RANDOM_FEWER): "accuracy_fewer",
    ("recall", Split.RANDOM): "recall_holdout",
}
MEANS = {metric for metric, _ in METRICS}
ONE_SIDE = ("locations", "touches_")  # variants whose regions are one side of all objects


def plan(sets: Mapping[str, list[str]], folder: Path) -> dict[str, int | str]:
    """{"GROUP.SAMPLING": imprints per object, or why the sampling is left out}.

    All samplings of a group use equally many imprints of every object. A group with an object that has no imprints is
    left out as a whole, under the name "GROUP.".
    """
    entries: dict[str, int | str] = {}
    for name, objects in sets.items():
        missing = [item for item in objects if not (folder / f"{item}.npz").exists()]
        if missing:
            names = ", ".join(object_files(folder)) or "nothing"
            remedy = f"name some of these in +classification.sets.NAME=[...]: {names}"
            entries[f"{name}."] = f"set {name} left out: no imprints of {', '.join(missing)}; {remedy}"
            continue
        counts = {item: _counts(item, folder) for item in objects}
        samplings = sorted({sampling for numbers in counts.values() for sampling in numbers})
        usable = {}
        for sampling in samplings:
            by_object = {item: numbers.get(sampling, 0) for item, numbers in counts.items()}
            try:
                check_counts(by_object)
                usable[f"{name}.{sampling}"] = min(by_object.values())
            except ValueError as error:
                entries[f"{name}.{sampling}"] = f"{name}, {sampling}: {error}"
        entries |= dict.fromkeys(usable, min(usable.values(), default=0))
    return entries


def _counts(name, folder):
    imprints = read_imprints(folder / f"{name}.npz")
    return {sampling: len(touches.images) for sampling, touches in imprints.items()}


def process(item: str, folder: Path, data: Path, planned: Mapping[str, int | str], settings: Params, seed: int) -> Rows:
    """One sampling of one group through all classifiers; what fails or is left out gives a row with the reason."""
    name, _, sampling = item.rpartition(".")
    count, rows, confusions = planned[item], [], {}
    if isinstance(count, str):
        return [{**set_of(name), "method": sampling or None, "metric": "accuracy", "value": None, "note": count}]
    common = {**set_of(name), "method": sampling}
    touched, labels = gather(data / "imprints", settings.sets[name], sampling, count)
    objects = np.unique(labels)
    # One thread gives equal sums on any number of cores. Most fits are so small that checks would take half their time.
    with threadpool_limits(1), config_context(assume_finite=True, skip_parameter_validation=True):
        prepared = prepare(touched.samples, touched.truth, settings.repetitions, seed, touched.places, touched.width)
        for classifier in settings.classifiers:
            try:
                scores, confusion = evaluate_prepared(prepared, len(objects), classifier, seed)
            except Exception as error:  # whatever one classifier trips over, the others still count
                scores: Rows = [{"classifier": classifier, "split": Split.RANDOM, "metric": "accuracy", "value": None}]
                scores[0]["note"] = f"{classifier} failed: {error}"
            else:
                confusions[f"{classifier}.confusion"] = confusion
            plain = {**common, "variant": "plain", "scaling": TRAINING, "imprints": len(labels), "note": None}
            rows += [{**plain, **row} for row in scores]
        able = [key.removesuffix(".confusion") for key in confusions]
        rows += [{**common, **row} for row in further(name, sampling, touched, able, settings, seed)]
    rows += [{**common, **row} for row in similar_share_rows(touched, sorted(settings.sets[name]))]
    write_arrays(folder / f"{item}.npz", objects=objects, **confusions)
    return over_repetitions(rows) if settings.drawn else rows


def over_repetitions(rows: Rows) -> Rows:
    """The mean of each cell over its repetitions, to four digits and without seconds: drawn sets are the unit."""
    frame = pd.DataFrame(rows).drop(columns=["repetition", "seconds"], errors="ignore").astype({"value": float})
    cells = frame.groupby([name for name in frame if name != "value"], dropna=False, sort=False)
    means = cells["value"].mean().round(4).reset_index()
    return [{str(name): value for name, value in row.items()}
            for row in means.astype(object).where(means.notna(), None).to_dict("records")]  # fmt: skip


def further(name: str, sampling: str, touched: TouchSet, classifiers: list[str], settings: Params, seed: int) -> Rows:
    """Rows of the variants, as far as the settings ask for them."""
    multi_touch = None
    if sampling in settings.closer and set_of(name)["group"] == set_of(next(iter(settings.sets)))["group"]:
        all_variants = sampling == settings.closer[0]
        multi_touch = MultiTouchTrials(tuple(settings.touches), settings.combinations, all_variants)
    closer = sampling in settings.closer
    left_out = OF_NAMED_SETS if settings.drawn else ()
    return evaluate_variants(touched, classifiers, settings.repetitions, seed, multi_touch, closer, left_out)


def summary(rows: Rows, seed: int, closest: tuple[str, str] | None = None) -> dict[str, Any]:
    """{group: {sampling: {classifier: {metric: {mean, low, high}}}}} over the repetitions.

    Of the scaling `training` alone. closest: (sampling, classifier) whose variants are summarised too, under
    {"variants": {group: {variant: ...}}}.
    """
    values = defaultdict(list)
    for row in rows:
        if row["value"] is None or row.get("scaling") != TRAINING or row["metric"] not in MEANS:
            continue
        metric = metric_name(row)
        if row["variant"] == "plain":
            values[row["group"], row["method"], row["classifier"], metric].append(row["value"])
        elif (row["method"], row["classifier"]) == closest:
            values["variants", row["group"], row["variant"], metric].append(row["value"])
    return interval_tree(values, seed)


def metric_name(row: Mapping[str, Any]) -> str:
    """The name in reports/metrics of what a row measures."""
    if row["split"] == Split.REGIONS and row["variant"].startswith(ONE_SIDE):
        return "accuracy_side"
    return METRICS[row["metric"], row["split"]]


def run(workspace: Workspace) -> None:
    """Runs the stage on the data set of a workspace."""
    settings = workspace.settings(Params)
    for name in settings.classifiers:
        check_name(name)
    with StageRun(workspace, "classification", COLUMNS, inputs=("imprints",)) as stage:
        if settings.drawn:
            folder = workspace.data / "imprints"
            likeness = functools.partial(alike, folder=folder)
            sets = drawn_sets(settings.sets, object_files(folder), settings.drawn, stage.seed, likeness)
            settings = dataclasses.replace(settings, sets=sets)
        planned = plan(settings.sets, workspace.data / "imprints")
        work = functools.partial(process, data=workspace.data, planned=planned, settings=settings, seed=stage.seed)
        rows = stage.each(work, list(planned), reads=("imprints",))
        closest = (settings.closer[0], settings.classifiers[0]) if settings.closer else None
        stage.metrics(summary(rows, stage.seed, closest))
    for note in sorted({row["note"] for row in rows if row["note"]}):
        print(f"classification: {note}")
    print(
        f"classification: {workspace.dataset}, {len(settings.sets)} groups, {len(planned)} samplings, {len(rows)} rows"
    )


if __name__ == "__main__":
    run(workspace_of_arguments(__doc__, "classification"))
