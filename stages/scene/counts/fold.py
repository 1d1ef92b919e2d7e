"""One fold: models trained on some objects and tested on others, in and beyond the measured range."""

import functools
from dataclasses import dataclass

import numpy as np
import pandas as pd
from sklearn.model_selection import KFold

from haptic_glance.base.rng import rng
from haptic_glance.mesh.mesh import Mesh

from .cases import between, beyond, is_informative, side
from .curves import Curve
from .models import KINDS
from .predict import ALL, enlarged, predict_counts, safety_factor
from .rebuild import build_some
from .scores import score_counts

RATE = 0.9  # share of the cases within the tolerance when models are compared at an equal rate
INNER = 3  # folds of the training objects, for the safety factor


@dataclass(frozen=True, eq=False)
class Fold:
    """Curves of the training objects and of those left out, with the meshes and the kept points of the latter.

    sizes: numbers of objects to train on, besides all of them.
    """

    training: list[Curve]
    test_curves: list[Curve]
    meshes: dict[str, Mesh]
    points: dict[str, dict[str, np.ndarray]]
    combinations: list[str]
    sizes: list[int]
    seed: int


def evaluate_fold(fold: Fold) -> pd.DataFrame:
    """One row per case, method, condition and setting: that of `score_counts`, and the seconds of built meshes."""
    cases = between(fold.test_curves, fold.seed)

    @functools.cache
    def counts(kind: str, objects: frozenset[str]) -> np.ndarray:
        training = [curve for curve in fold.training if curve.object in objects]
        return predict_counts(kind, training, cases, fold.combinations, fold.seed)

    frames = [*_left_out(fold, cases, counts), *_few_objects(fold, cases, counts), *_beyond(fold)]
    return pd.concat(frames, ignore_index=True)


def _left_out(fold, cases, counts):
    """As trained, then at an equal rate of cases within the tolerance, and a sample of both as meshes."""
    parts = _inner_parts(fold)
    for kind in ALL:
        found = counts(kind, frozenset(_names(fold.training)))
        yield labelled(score_counts(cases, found), kind, "left_out")
        yield labelled(build_some(fold, cases, found), kind, "built")
        safe = enlarged(found, _safety(fold, kind, parts), cases)
        yield labelled(score_counts(cases, safe), kind, "equal_rate")
        yield labelled(build_some(fold, cases, safe), kind, "built_equal_rate")


def _safety(fold, kind, parts):
    """The factor on the counts of a model with which RATE of the cases of training objects are within the tolerance.

    Each case is predicted by a model trained on other training objects (cross-conformal prediction: Vovk 2015). Cases
    of one object are dependent, so the rate is approximate.
    """
    counts = [predict_counts(kind, others, cases, fold.combinations, fold.seed) for others, cases in parts]
    return safety_factor(np.concatenate(counts), [case for _, cases in parts for case in cases], RATE)


def _inner_parts(fold):
    """[(curves to train on, cases of the other training objects)]."""
    objects, parts = _names(fold.training), []
    for _, last in KFold(INNER, shuffle=True, random_state=fold.seed).split(objects):
        aside = {objects[k] for k in last}
        others, left = ([c for c in fold.training if (c.object in aside) == chosen] for chosen in (False, True))
        parts.append((others, between(left, fold.seed)))
    return parts


def _few_objects(fold, cases, counts):
    objects = _names(fold.training)
    for size in fold.sizes:
        drawn = frozenset(rng(fold.seed, f"{size} of {','.join(objects)}").permutation(objects)[:size].tolist())
        for kind in (*KINDS, "one_mesh"):
            yield labelled(score_counts(cases, counts(kind, drawn)), kind, "trained_on", size)


def _beyond(fold):
    for condition, fine in (("coarser", False), ("finer", True)):
        cases = beyond(fold.test_curves, fold.seed, fine)
        parts = [curve.only(~side(curve, fine)) for curve in fold.training]
        training = [part for part in parts if part is not None and is_informative(part)]
        for kind in ALL if cases and training else ():
            found = predict_counts(kind, training, cases, fold.combinations, fold.seed)
            yield labelled(score_counts(cases, found), kind, condition)


def labelled(frame: pd.DataFrame, method: str, condition: str, setting: int | None = None) -> pd.DataFrame:
    """The frame with columns method, condition and setting."""
    return frame.assign(method=method, condition=condition, setting=setting)


def _names(curves) -> list[str]:
    return sorted({curve.object for curve in curves})
