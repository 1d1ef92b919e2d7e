"""Validity of rows before a verdict: a method that found, kept or learned nothing is no evidence.

`check` registers the check of a stage's rows, `causes` tells why rows are invalid. `invalid_units` finds the simplified
meshes whose errors say nothing about the kept points.
"""

from collections.abc import Callable
from functools import wraps
from math import log

import pandas as pd

from stages.engine.measurements import Measurements, Missing

PLAIN, QSLIM = "qem", "qslim"  # plain simplification: with and without the fit of ours
UNIT = ["item", "method", "target"]
NOTHING_OUT = "nothing was left out"
NO_POINT, AS_PLAIN, NO_RING = "no point found", "equal to plain simplification", "less than one ring kept"
SATURATED = 0.95  # training accuracy of a network that has learned its training part
CERTAIN = 0.99  # test accuracy of a network that cannot be told to have stopped too early
ONE_ANSWER = 2.0  # times guessing: a share of the commonest answer that no classifier has that looks at the samples
MOST = 0.5  # the same share where the number of classes is not known by the name of their group
DEAF, WIDE = "svm", "min_max"  # a classifier that often gives one answer, but not where all data lie in 0 to 1
UNKNOWN = "nobody counted the answers of a classifier that often gives one"
UNTRAINED, ONE_CLASS = "training stopped before it was saturated", "one answer for nearly all samples"
UNMEASURED = "nobody measured whether the training was saturated"
DIVERGED, LOSS = "the training's loss is never below that of guessing", "curve_loss"
BACKGROUND = "less accurate than `on the object, hence salient`"
GUESSING, SAME = "less accurate than guessing", "both sides are the same mesh"
TRIAL = ("group", "method", "split", "variant", "classifier", "scaling")
FROM_RANDOM, RANDOM_LAYERS = "fully connected layers from random weights", "vgg16-last_block"
LEAST, NOISE_NEARER = "distance", "noise is nearer by this measure"
TRAINING = ("method", "split", "data", "weights", "pretrained", "mode", "size", "touches", "precision", "repetition",
            "passes")  # fmt: skip
CHANGES = ("weight_change", "layer_weight_change")  # of a tuned network
SEQUENCES, SUM = ("method", "split", "repetition", "training", "frames", "cells"), "cnn"  # trials by contours
NUMBERS = {"four": 4, "six": 6}  # names of groups that tell how many objects they hold
Check = Callable[[Measurements, str, str, pd.DataFrame], pd.Series]  # (results, stage, dataset, rows) -> causes, or ""
CHECKS: dict[str, Check] = {}


def check(stage: str) -> Callable[[Check], Check]:
    """Registers a check of the rows of a stage."""
    return lambda function: CHECKS.setdefault(stage, function)


def of_all_rows(work: Check) -> Check:
    """Makes some work on all rows of a stage on a set, done at the first call, an answer for each selection of them."""

    @wraps(work)
    def selected(results: Measurements, stage: str, dataset: str, rows: pd.DataFrame) -> pd.Series:
        answers = results.cached(
            (work.__name__, stage, dataset), lambda: work(results, stage, dataset, results.rows(stage, dataset))
        )
        return answers.take(rows.index.to_numpy())  # the index of all rows counts them

    return selected


def causes(results: Measurements, stage: str, dataset: str, rows: pd.DataFrame) -> pd.Series:
    """(n,) causes why rows are invalid, empty text for valid rows, indexed as the rows."""
    checker = CHECKS.get(stage)
    return checker(results, stage, dataset, rows) if checker else pd.Series("", index=rows.index)


@check("lod")
@of_all_rows
def kept_neighbourhoods(results: Measurements, stage: str, dataset: str, rows: pd.DataFrame) -> pd.Series:
    """Rows of methods that should keep neighbourhoods but kept none: their mesh is that of plain simplification."""
    if not {"points", "rings"} <= set(rows):  # rows of a run before these were counted
        return pd.Series("", index=rows.index)
    reasons = invalid_units(rows).reindex(pd.MultiIndex.from_frame(rows[UNIT])).fillna("")
    return pd.Series(reasons.to_numpy(), index=rows.index, dtype=object)


@check("classification")
@check("recorded")
@of_all_rows
def several_answers(results: Measurements, stage: str, dataset: str, rows: pd.DataFrame) -> pd.Series:
    """Rows of classifiers that give one answer for nearly all samples, where the stage measured that."""
    guess = pd.Series(float("nan"), index=rows.index)
    if "group" in rows:
        guess = 1 / rows["group"].map(lambda group: NUMBERS.get(str(group).partition("_")[0]))  # four of four_drawn
    share = _beside(results, stage, dataset, rows, "commonest_share")
    # A classifier that is right more often than it gives its commonest answer tells the others apart.
    deaf = _beside(results, stage, dataset, rows, "accuracy").fillna(0) <= share.fillna(0)
    reasons = (deaf & (share.fillna(0) > (ONE_ANSWER * guess).fillna(MOST))).map({True: ONE_CLASS, False: ""})
    if share.notna().any() and "classifier" in rows:  # an older run counted the answers of some trials alone
        narrow = rows["classifier"].eq(DEAF) & (rows["scaling"] != WIDE if "scaling" in rows else True)
        reasons[share.isna() & narrow & rows["metric"].eq("accuracy")] = UNKNOWN
    reasons[_below(rows, guess)] = GUESSING
    reasons[_whole(rows)] = NOTHING_OUT
    return reasons


@check("transfer")
@check("recorded_networks")
def trained(results: Measurements, stage: str, dataset: str, rows: pd.DataFrame) -> pd.Series:
    """Rows of tuned networks whose training was stopped after some passes while it still improved, or may have been.

    A network that hardly errs on its test part has learned its training part. The changes of its weights are checked
    alike. Accuracies of all networks, frozen ones too, are invalid where no pass had a loss below that of guessing;
    those on single objects as well.
    """
    is_accuracy = rows["metric"] == "accuracy"
    tuned = rows["mode"].notna() & (rows["mode"] != "frozen") & (is_accuracy | rows["metric"].isin(CHANGES))
    converged = rows["passes"] == "converged" if "passes" in rows else False
    train_accuracy = _beside(results, stage, dataset, rows, "train_accuracy")
    doubtful = tuned & ~converged & ~(is_accuracy & (rows["value"] >= CERTAIN))
    reasons = pd.Series("", index=rows.index).mask(doubtful & (train_accuracy < SATURATED), UNTRAINED).mask(
        doubtful & train_accuracy.isna(), UNMEASURED)  # fmt: skip
    accuracies = is_accuracy | (rows["metric"] == "object_accuracy")
    return reasons.mask(accuracies & _diverged(results, stage, dataset, rows), DIVERGED)


@of_all_rows
def _diverged(results: Measurements, stage: str, dataset: str, rows: pd.DataFrame) -> pd.Series:
    """Whether no pass of each row's training had a loss below that of guessing, the logarithm of the number of classes.

    The pass that was kept is the one of the best validation; its loss is no less than the least.
    """
    try:
        losses = results.measured(stage, dataset, metric=LOSS)
    except Missing:
        return pd.Series(False, index=rows.index)
    keys = [column for column in TRAINING if column in rows]
    least = losses.groupby(keys, dropna=False, as_index=False)["value"].min()
    loss = rows[keys].merge(least, on=keys, how="left")["value"].set_axis(rows.index)
    return loss > log(max(rows["group"].nunique() if "group" in rows else 0, 2))


@check("fixation")
def attentive(results: Measurements, stage: str, dataset: str, rows: pd.DataFrame) -> pd.Series:
    """Rows of the least distance of a method whose distances exceed those of noise, and rows of VGG16 alone.

    The least distance rewards many centres, as noise has them. The fully connected layers of VGG16 start from random
    weights: no package has the trained ones, and the thesis replaces the last layers alone.
    """
    if set(rows["method"]) == {RANDOM_LAYERS} and not rows["metric"].eq("accuracy").any():
        return pd.Series(FROM_RANDOM, index=rows.index)
    least = rows["metric"] == LEAST
    if not least.any():
        return pd.Series("", index=rows.index)
    means = results.rows(stage, dataset, metric=LEAST).groupby(["method", "task"])["value"].mean()
    poor = means.index[means > means.get(("control", "random"), float("inf"))]
    is_poor = pd.Series(pd.MultiIndex.from_frame(rows[["method", "task"]]).isin(poor), index=rows.index)
    return (least & is_poor).map({True: NOISE_NEARER, False: ""})


@check("weights")
def over_background(results: Measurements, stage: str, dataset: str, rows: pd.DataFrame) -> pd.Series:
    """Accuracies on kinds of pixels where an SVM is right less often than `on the object, hence salient`."""
    if "background_alone" not in rows or not rows["metric"].eq("accuracy").all():
        return pd.Series("", index=rows.index)
    all_rows = results.rows(stage, dataset, metric="accuracy")
    means = all_rows.groupby(["training", "validation", "area"])[["value", "background_alone"]].mean()
    poor = means[means["value"] < means["background_alone"]].reset_index()
    kinds, bad = (pd.MultiIndex.from_frame(frame[["validation", "area"]]) for frame in (rows, poor))
    return pd.Series(kinds.isin(bad), index=rows.index).map({True: BACKGROUND, False: ""})


@check("sequences")
@of_all_rows
def settled(results: Measurements, stage: str, dataset: str, rows: pd.DataFrame) -> pd.Series:
    """Rows of networks that did not know their training sequences while their loss still fell, or may not have.

    The sum of both networks needs both.
    """
    trial = [column for column in SEQUENCES if column in rows]
    evidence = rows[rows["metric"].isin(["train_accuracy", "settled"]) & (rows["classifier"] != SUM)]
    evidence = evidence.assign(known=evidence["value"] >= SATURATED)
    networks = evidence.groupby([*trial, "classifier"], as_index=False)["known"].max()
    sums = networks.groupby(trial, as_index=False)["known"].min().assign(classifier=SUM)
    learned = pd.Series(rows[[*trial, "classifier"]].merge(pd.concat([networks, sums]), how="left")["known"])
    reasons = learned.map({True: "", False: UNTRAINED}).fillna(UNMEASURED)
    reasons = reasons.where(rows["classifier"].astype(str).str.startswith(SUM), "")
    return pd.Series(reasons.to_numpy(), index=rows.index)


def _whole(rows: pd.DataFrame) -> pd.Series:
    """(n,) whether a selection of recorded touches left nothing out: its rows are those of all touches."""
    if not {"method", "train", "test"} <= set(rows) or "all" not in set(rows["method"]):
        return pd.Series(False, index=rows.index)
    keys = [column for column in ("group", "split", "classifier", "scaling", "repetition", "metric") if column in rows]
    count = rows["train"] + rows["test"]
    whole = count.where(rows["method"] == "all").groupby([rows[key] for key in keys], dropna=False).transform("max")
    return rows["method"].str.startswith("selected", na=False) & (count == whole)


def _below(rows: pd.DataFrame, guess: pd.Series) -> pd.Series:
    """(n,) whether a kind of trial has a mean accuracy below guessing on the data set; False where that is unknown."""
    kinds = [column for column in TRIAL if column in rows]
    lead = (rows["value"] - guess).where(rows["metric"] == "accuracy")
    return lead.groupby([rows[kind].astype(str) for kind in kinds]).transform("mean").lt(0) if kinds else lead.lt(0)


def _beside(results: Measurements, stage: str, dataset: str, rows: pd.DataFrame, metric: str) -> pd.Series:
    """(n,) another metric of the same trials, NaN where it was not measured."""
    try:
        metric_rows = results.measured(stage, dataset, metric=metric)
    except Missing:
        return pd.Series(float("nan"), index=rows.index)

    def of_all() -> pd.Series:
        values = metric_rows.drop_duplicates(keys)[[*keys, "value"]].rename(columns={"value": "_beside"})
        all_rows = results.rows(stage, dataset)[keys]
        return pd.Series(all_rows.merge(values, on=keys, how="left")["_beside"].to_numpy(), index=all_rows.index)

    value_columns = {"metric", "value", "seconds", "note", "imprints", "clock", "layer", "part"}
    keys = [column for column in rows if column in metric_rows and column not in value_columns]
    return results.cached(("beside", stage, dataset, metric, *keys), of_all)[rows.index]


def invalid_units(rows: pd.DataFrame) -> pd.Series:
    """The cause of each invalid unit, indexed by item, method and target: its error says nothing about its points.

    rows: those of the lod stage on one set, plain QEM among them. A unit is invalid where its method found no point,
    where all its errors equal plain QEM's, or where the kept points have less than one ring in the mean. Units without
    a mesh, and those of plain simplification, are neither valid nor invalid.
    """
    meshes = rows[rows["value"].notna() & ~rows["method"].isin([PLAIN, QSLIM])]
    units = meshes.drop_duplicates(UNIT).set_index(UNIT)
    keeps = ~units.index.get_level_values("method").str.endswith("-soft")  # the others weigh the error
    causes = {
        NO_POINT: keeps & (units["points"] == 0),
        AS_PLAIN: units.index.isin(as_plain(rows)),
        NO_RING: keeps & (units["rings"].fillna(0) < 1),
    }
    reasons = pd.Series(pd.NA, units.index, dtype="object", name="cause")
    for cause, invalid in causes.items():
        reasons = reasons.mask(reasons.isna() & invalid, cause)
    return reasons.dropna()


def as_plain(rows: pd.DataFrame) -> pd.MultiIndex:
    """The units, item, method and target, whose errors all equal plain QEM's."""
    keys = ["item", "target", "metric"]
    errors = rows[rows["value"].notna() & (rows["metric"] != "faces")]
    plain = errors.loc[errors["method"] == PLAIN, [*keys, "value"]]
    error_pairs = errors[~errors["method"].isin([PLAIN, QSLIM])].merge(plain, on=keys, suffixes=("", "_plain"))
    is_equal = (error_pairs["value"] == error_pairs["value_plain"]).groupby([error_pairs[key] for key in UNIT]).all()
    return pd.MultiIndex.from_frame(is_equal.index[is_equal].to_frame())
