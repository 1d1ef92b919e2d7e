"""The models of the face count compared on objects that were left out of the training (T3.1.3)."""

import functools

import numpy as np
import pandas as pd
from sklearn.model_selection import KFold

from stages.kit import Stopwatch, parallel_map
from stages.salient_points import COMBINATIONS

from .ask import ALL, answers, ask_counts, from_one_mesh
from .cases import between, flat, teaches
from .fold import Fold, judge_fold, labelled
from .models import KINDS, fit_counts
from .one_mesh import fit_power_law
from .scores import scored, summarise

COMBINED = ("itti", *COMBINATIONS, "VisAttCurvP", "VisAttSymP", "SymLat", "SymRad", "2Sym")  # T3.1.5, by our names
FOLDS = 5
SIZES = (5, 10, 20, 40)  # objects trained on; the last step is all that a fold has
LARGE = 2 / 3  # quantile of the objects' own face counts: those above are asked, those below trained on
FEWEST_OBJECTS = 6
ASKED = 20  # times that a question is put for its cost
AGAINST_COARSEST = ("count_bias", "waste")  # of flat sides the right count is not known, only one that is enough
KEY = ["method", "condition", "setting"]


def judge_counts(curves, meshes, points, seed=0):
    """list of row dicts (object, method, condition, setting, metric, value, low, high, cases, objects, seconds, note).

    curves: list of Curve; those of combinations of channels are used. meshes: dict object -> Mesh; points: dict
    object -> dict method -> vertex ids kept: for the meshes that are built. method: network, linear, one_mesh, lookup.
    condition: left_out (5 folds of objects), equal_rate (the same times a safety factor found on training objects),
    built and built_equal_rate (a sample of these as meshes), trained_on (`setting` objects), coarser and finer (than
    anything known), larger (objects), flat (sides), cost. Metrics: see stages.scene.counts.scores; those of cost are
    ratios to the lookup. Too few objects: one row without a value, whose note says so.
    """
    curves = [curve for curve in curves if curve.method in COMBINED]
    used = [curve for curve in curves if teaches(curve)]
    objects = sorted({case.curve.object for case in between(used, seed)})
    if len(objects) < FEWEST_OBJECTS:
        note = f"{len(objects)} objects have curves to learn from: {FEWEST_OBJECTS} are needed to leave some out"
        return [_row("network", "left_out", None, "factor_median") | {"note": note}]
    combinations = [name for name in COMBINED if any(curve.method == name for curve in used)]
    folds = list(_folds(used, objects, meshes, points, combinations, seed))
    frames = [*parallel_map(judge_fold, folds, desc="scene"), *_once(used, curves, combinations, seed)]
    frame = pd.concat(frames, ignore_index=True)
    rows = [row for key, cases in frame.groupby(KEY, dropna=False, sort=False) for row in _rows(key, cases, seed)]
    return rows + _costs(used, frame, combinations, seed)


def _folds(curves, objects, meshes, points, combinations, seed):
    splits = list(KFold(FOLDS, shuffle=True, random_state=seed).split(objects))
    least = min(len(train) for train, _ in splits)
    sizes = [*(size for size in SIZES if size < least), least]
    for train, test in splits:
        taught, asked = ({objects[k] for k in part} for part in (train, test))
        lessons, left = ([curve for curve in curves if curve.object in names] for names in (taught, asked))
        held = ({name: things[name] for name in sorted(asked)} for things in (meshes, points))
        yield Fold(lessons, left, *held, combinations, sizes, seed)


def _once(used, curves, combinations, seed):
    """Objects larger than any trained on, and objects of flat sides, which no curve to learn from is like."""
    large = np.quantile([curve.initial_faces for curve in used], LARGE)
    small = [curve for curve in used if curve.initial_faces <= large]
    larger = between([curve for curve in used if curve.initial_faces > large], seed)
    typical = float(np.median([case.error for case in between(used, seed)]))
    for condition, lessons, cases in (("larger", small, larger), ("flat", used, flat(curves, seed, typical))):
        for kind in ALL if cases else ():
            found = answers(kind, lessons, cases, combinations, seed)
            yield labelled(scored(cases, found), kind, condition)


def _rows(key, cases, seed):
    facts = {"cases": len(cases), "objects": cases["object"].nunique()}
    for metric, (value, low, high) in summarise(cases, seed).items():
        if key[1] == "flat" and metric not in AGAINST_COARSEST:
            continue
        yield _row(*key, metric, value) | {"low": low, "high": high} | facts


def _costs(curves, frame, combinations, seed):
    """Rows `fit` and `ask`: seconds, and the value as a ratio to the lookup.

    Fit is what it takes before the first question: for the lookup to build and measure each point of one object's
    curve, for one_mesh one such point, for the others to be trained once for all objects, with curves that had to be
    measured too. Ask is one question.
    """
    one = float(frame["seconds"].mean())
    case = between(curves, seed)[:1]
    fits = {"one_mesh": one, "lookup": one * float(np.mean([len(curve) for curve in curves]))}
    law = fit_power_law(curves)
    asks = {"one_mesh": lambda: from_one_mesh(law, case), "lookup": lambda: answers("lookup", [], case, [], seed)}
    for kind in KINDS:
        with Stopwatch() as watch:
            model = fit_counts(curves, combinations, kind, seed)
        fits[kind], asks[kind] = watch.seconds, functools.partial(ask_counts, model, case)
    taken = {"fit": fits, "ask": {kind: _seconds(ask) for kind, ask in asks.items()}}
    return [
        _row(kind, "cost", None, metric, seconds[kind] / seconds["lookup"]) | {"seconds": seconds[kind]}
        for metric, seconds in taken.items()
        for kind in ALL
    ]


def _seconds(ask):
    """Of one question, the fastest of ASKED: other work on the machine only adds."""
    taken = []
    for _ in range(ASKED):
        with Stopwatch() as watch:
            ask()
        taken.append(watch.seconds)
    return min(taken)


def _row(method, condition, setting, metric, value=None):
    return {
        "object": "all", "method": method, "condition": condition, "setting": setting, "metric": metric,
        "value": value, "low": None, "high": None, "cases": None, "objects": None, "seconds": None, "note": "",
    }  # fmt: skip
