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
from typing import Any

from haptic_glance.know.split import Split
from stages.classification import Params as Classification
from stages.engine.run import Rows, StageRun
from stages.engine.settings import Workspace, workspace_of_arguments
from stages.engine.statistics import interval_metrics

from . import COLUMNS, Params
from .one_sampling import process

HEADLINE = {"split": Split.RANDOM, "likelihood": "imprint", "stop": "confidence", "level": 0.95}  # in the metrics


def summary(rows: Rows, seed: int) -> dict[str, Any]:
    """{group: {method: {way: {accuracy, touches, belief: {mean, low, high}}}}} at the headline confidence."""
    tree, values = {}, defaultdict(list)
    for row in rows:
        if row["metric"] == "accuracy" and all(row.get(key) == setting for key, setting in HEADLINE.items()):
            for key in ("value", "touches", "belief"):
                values[row["group"], row["method"], row["way"], key].append(row[key])
    for (name, method, way, key), numbers in values.items():
        branch = tree.setdefault(name, {}).setdefault(method, {}).setdefault(way, {})
        branch["accuracy" if key == "value" else key] = interval_metrics(numbers, seed)
    return tree


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
