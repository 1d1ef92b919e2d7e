"""The models of the face count compared on objects left out of the training (T3.1.3)."""

import functools
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

import numpy as np
import pandas as pd
from sklearn.model_selection import KFold

from haptic_glance.base.timing import Stopwatch
from haptic_glance.look.points import COMBINATIONS
from haptic_glance.mesh.mesh import Mesh

from .cases import between, flat, is_informative
from .curves import Curve
from .fold import Fold, evaluate_fold, labelled
from .models import KINDS, fit_counts
from .one_mesh import fit_power_law
from .predict import ALL, from_one_mesh, predict_counts, predict_with
from .scores import score_counts, summarise

COMBINED = ("itti", *COMBINATIONS, "VisAttCurvP", "VisAttSymP", "SymLat", "SymRad", "2Sym")  # T3.1.5, by our names
FOLDS = 5
SIZES = (5, 10, 20, 40)  # objects trained on; the last step is all that a fold has
LARGE = 2 / 3  # quantile of the objects' own face counts: those above are test objects, those below training objects
FEWEST_OBJECTS = 6
REPEATS = 20  # predictions of which the fastest is timed
AGAINST_COARSEST = ("count_bias", "waste")  # for flat sides the right count is unknown, only one that is enough
KEY = ["method", "condition", "setting"]

Map = Callable[[Callable[[Fold], pd.DataFrame], list[Fold]], Iterable[pd.DataFrame]]


def evaluate_counts(
    curves: Sequence[Curve], meshes: Mapping[str, Mesh], points: Mapping[str, Mapping[str, np.ndarray]], seed: int = 0,
    side_by_side: Map = map,
) -> list[dict]:  # fmt: skip
    """Row dicts (method, condition, setting, metric, value, low, high, cases, objects, seconds, note).

    curves: those of combinations of channels are used. meshes: dict object -> Mesh; points: dict object -> dict
    method -> vertex ids kept: for the meshes that are built. method: network, linear, one_mesh, lookup. condition:
    left_out (5 folds of objects), equal_rate (the same times a safety factor from training objects), built and
    built_equal_rate (a sample of these as meshes), trained_on (`setting` objects), coarser and finer (than all given
    meshes), larger (objects), flat (sides), cost. Metrics: see stages.scene.counts.scores; those of cost are ratios to
    the lookup. With too few objects: one row without a value, with a note. side_by_side: runs the folds.
    """
    curves = [curve for curve in curves if curve.method in COMBINED]
    used = [curve for curve in curves if is_informative(curve)]
    objects = sorted({case.curve.object for case in between(used, seed)})
    if len(objects) < FEWEST_OBJECTS:
        note = f"{len(objects)} objects have curves to train on: {FEWEST_OBJECTS} are needed to leave some out"
        return [_row("network", "left_out", None, "factor_median") | {"note": note}]
    combinations = [name for name in COMBINED if any(curve.method == name for curve in used)]
    folds = list(_folds(used, objects, meshes, points, combinations, seed))
    frames = [*side_by_side(evaluate_fold, folds), *_single_splits(used, curves, combinations, seed)]
    frame = pd.concat(frames, ignore_index=True)
    rows = [row for key, cases in frame.groupby(KEY, dropna=False, sort=False) for row in _rows(key, cases, seed)]
    return rows + _costs(used, frame, combinations, seed)


def _folds(curves, objects, meshes, points, combinations, seed) -> Iterator[Fold]:
    splits = list(KFold(FOLDS, shuffle=True, random_state=seed).split(objects))
    least = min(len(train) for train, _ in splits)
    sizes = [*(size for size in SIZES if size < least), least]
    for train, test in splits:
        known, unknown = ({objects[k] for k in part} for part in (train, test))
        training, left_out = ([curve for curve in curves if curve.object in names] for names in (known, unknown))
        own_meshes, own_points = ({name: each[name] for name in sorted(unknown)} for each in (meshes, points))
        yield Fold(training, left_out, own_meshes, own_points, combinations, sizes, seed)


def _single_splits(used, curves, combinations, seed):
    """Objects larger than all training objects, and objects with flat sides, unlike all training curves."""
    large = np.quantile([curve.initial_faces for curve in used], LARGE)
    small = [curve for curve in used if curve.initial_faces <= large]
    larger = between([curve for curve in used if curve.initial_faces > large], seed)
    typical = float(np.median([case.error for case in between(used, seed)]))
    for condition, training, cases in (("larger", small, larger), ("flat", used, flat(curves, seed, typical))):
        for kind in ALL if cases else ():
            found = predict_counts(kind, training, cases, combinations, seed)
            yield labelled(score_counts(cases, found), kind, condition)


def _rows(key, cases, seed):
    facts = {"cases": len(cases), "objects": cases["object"].nunique()}
    method, condition, setting = key
    for metric, (value, low, high) in summarise(cases, seed).items():
        if condition == "flat" and metric not in AGAINST_COARSEST:
            continue
        yield _row(method, condition, setting, metric, value) | {"low": low, "high": high} | facts


def _costs(curves, frame, combinations, seed):
    """Rows `fit` and `ask`: seconds, and the value as a ratio to the lookup.

    Fit is the cost before the first prediction: for the lookup to build and measure each point of one object's curve,
    for one_mesh one such point, for the others one training for all objects (without the curves, which must be measured
    too). Ask is one prediction.
    """
    one = float(frame["seconds"].mean())
    case = between(curves, seed)[:1]
    fits = {"one_mesh": one, "lookup": one * float(np.mean([len(curve) for curve in curves]))}
    law = fit_power_law(curves)
    asks: dict[str, Callable[[], object]] = {
        "one_mesh": lambda: from_one_mesh(law, case),
        "lookup": lambda: predict_counts("lookup", [], case, [], seed),
    }
    for kind in KINDS:
        with Stopwatch() as watch:
            model = fit_counts(curves, combinations, kind, seed)
        fits[kind], asks[kind] = watch.seconds, functools.partial(predict_with, model, case)
    taken = {"fit": fits, "ask": {kind: _seconds(ask) for kind, ask in asks.items()}}
    return [
        _row(kind, "cost", None, metric, seconds[kind] / seconds["lookup"]) | {"seconds": seconds[kind]}
        for metric, seconds in taken.items()
        for kind in ALL
    ]


def _seconds(ask):
    """Of one prediction, the fastest of REPEATS: other load on the machine only adds."""
    taken = []
    for _ in range(REPEATS):
        with Stopwatch() as watch:
            ask()
        taken.append(watch.seconds)
    return min(taken)


def _row(method, condition, setting, metric, value=None):
    return {
        "method": method, "condition": condition, "setting": setting, "metric": metric,
        "value": value, "low": None, "high": None, "cases": None, "objects": None, "seconds": None, "note": "",
    }  # fmt: skip
