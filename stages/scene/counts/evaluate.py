"""Evaluates models of the fewest faces on objects left out of the training (T3.1.3).

A fold trains on some objects and tests on others, in and beyond the measured range. Scores are the error of the count
and of the mesh, with intervals over the objects; a factor on the counts makes a model meet the tolerance.
"""

import functools
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from sklearn.model_selection import KFold

from haptic_glance.base.rng import rng
from haptic_glance.base.timing import Stopwatch
from haptic_glance.lod import metro, simplify
from haptic_glance.look.points import COMBINATIONS
from haptic_glance.mesh.mesh import Mesh

from .cases import HALF, Case, between, beyond, flat, is_informative, power_law, side
from .models import FEWEST, FLOOR, KINDS, Counts, Curve, fit_counts

RATE = 0.9  # share of the cases within the tolerance when models are compared at an equal rate
INNER = 3  # folds of the training objects, for the safety factor


@dataclass(frozen=True, eq=False)
class Fold:
    """Curves of the training objects and of those left out, with the meshes and the kept points of the latter."""

    training: list[Curve]
    test_curves: list[Curve]
    meshes: dict[str, Mesh]
    points: dict[str, dict[str, np.ndarray]]
    combinations: list[str]
    seed: int


def evaluate_fold(fold: Fold) -> pd.DataFrame:
    """One row per case, method and condition: that of `score_counts`, and the seconds of built meshes."""
    cases = between(fold.test_curves, fold.seed)

    frames = [*_left_out(fold, cases), *_beyond(fold)]
    return pd.concat(frames, ignore_index=True)


def _left_out(fold, cases):
    """As trained, then at an equal rate of cases within the tolerance, and a sample of both as meshes."""
    parts = _inner_parts(fold)
    for kind in ALL:
        predicted = predict_counts(kind, fold.training, cases, fold.combinations, fold.seed)
        yield labelled(score_counts(cases, predicted), kind, "left_out")
        yield labelled(build_some(fold, cases, predicted), kind, "built")
        full = [case.curve.initial_faces for case in cases]
        safe = np.minimum(np.ceil(predicted * _safety(fold, kind, parts)), full).astype(np.int64)
        yield labelled(score_counts(cases, safe), kind, "equal_rate")
        yield labelled(build_some(fold, cases, safe), kind, "built_equal_rate")


def _safety(fold, kind, parts):
    """The factor on the counts of a model with which RATE of the cases of training objects are within the tolerance.

    Each case is predicted by a model trained on other training objects (cross-conformal prediction: Vovk 2015). Cases
    of one object are dependent, so the rate is approximate.
    """
    counts = [predict_counts(kind, training, cases, fold.combinations, fold.seed) for training, cases in parts]
    needed_faces = np.array([case.needed for _, cases in parts for case in cases])
    return float(np.quantile(needed_faces / np.concatenate(counts), RATE, method="higher"))


def _inner_parts(fold):
    """[(curves to train on, cases of the other training objects)]."""
    objects, parts = _names(fold.training), []
    for _, last in KFold(INNER, shuffle=True, random_state=fold.seed).split(objects):
        aside = {objects[k] for k in last}
        training, held_out = ([c for c in fold.training if (c.object in aside) == inside] for inside in (False, True))
        parts.append((training, between(held_out, fold.seed)))
    return parts


def _beyond(fold):
    for condition, fine in (("coarser", False), ("finer", True)):
        cases = beyond(fold.test_curves, fold.seed, fine)
        parts = [curve.only(~side(curve, fine)) for curve in fold.training]
        training = [part for part in parts if part is not None and is_informative(part)]
        for kind in ALL if cases and training else ():
            predicted = predict_counts(kind, training, cases, fold.combinations, fold.seed)
            yield labelled(score_counts(cases, predicted), kind, condition)


BUILT = 4  # objects per fold, one case each: all folds and models together take half a minute on one core


def build_some(fold: Fold, cases: Sequence[Case], counts: np.ndarray) -> pd.DataFrame:
    """Frame like that of `score_counts`, but measured on meshes, for one case of each of BUILT objects, with `seconds`.

    The same cases for equal folds, whatever the model. Neighbourhoods shrink where the count needs it, as in the lod
    stage. A case without a sound mesh has no row.
    """
    names = np.array([case.curve.object for case in cases])
    draw = rng(fold.seed, "cases to build")
    places = [draw.choice(np.flatnonzero(names == name)) for name in draw.permutation(np.unique(names))[:BUILT]]
    rows = [_built(cases[place], int(counts[place]), fold) for place in places]
    columns = ["object", "ratio", "error", "within", "seconds"]
    return pd.DataFrame([row for row in rows if row is not None], columns=columns).astype({"within": bool})


def _built(case, count, fold):
    name, method = case.curve.object, case.curve.method
    mesh, keep = fold.meshes[name], fold.points[name][method]
    with Stopwatch() as watch:
        try:
            simplified = simplify(mesh, count, keep, shrink=True)
        except ValueError:
            return None
        error = metro(mesh, simplified, seed=fold.seed)["mean"] / case.error
    ratio = len(simplified.faces) / case.needed
    return {"object": name, "ratio": ratio, "error": error, "within": error <= 1, "seconds": watch.seconds}


def labelled(frame: pd.DataFrame, method: str, condition: str) -> pd.DataFrame:
    """The frame with columns method and condition."""
    return frame.assign(method=method, condition=condition)


def _names(curves) -> list[str]:
    return sorted({curve.object for curve in curves})


COMBINED = ("itti", *COMBINATIONS, "VisAttCurvP", "VisAttSymP", "SymLat", "SymRad", "2Sym")  # T3.1.5, by our names
FOLDS = 5
LARGE = 2 / 3  # quantile of the objects' own face counts: those above are test objects, those below training objects
FEWEST_OBJECTS = 6
REPEATS = 20  # predictions of which the fastest is timed
AGAINST_COARSEST = ("count_bias", "waste")  # for flat sides the right count is unknown, only one that is enough
KEY = ["method", "condition"]

Map = Callable[[Callable[[Fold], pd.DataFrame], list[Fold]], Iterable[pd.DataFrame]]


def evaluate_counts(
    curves: Sequence[Curve], meshes: Mapping[str, Mesh], points: Mapping[str, Mapping[str, np.ndarray]], seed: int = 0,
    side_by_side: Map = map,
) -> list[dict]:  # fmt: skip
    """Row dicts (method, condition, metric, value, low, high, cases, objects, seconds, note).

    curves: those of combinations of channels are used. meshes: dict object -> Mesh; points: dict object -> dict
    method -> vertex ids kept: for the meshes that are built. method: network, linear, one_mesh, lookup. condition:
    left_out (5 folds of objects), equal_rate (the same times a safety factor from training objects), built and
    built_equal_rate (a sample of these as meshes), coarser and finer (than all given
    meshes), larger (objects), flat (sides), cost. Metrics: see stages.scene.counts.evaluate; those of cost are ratios
    to the lookup. With too few objects: one row without a value, with a note. side_by_side: runs the folds.
    """
    curves = [curve for curve in curves if curve.method in COMBINED]
    informative = [curve for curve in curves if is_informative(curve)]
    objects = sorted({case.curve.object for case in between(informative, seed)})
    if len(objects) < FEWEST_OBJECTS:
        note = f"{len(objects)} objects have curves to train on: {FEWEST_OBJECTS} are needed to leave some out"
        return [_row("network", "left_out", "factor_median") | {"note": note}]
    combinations = [name for name in COMBINED if any(curve.method == name for curve in informative)]
    folds = list(_folds(informative, objects, meshes, points, combinations, seed))
    frames = [*side_by_side(evaluate_fold, folds), *_single_splits(informative, curves, combinations, seed)]
    frame = pd.concat(frames, ignore_index=True)
    rows = [row for key, cases in frame.groupby(KEY, dropna=False, sort=False) for row in _rows(key, cases, seed)]
    return rows + _costs(informative, frame, combinations, seed)


def _folds(curves, objects, meshes, points, combinations, seed) -> Iterator[Fold]:
    splits = list(KFold(FOLDS, shuffle=True, random_state=seed).split(objects))
    for train, test in splits:
        fit_names, test_names = ({objects[k] for k in part} for part in (train, test))
        training, left_out = ([curve for curve in curves if curve.object in names] for names in (fit_names, test_names))
        own_meshes, own_points = ({name: by_name[name] for name in sorted(test_names)} for by_name in (meshes, points))
        yield Fold(training, left_out, own_meshes, own_points, combinations, seed)


def _single_splits(used, curves, combinations, seed):
    """Objects larger than all training objects, and objects with flat sides, unlike all training curves."""
    large = np.quantile([curve.initial_faces for curve in used], LARGE)
    small = [curve for curve in used if curve.initial_faces <= large]
    larger = between([curve for curve in used if curve.initial_faces > large], seed)
    typical = float(np.median([case.error for case in between(used, seed)]))
    for condition, training, cases in (("larger", small, larger), ("flat", used, flat(curves, seed, typical))):
        for kind in ALL if cases else ():
            predicted = predict_counts(kind, training, cases, combinations, seed)
            yield labelled(score_counts(cases, predicted), kind, condition)


def _rows(key, cases, seed):
    facts = {"cases": len(cases), "objects": cases["object"].nunique()}
    method, condition = key
    for metric, (value, low, high) in summarise(cases, seed).items():
        if condition == "flat" and metric not in AGAINST_COARSEST:
            continue
        yield _row(method, condition, metric, value) | {"low": low, "high": high} | facts


def _costs(curves, frame, combinations, seed):
    """Rows `fit` and `ask`: seconds, and the value as a ratio to the lookup.

    Fit is the cost before the first prediction: for the lookup to build and measure each point of one object's curve,
    for one_mesh one such point, for the others one training for all objects (without the curves, which must be measured
    too). Ask is one prediction.
    """
    one_mesh = float(frame["seconds"].mean())
    case = between(curves, seed)[:1]
    fits = {"one_mesh": one_mesh, "lookup": one_mesh * float(np.mean([len(curve) for curve in curves]))}
    exponent = power_law(curves)
    asks: dict[str, Callable[[], object]] = {
        "one_mesh": lambda: from_one_mesh(exponent, case),
        "lookup": lambda: predict_counts("lookup", [], case, [], seed),
    }
    for kind in KINDS:
        with Stopwatch() as watch:
            model = fit_counts(curves, combinations, kind, seed)
        fits[kind], asks[kind] = watch.seconds, functools.partial(predict_with, model, case)
    costs = {"fit": fits, "ask": {kind: _seconds(ask) for kind, ask in asks.items()}}
    return [
        _row(kind, "cost", metric, seconds[kind] / seconds["lookup"]) | {"seconds": seconds[kind]}
        for metric, seconds in costs.items()
        for kind in ALL
    ]


def _seconds(ask):
    """The seconds of one prediction, the fastest of REPEATS: other load on the machine only adds."""
    times = []
    for _ in range(REPEATS):
        with Stopwatch() as watch:
            ask()
        times.append(watch.seconds)
    return min(times)


def _row(method, condition, metric, value=None):
    return {
        "method": method, "condition": condition, "metric": metric,
        "value": value, "low": None, "high": None, "cases": None, "objects": None, "seconds": None, "note": "",
    }  # fmt: skip


ALL = (*KINDS, "one_mesh", "lookup")


def predict_counts(
    kind: str, training: Sequence[Curve], cases: Sequence[Case], combinations: Sequence[str], seed: int
) -> np.ndarray:
    """(k,) i8: the counts of a model, trained on the curves `training`, for the cases; the lookup needs none."""
    if kind == "lookup":
        return np.array([case.known.faces_needed(case.error) for case in cases])
    if kind == "one_mesh":
        return from_one_mesh(power_law(training), cases)
    return predict_with(fit_counts(training, combinations, kind, seed), cases)


def predict_with(model: Counts, cases: Sequence[Case]) -> np.ndarray:
    """(k,) i8: the predictions of a Counts. For a combination without a curve of the object, the case's points."""
    points = {name: np.array([case.points.get(name, case.curve.points) for case in cases]) for name in model.regressors}
    tolerance = np.array([case.tolerance for case in cases])
    distance = np.array([case.distance for case in cases])
    initial = np.array([case.curve.initial_faces for case in cases])
    return model.faces_needed(tolerance, distance, initial, points)


def from_one_mesh(exponent: float, cases: Sequence[Case]) -> np.ndarray:
    """(k,) i8: the power law from the given mesh nearest to half of the object's faces."""
    faces, errors = [], []
    for case in cases:
        nearest = np.abs(np.log(case.known.faces / (HALF * case.curve.initial_faces))).argmin()
        faces.append(case.known.faces[nearest])
        errors.append(case.known.errors[nearest])
    ratio = np.maximum(errors, FLOOR) / np.maximum([case.error for case in cases], FLOOR)
    counts = np.maximum(np.ceil(np.array(faces) * ratio**exponent - 1e-6), FEWEST)
    return np.minimum(counts, [case.curve.initial_faces for case in cases]).astype(np.int64)


RESAMPLES = 400  # of the objects, with all their cases: the interval's ends are then within a tenth of its width


def score_counts(cases: Sequence[Case], counts: np.ndarray) -> pd.DataFrame:
    """Frame with one row per case: object, ratio (count / needed), error (over the tolerance), within (tolerance met).

    The error is read from the object's whole measured curve. For a count below all measured ones it is that of the
    coarsest mesh, which is too low: the case still does not meet the tolerance.
    """
    rows = []
    for case, count in zip(cases, counts, strict=True):
        error = float(case.curve.error_at(count)) / case.error
        rows.append({"object": case.curve.object, "ratio": count / case.needed, "error": error})
    frame = pd.DataFrame(rows, columns=["object", "ratio", "error"])
    return frame.assign(within=frame["ratio"] >= 1)


def summarise(frame: pd.DataFrame, seed: int) -> dict[str, tuple[float, float, float]]:
    """dict metric -> (value, low, high): over the cases of a frame of `score_counts`, 95 % bootstrap over its objects.

    count_bias: geometric mean of count / needed. factor_median, factor_90: the factor, up or down, within which half
    and 90 % of the counts are. within: share of cases within the tolerance. excess: error over the tolerance, minus
    one, median of the cases beyond it, NaN where there is none. waste: mean of the excess faces over the needed ones.
    """
    groups = [group for _, group in frame.groupby("object")]
    values = _metrics(frame)
    draw = rng(seed, "objects resampled")
    columns = {name: [group[name].to_numpy() for group in groups] for name in ("ratio", "error", "within")}
    resampled = []
    for _ in range(RESAMPLES if len(groups) > 1 else 0):
        picks = draw.integers(len(groups), size=len(groups))
        resampled.append(_metrics({name: np.concatenate([parts[k] for k in picks]) for name, parts in columns.items()}))
    metrics = {}
    for name, value in values.items():
        spread = [sample[name] for sample in resampled if np.isfinite(sample[name])]
        low, high = np.quantile(spread, [0.025, 0.975]) if spread else (np.nan, np.nan)
        metrics[name] = (float(value), float(low), float(high))
    return metrics


def _metrics(cases: Mapping | pd.DataFrame) -> dict[str, float]:
    ratio, error, within = (np.asarray(cases[name]) for name in ("ratio", "error", "within"))
    factor = np.exp(np.abs(np.log(ratio)))
    return {
        "count_bias": np.exp(np.log(ratio).mean()),
        "factor_median": np.median(factor),
        "factor_90": np.quantile(factor, 0.9),
        "within": within.mean(),
        "excess": np.median(error[~within]) - 1 if not within.all() else np.nan,
        "waste": np.maximum(ratio - 1, 0).mean(),
    }
