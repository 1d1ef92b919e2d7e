"""Grasps by BioTac SP fingertips: does the object slip, when it was never grasped before; and which object is it."""

import functools
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from sklearn.decomposition import PCA
from sklearn.dummy import DummyClassifier
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler
from threadpoolctl import threadpool_limits

from haptic_glance.base.timing import Stopwatch
from haptic_glance.know import CLASSIFIERS
from haptic_glance.know.classifiers import COMPONENTS
from haptic_glance.know.split import Split
from stages.classification.touch_readers import PALMS, Grasps
from stages.engine.rows import named_means
from stages.engine.run import Rows, StageRun

from .splits import SPLITS, split_number

GROUPS = 8  # of about five objects, left out in turn
MAJORITY = "majority"


@dataclass(frozen=True)
class Model:
    """A classifier of readings, after a reduction to principal components or, without `components`, of all of them."""

    classifier: str
    components: int | None

    def answers(
        self, grasps: Grasps, train: np.ndarray, test: np.ndarray, number: int, target: str
    ) -> tuple[np.ndarray, float]:
        """(answers on the test part, seconds); target: what is asked, a field of Grasps."""
        steps = [StandardScaler()] + ([PCA(self.components, svd_solver="full")] if self.components else [])
        last = DummyClassifier() if self.classifier == MAJORITY else CLASSIFIERS[self.classifier](number)
        with Stopwatch() as watch:
            model = make_pipeline(*steps, last).fit(grasps.electrodes[train], getattr(grasps, target)[train])
            answers = model.predict(grasps.electrodes[test])
        return answers, watch.seconds


def measure(run: StageRun, grasps: Grasps, repetitions: int) -> None:
    """Adds rows of the accuracy of each classifier on the grasps of each object.

    scaled: by the mean and deviation of the training part, or each part by its own: the fingertips drift between
    recordings, and a hand may average its readings over its own last grasps without knowing how they ended.
    """
    models = {
        f"{name} {components}": Model(name, components)
        for components in (COMPONENTS, None)
        for name in (*CLASSIFIERS, MAJORITY)
    }
    run.each(functools.partial(process, grasps=grasps, repetitions=repetitions, seed=run.seed), models)


def process(model: Model, folder: Path, grasps: Grasps, repetitions: int, seed: int) -> Rows:
    """Rows of one classifier: slip of unseen objects, slip of objects left out, recognition of objects."""
    common = {"components": model.components or grasps.electrodes.shape[1], "classifier": model.classifier}
    common |= {"scaled": "training", "metric": "accuracy"}
    scaled = Grasps(**vars(grasps) | {"electrodes": _scaled_apart(grasps)})
    with threadpool_limits(1):  # equal sums on any number of cores
        return [
            *(common | row for row in publisher_split_rows(model, grasps)),
            *(common | row for row in _left_out_rows(model, grasps)),
            *(common | row for row in recognition_rows(model, grasps, repetitions, seed)),
            *(common | {"scaled": "own"} | row for row in publisher_split_rows(model, scaled)),
        ]


def publisher_split_rows(model: Model, grasps: Grasps) -> Iterator[dict]:
    """Slip, trained on the 41 objects, tested on the ten that the publisher keeps; all palms, and each alone."""
    for palm in ("all", *PALMS):
        mask = np.isin(grasps.palms, PALMS if palm == "all" else [palm])
        train, test = np.flatnonzero(mask & ~grasps.test), np.flatnonzero(mask & grasps.test)
        yield from _slip_rows(model, grasps, train, test, {"split": Split.TEST_OBJECTS, "palm": palm})


def recognition_rows(model: Model, grasps: Grasps, repetitions: int, seed: int) -> Iterator[dict]:
    """Recognises all the objects: a quarter held out, at random, or as a run of neighbours in the file."""
    order = np.lexsort((np.arange(len(grasps.objects)), grasps.palms, grasps.objects))
    labels = grasps.objects[order]
    for split, draw in SPLITS.items():
        for repetition in range(repetitions):
            number = split_number(seed, repetition)
            train, test = (order[part] for part in draw(labels, number))
            answers, seconds = model.answers(grasps, train, test, number, "objects")
            row = {"task": "recognition", "split": split, "palm": "all", "repetition": repetition}
            value = float((answers == grasps.objects[test]).mean())
            yield {**row, "value": value, "count": len(test), "seconds": seconds}


def summary(rows: Rows) -> dict[str, float]:
    """{metric: number} of a run: the mean accuracy of kNN on all electrodes by task and split."""
    most_components = max(row["components"] for row in rows if "components" in row)
    return named_means(
        (f"{row['task']}_{row['split']}", row["value"])
        for row in rows
        if row.get("classifier") == "knn" and row["components"] == most_components and row["scaled"] == "training"
    )


def _left_out_rows(model: Model, grasps: Grasps) -> Iterator[dict]:
    """Slip within the 41 objects: each is left out of training once, in groups."""
    names = np.unique(grasps.objects[~grasps.test])
    for k in range(GROUPS):
        out = np.isin(grasps.objects, names[k::GROUPS])
        train, test = np.flatnonzero(~grasps.test & ~out), np.flatnonzero(out)
        yield from _slip_rows(model, grasps, train, test, {"split": Split.OBJECTS, "palm": "all"})


def _slip_rows(model: Model, grasps: Grasps, train: np.ndarray, test: np.ndarray, about: dict) -> Iterator[dict]:
    """A row per object of the test part."""
    answers, seconds = model.answers(grasps, train, test, 0, "slipped")
    for name in np.unique(grasps.objects[test]):
        mask = grasps.objects[test] == name
        row = {"item": str(name), "value": float((answers[mask] == grasps.slipped[test][mask]).mean())}
        yield {"task": "slip", **about, **row, "count": int(mask.sum()), "seconds": seconds}


def _scaled_apart(grasps: Grasps) -> np.ndarray:
    scaled = np.empty_like(grasps.electrodes)
    for palm in PALMS:
        for test in (False, True):
            mask = (grasps.palms == palm) & (grasps.test == test)
            scaled[mask] = StandardScaler().fit_transform(grasps.electrodes[mask])
    return scaled
