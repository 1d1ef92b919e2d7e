"""Named statistics of claims: functions from rows to the differences of a claim, before scaling, by its units.

A claim of conf/claims names one of STATISTICS; most take `difference`, the first side minus the second.
"""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from itertools import combinations
from typing import Any

import numpy as np
import pandas as pd

from stages.engine.measurements import Measurements, Missing, listed
from stages.engine.statistics import interval, pseudo_values

from .claims import Claim
from .pairs import difference, invalid_pairs, reasons_of, require_rows, side

CELL = ["item", "target"]  # one simplified object
MANY = 5  # methods or objects that a rank correlation needs
UNRANKED = ("qem", "qslim")  # plain simplification keeps no points
WAYS = ("adaptive", "area", "soft")  # of keeping a neighbourhood, behind a method's name
ONE_TOUCH = {"cells": 32, "pitch": 0.01, "metric": "accuracy", "split": "objects"}  # the best array of T4.3.2
ALIKE = (("bird", "airplane"), ("bust", "vase"))  # by touch, says T4.4.10; its cars are not among the classes


def extreme_weight(results: Measurements, claim: Claim, sign: int) -> pd.Series:
    """The weight of the first side's channel minus the largest of the others (sign 1); the lowest minus it (-1)."""
    where = {**claim.where, **claim.first}
    channel = where.pop("channel")
    rows = results.measured(claim.stage, claim.sets[0], **where)
    of_all = rows[rows["item"].isna() & (rows["channel"] != channel)].set_index("channel")["value"]
    parts = (rows[rows["channel"] == name] for name in (channel, (sign * of_all).idxmax()))
    first, other = (
        pseudo_values(part["value"][part["item"].isna()].iloc[0], part.dropna(subset="item").set_index("item")["value"])
        for part in parts
    )
    return sign * (first - other)


def varies_more(results: Measurements, claim: Claim) -> pd.Series:
    """Distance of the gain of the first side's channel from its mean, as a share of it, minus that of the others."""
    gains = _gains(results, claim, claim.where)
    shares = (gains / gains.mean() - 1).abs().dropna(axis=1)
    channel = claim.first["channel"]
    return shares[channel] - shares.drop(columns=channel).mean(axis=1)


def share_rises_with(results: Measurements, claim: Claim) -> pd.Series:
    """Rank correlation over the objects of a channel's share in the gain with the second side, as pseudo-values.

    The share counts, since every channel gains more where an object fills less of the picture.
    """
    channel = claim.first["channel"]
    gains = _gains(results, claim, {key: value for key, value in claim.first.items() if key != "channel"})
    second = side(results, claim, claim.other, None)
    table = pd.concat([gains[channel] / gains.sum(axis=1), second], axis=1, join="inner", keys=["first", "second"])
    return _by_jackknife(table, lambda part: part["first"].corr(part["second"], method="spearman"))


def differs_with(results: Measurements, claim: Claim) -> pd.Series:
    """Rank correlation of two distances over pairs of objects, as pseudo-values by object (Mantel 1967).

    The distances are those of the channels' shares in the gain, and of the second side.
    """
    from scipy.spatial.distance import pdist

    gains = _gains(results, claim, claim.first)
    shares = gains.div(gains.sum(axis=1), axis=0)
    table = shares.join(side(results, claim, claim.other, None).rename("second"), how="inner")

    def correlation(part: pd.DataFrame) -> float:
        far_apart = [pd.Series(pdist(part[columns])) for columns in (list(shares), ["second"])]
        return far_apart[0].corr(far_apart[1], method="spearman")

    return _by_jackknife(table, correlation)


def _gains(results: Measurements, claim: Claim, where: Mapping[str, Any]) -> pd.DataFrame:
    """Frame (object, channel) of information gains."""
    rows = results.measured(claim.stage, claim.sets[0], **where)
    return rows.pivot(index="item", columns="channel", values="value")


def _by_jackknife(table: pd.DataFrame, measure: Callable[[pd.DataFrame], float]) -> pd.Series:
    if len(table) < MANY:
        raise Missing(f"fewer than {MANY} objects to rank")
    without = {name: measure(table.drop(index=name)) for name in table.index}
    return pseudo_values(measure(table), pd.Series(without).rename_axis("item"))


def below(results: Measurements, claim: Claim, share: float) -> pd.Series:
    """How many more of the first side's values than of the second's lie below a quantile of both, as a share by unit.

    It is above zero where the first side's own quantile is the lower one. Values at the quantile count half.
    """
    sides = (claim.first, claim.other), (claim.other, claim.first)
    values = pd.concat([side(results, claim, *pair) for pair in sides], axis=1, keys=["first", "second"]).dropna()
    if values.empty:
        return values["first"]
    edge = values.stack().quantile(share)  # pyright: ignore[reportAttributeAccessIssue]
    shares = (values < edge) + (values == edge) / 2
    return (shares["first"] - shares["second"]).groupby(level=list(range(len(claim.over))), sort=False).mean()


def nearer_to_plain(results: Measurements, claim: Claim) -> pd.Series:
    """How much nearer to the error of plain QEM the second side's error is, as a share of the latter, by object."""
    plain = side(results, claim, {"method": "qem"}, None)
    far, near = ((side(results, claim, method, None) / plain - 1).abs() for method in (claim.first, claim.other))
    return (far - near).dropna().groupby(level="item").mean()


def spread(results: Measurements, claim: Claim) -> pd.Series:
    """Standard deviation over the methods of the first side, under the first selection minus under the second."""
    tables = (_errors(results, claim, claim.first["method"], **where) for where in claim.contrast)
    first, second = (table.std(axis=1).droplevel("target") for table in tables)
    return first - second


def falls_with_faces(results: Measurements, claim: Claim) -> pd.Series:
    """Error at the fewest faces minus error at the largest number, of objects with several counts."""
    rows = results.measured(claim.stage, claim.sets[0], **claim.where, **claim.first).sort_values("faces")
    rows = _valid(results, claim, rows)
    rows = rows[rows.groupby("item")["faces"].transform("nunique") > 1]
    require_rows(rows, "no object that is taken to two face counts")
    errors = rows.groupby("item")["value"]
    return errors.first() - errors.last()


def room(results: Measurements, claim: Claim) -> pd.Series:
    """Minus the relative difference from the second side of the method and metric whose interval leaves least room.

    With the claim's margin, an equivalence test by the interval: above zero where the whole interval of the difference
    lies within the margin (Schuirmann 1987, with the 95 % interval instead of 90 %: stricter).
    """
    return min((sign * gap for gap in _gaps(results, claim) for sign in (-1, 1)), key=_low_end)


def fall(results: Measurements, claim: Claim) -> pd.Series:
    """The relative difference from the second side of the method that falls farthest below it: `room` to one side."""
    return min(_gaps(results, claim), key=_low_end)


def _gaps(results: Measurements, claim: Claim) -> list[pd.Series]:
    """The relative difference of each method and metric of the first side from the second side, by object."""
    base, gaps = claim.other["method"], []
    for metric in listed(claim.where["metric"]):
        table = _errors(results, claim, (base, *claim.first["method"]), metric=metric)
        if base not in table or table.shape[1] < 2:
            raise Missing(f"lod did not run {base} beside another")
        middle = (table.add(table[base], axis=0) / 2).where(lambda mean: mean > 0, 1.0)
        shares = table.sub(table[base], axis=0) / middle
        gaps += [shares[name].groupby("item").mean() for name in table if name != base]
    return gaps


def _low_end(values: pd.Series) -> float:
    """The lower end of the interval; the mean where one object has none."""
    mean, low, _ = interval(values)
    return mean if np.isnan(low) else low


def ranks_agree(results: Measurements, claim: Claim) -> pd.Series:
    """Rank correlation over the methods, per object, of the metrics of both sides; of the points without a second.

    Methods with a way behind their name keep the same points in another way and are left out, as are sums of maps.
    """
    metric = str(claim.first["metric"])
    errors = _by_method(results, claim, metric, "value")
    if errors.empty or errors.shape[1] < MANY:
        raise Missing(f"fewer than {MANY} methods to rank")
    second = (str(claim.other["metric"]), "value") if claim.second else (metric, "points")
    return errors.corrwith(_by_method(results, claim, *second), axis=1, method="spearman")


def _errors(results: Measurements, claim: Claim, methods: tuple[str, ...], **where: object) -> pd.DataFrame:
    """Frame (object, target) x methods, where all of the methods that were run reach the target."""
    rows = results.measured(claim.stage, claim.sets[0], **{**claim.where, **where}, method=methods)
    table = _valid(results, claim, rows).pivot(index=CELL, columns="method", values="value").dropna()
    require_rows(table, f"no target that all of {', '.join(methods)} reach")
    return table


def _valid(results: Measurements, claim: Claim, rows: pd.DataFrame) -> pd.DataFrame:
    """The rows without those of an object and target at which a method's row is invalid."""
    bad = invalid_pairs(rows, reasons_of(results, claim, rows), CELL).index
    return rows[~pd.MultiIndex.from_frame(rows[CELL]).isin(bad)] if len(bad) else rows


def _by_method(results: Measurements, claim: Claim, metric: str, column: str) -> pd.DataFrame:
    """Frame objects x methods of a column, mean over the targets that all methods reach; no objects without ranks."""
    rows = results.measured(claim.stage, claim.sets[0], **claim.where, metric=metric)
    rows = rows[[_keeps_rings(name) for name in rows["method"]]]
    method_counts = rows.groupby(CELL)["method"].transform("nunique")
    rows = rows[method_counts == rows["method"].nunique()]
    table = rows.pivot_table(index="item", columns="method", values=column)
    return table[table.nunique(axis=1) > 1]


def _keeps_rings(method: str) -> bool:
    """Whether a method keeps points with neighbourhoods of fixed size, found on maps that are no sums."""
    return method not in UNRANKED and method.rpartition("-")[2] not in WAYS and "+sums" not in method


def unlike_more_accurate(results: Measurements, claim: Claim) -> pd.Series:
    """Minus the rank correlation over the methods of shares of like imprints (first side) and accuracies (second)."""
    rows = (results.measured(claim.stage, claim.sets[0], **claim.where, **part) for part in (claim.first, claim.other))
    shares, accuracies = (part.pivot_table(index="set", columns="method", values="value") for part in rows)
    return -shares.corrwith(accuracies, axis=1, method="spearman")


def whole_sequences(results: Measurements, claim: Claim) -> pd.Series:
    """First side minus second, of the sequences with all their frames and cells."""
    size = results.measured(claim.stage, claim.sets[0])[["frames", "cells"]].max()
    return difference(results, replace(claim, where={**claim.where, **size})).sort_index()


def over_one_touch(results: Measurements, claim: Claim) -> pd.Series:
    """Accuracy of the first side minus that of the best classifier of single touches, by class of the same objects."""
    table = results.measured("sensor_size", claim.sets[0], **ONE_TOUCH)
    table = table.pivot_table(index="group", columns="classifier", values="value")
    return whole_sequences(results, replace(claim, second=0.0)) - table[table.mean().idxmax()]


def alike_confused(results: Measurements, claim: Claim) -> pd.Series:
    """The share of sequences of ALIKE taken for each other, by classifier: the first side's minus the second's.

    Without a second side: minus the share of the mean other pair.
    """
    first = _confusions(results, claim, claim.first)
    if claim.second is None:
        return first[list(ALIKE)].mean(axis=1) - first.drop(columns=list(ALIKE)).mean(axis=1)
    return (first - _confusions(results, claim, claim.other))[list(ALIKE)].mean(axis=1).dropna()


def _confusions(results: Measurements, claim: Claim, selection: Mapping[str, Any]) -> pd.DataFrame:
    """A row for each classifier, a column for each pair of classes: the share that is taken for the other class."""
    rows = results.measured(claim.stage, claim.sets[0], **claim.where, **selection)
    counts = rows.pivot_table(index="classifier", columns=["group", "predicted"], values="value", fill_value=0.0)
    totals = counts.T.groupby(level="group").sum().T
    pairs = [*ALIKE, *(pair for pair in combinations(totals, 2) if not {pair, pair[::-1]} & {*ALIKE})]
    return pd.DataFrame({
        pair: (counts.get(pair, 0) + counts.get(pair[::-1], 0)) / (totals[pair[0]] + totals[pair[1]]) for pair in pairs
    })  # fmt: skip


def later_change_less(results: Measurements, claim: Claim) -> pd.Series:
    """Minus the rank correlation of a convolution's depth with its change, per training."""
    from scipy.stats import spearmanr

    changes = results.measured(claim.stage, claim.sets[0], **claim.where)
    return -changes.groupby("repetition")["value"].agg(lambda values: spearmanr(np.arange(len(values)), values)[0])


def over_classifiers(results: Measurements, claim: Claim) -> pd.Series:
    """First side minus the classifier, of those without a network for photographs, that is right most often.

    Another stage has their rows, of the same splits: of features of the pressure array, of bare electrodes.
    """
    key, where = claim.over[0], {"metric": "accuracy", "split": claim.where["split"]}
    where |= {"group": "all", "method": ("all", "unreduced")} if "pressure" in claim.where["data"] else {"palm": "all"}
    rows = results.measured("recorded", claim.sets[0], **where)
    rows = rows[rows["classifier"] != "majority"].dropna(axis=1, how="all")
    ways = rows.columns.intersection(["classifier", "method", "scaling", "scaled", "components"])
    first = side(results, claim, claim.first, None)
    table = rows.pivot_table(index=key, columns=list(ways), values="value").reindex(first.index)
    return first - table[table.mean().idxmax()]


STATISTICS: dict[str, Callable[[Measurements, Claim], pd.Series]] = {
    "difference": difference,
    "least_weight": partial(extreme_weight, sign=-1),
    "largest_weight": partial(extreme_weight, sign=1),
    "varies_more": varies_more,
    "share_rises_with": share_rises_with,
    "differs_with": differs_with,
    "median_below": partial(below, share=0.5),
    "upper_quartile_below": partial(below, share=0.75),
    "nearer_to_plain": nearer_to_plain,
    "spread": spread,
    "falls_with_faces": falls_with_faces,
    "room": room,
    "fall": fall,
    "ranks_agree": ranks_agree,
    "unlike_more_accurate": unlike_more_accurate,
    "whole_sequences": whole_sequences,
    "over_one_touch": over_one_touch,
    "alike_confused": alike_confused,
    "later_convolutions_change_less": later_change_less,
    "over_classifiers": over_classifiers,
}
