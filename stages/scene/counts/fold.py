"""One fold: models trained on some objects and asked about others, in and beyond what was measured."""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from sklearn.model_selection import KFold

from stages.kit.rng import rng

from .ask import ALL, answers, enlarged, safety_factor
from .cases import between, beyond, side, teaches
from .models import KINDS
from .rebuild import build_some
from .scores import scored

RATE = 0.9  # of the cases are to keep to the tolerance when models are compared at an equal rate
INNER = 3  # folds of the training objects, for the safety factor


@dataclass(frozen=True, eq=False)
class Fold:
    """Curves of the training objects and of those left out, with the meshes and the kept points of the latter.

    sizes: how many objects to train on, beside all of them.
    """

    lessons: list
    asked: list
    meshes: dict
    points: dict
    combinations: list
    sizes: list
    seed: int


def judge_fold(fold):
    """Frame of a row a case, method, condition and setting: columns of `scored`, and the seconds of built meshes."""
    cases = between(fold.asked, fold.seed)
    frames = [*_left_out(fold, cases), *_few_objects(fold, cases), *_beyond(fold)]
    return pd.concat(frames, ignore_index=True)


def _left_out(fold, cases):
    """As trained, then at an equal rate of keeping to the tolerance, and a sample of both as meshes."""
    for kind in ALL:
        found = answers(kind, fold.lessons, cases, fold.combinations, fold.seed)
        yield labelled(scored(cases, found), kind, "left_out")
        yield labelled(build_some(fold, cases, found), kind, "built")
        safe = enlarged(found, _safety(fold, kind), cases)
        yield labelled(scored(cases, safe), kind, "equal_rate")
        yield labelled(build_some(fold, cases, safe), kind, "built_equal_rate")


def _safety(fold, kind):
    """The factor on the counts of a model with which RATE of the cases on training objects keep to the tolerance.

    Each of these is asked of a model that was trained on other training objects, as what was trained on is no measure
    of what is to come (cross-conformal prediction: Vovk 2015). Cases of one object hang together, so the rate holds
    about.
    """
    objects = _names(fold.lessons)
    found, trials = [], []
    for _, last in KFold(INNER, shuffle=True, random_state=fold.seed).split(objects):
        aside = {objects[k] for k in last}
        rest, left = ([c for c in fold.lessons if (c.object in aside) == chosen] for chosen in (False, True))
        cases = between(left, fold.seed)
        found += list(answers(kind, rest, cases, fold.combinations, fold.seed))
        trials += cases
    return safety_factor(np.array(found), trials, RATE)


def _few_objects(fold, cases):
    objects = _names(fold.lessons)
    for size in fold.sizes:
        drawn = _drawn(objects, size, rng(fold.seed, f"{size} of {','.join(objects)}"))
        lessons = [curve for curve in fold.lessons if curve.object in drawn]
        for kind in (*KINDS, "one_mesh"):
            found = answers(kind, lessons, cases, fold.combinations, fold.seed)
            yield labelled(scored(cases, found), kind, "trained_on", size)


def _beyond(fold):
    for condition, fine in (("coarser", False), ("finer", True)):
        cases = beyond(fold.asked, fold.seed, fine)
        parts = [curve.only(~side(curve, fine)) for curve in fold.lessons]
        lessons = [part for part in parts if part is not None and teaches(part)]
        for kind in ALL if cases and lessons else ():
            found = answers(kind, lessons, cases, fold.combinations, fold.seed)
            yield labelled(scored(cases, found), kind, condition)


def labelled(frame, method, condition, setting=None):
    """The frame with columns that say whose it is."""
    return frame.assign(method=method, condition=condition, setting=setting)


def _names(curves):
    return sorted({curve.object for curve in curves})


def _drawn(names, count, draw):
    return set(draw.permutation(names)[:count])
