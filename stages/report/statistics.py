"""Named statistics of claims: functions from rows to the differences of a claim on one set, by its units.

A claim of conf/claims names one of STATISTICS; most take `difference`, the first side minus the second.
"""

from collections.abc import Callable
from functools import partial
from itertools import combinations

import pandas as pd

from stages.engine.measurements import Measurements, Missing
from stages.engine.statistics import pseudo_values

from .claims import Claim, Side
from .pairs import Pairs, difference, require_rows, selected, side_rows, silent_rows

MANY = 5  # methods or objects that a rank correlation needs
CELL = ["item", "target"]  # one simplified object
ALIKE = (("bird", "airplane"), ("bust", "vase"))  # by touch, says T4.4.10; its cars are not among the classes


def left_out(measurements: Measurements, claim: Claim, dataset: str) -> Pairs:
    """First side minus the second's, of weights that are learned from all objects but one, as pseudo-values by object.

    Rows without an item have the weights of all objects; the largest, or least, of the other channels is theirs.
    """
    first, second = claim.first["channel"], claim.sides()[1]["channel"]
    weights = measurements.measured(claim.stage, dataset, **claim.where)
    weights = weights.assign(item=weights["item"].fillna("")).pivot(index="item", columns="channel", values="value")
    others = weights.loc[""].drop(first)
    rival = others.idxmin() if second.lowest else others.idxmax()
    differences = weights[first] - weights[rival]
    return Pairs(pseudo_values(differences[""], differences.drop("")))


def share_rises_with(measurements: Measurements, claim: Claim, dataset: str) -> Pairs:
    """Rank correlation over the objects of a channel's share in the gain with the second side, as pseudo-values.

    The share counts, since every channel gains more where an object fills less of the picture.
    """
    channel = claim.first["channel"]
    table = _shares(measurements, claim, dataset)
    return _by_jackknife(table, lambda part: part[channel].corr(part["second"], method="spearman"))


def shares_differ_with(measurements: Measurements, claim: Claim, dataset: str) -> Pairs:
    """Rank correlation of two distances over pairs of objects, as pseudo-values by object (Mantel 1967).

    The distances are those of the channels' shares in the gain, and of the second side.
    """
    from scipy.spatial.distance import pdist

    def correlation(part: pd.DataFrame) -> float:
        far_apart = [pd.Series(pdist(part[columns])) for columns in ([*part][:-1], ["second"])]
        return far_apart[0].corr(far_apart[1], method="spearman")

    return _by_jackknife(_shares(measurements, claim, dataset), correlation)


def _shares(measurements: Measurements, claim: Claim, dataset: str) -> pd.DataFrame:
    """Frame (object, channel) of each channel's share in the information gain, and the second side as last column."""
    first = {name: value for name, value in claim.first.items() if name != "channel"}
    gains = selected(measurements, claim, dataset, first)[0].pivot(index="item", columns="channel", values="value")
    second = side_rows(measurements, claim, dataset, claim.sides()[1]).values
    return gains.div(gains.sum(axis=1), axis=0).join(second.rename("second"), how="inner")


def _by_jackknife(table: pd.DataFrame, measure: Callable[[pd.DataFrame], float]) -> Pairs:
    if len(table) < MANY:
        raise Missing(f"fewer than {MANY} objects to rank")
    without = {name: measure(table.drop(index=name)) for name in table.index}
    return Pairs(pseudo_values(measure(table), pd.Series(without).rename_axis("item")))


def below(measurements: Measurements, claim: Claim, dataset: str, share: float) -> Pairs:
    """How many more of the first side's values than of the second's lie below a quantile of both, as a share by unit.

    It is above zero where the first side's own quantile is the lower one. Values at the quantile count half.
    """
    pairs = zip(("first", "second"), claim.sides(), reversed(claim.sides()), strict=True)
    parts = {name: side_rows(measurements, claim, dataset, side, other).values for name, side, other in pairs}
    values = pd.concat(parts, axis=1).dropna()
    require_rows(values, "no pairs")
    edge = values.stack().quantile(share)  # pyright: ignore[reportAttributeAccessIssue]
    shares = (values < edge) + (values == edge) / 2
    unit = list(range(len(claim.over)))
    return Pairs((shares["first"] - shares["second"]).groupby(level=unit, sort=False).mean(), len(values))


def spread(measurements: Measurements, claim: Claim, dataset: str) -> Pairs:
    """Standard deviation over the methods of the first side, under the first selection minus under the second."""
    first, second = (_by_method(measurements, claim, dataset, {**claim.first, **part}) for part in claim.contrast)
    differences = (first.std(axis=1) - second.std(axis=1)).dropna()
    return Pairs(differences, len(differences))


def ranks_agree(measurements: Measurements, claim: Claim, dataset: str) -> Pairs:
    """Rank correlation over the methods, by unit, of the values of both sides.

    A second side that names a `column` has its values from there. Without one, the order of the rows stands for it:
    the depth of the layers of a network, which take the place of methods.
    """
    unit = [*claim.over]
    if claim.second is None:
        rows, _ = selected(measurements, claim, dataset, claim.first)
        depth = rows.groupby(unit).cumcount()
        ranks = rows.assign(depth=depth).groupby(unit)[["value", "depth"]].corr(method="spearman")["value"]
        return Pairs(ranks.xs("depth", level=-1))
    first, second = (_by_method(measurements, claim, dataset, side) for side in claim.sides())
    if first.empty or first.shape[1] < MANY:
        raise Missing(f"fewer than {MANY} methods to rank")
    return Pairs(first.corrwith(second, axis=1, method="spearman").dropna(), len(first))


def _by_method(measurements: Measurements, claim: Claim, dataset: str, side: Side) -> pd.DataFrame:
    """Frame (units, methods), mean over the targets that all methods reach; no units without ranks."""
    rows, _ = selected(measurements, claim, dataset, side)
    if claim.stage == "lod":
        rows = rows[silent_rows(measurements, claim, rows) == ""]
        reached = rows.groupby(CELL)["method"].transform("nunique")
        rows = rows[reached == reached.max()]
    table = rows.pivot_table(index=[*claim.over], columns="method", values=str(side.get("column", "value")))
    return table[table.nunique(axis=1) > 1].dropna()


def alike_confused(measurements: Measurements, claim: Claim, dataset: str) -> Pairs:
    """The share of sequences of ALIKE taken for each other, by classifier: the first side's minus the second's.

    Without a second side: minus the share of the mean other pair.
    """
    first, *others = (_confusions(measurements, claim, dataset, side) for side in claim.sides())
    if not others:
        return Pairs(first[list(ALIKE)].mean(axis=1) - first.drop(columns=list(ALIKE)).mean(axis=1))
    return Pairs((first - others[0])[list(ALIKE)].mean(axis=1).dropna())


def _confusions(measurements: Measurements, claim: Claim, dataset: str, side: Side) -> pd.DataFrame:
    """A row for each classifier, a column for each pair of classes: the share that is taken for the other class."""
    rows, _ = selected(measurements, claim, dataset, side)
    counts = rows.pivot_table(index="classifier", columns=["group", "predicted"], values="value", fill_value=0.0)
    totals = counts.T.groupby(level="group").sum().T
    pairs = [*ALIKE, *(pair for pair in combinations(totals, 2) if not {pair, pair[::-1]} & {*ALIKE})]
    return pd.DataFrame({
        pair: (counts.get(pair, 0) + counts.get(pair[::-1], 0)) / (totals[pair[0]] + totals[pair[1]]) for pair in pairs
    })  # fmt: skip


STATISTICS: dict[str, Callable[[Measurements, Claim, str], Pairs]] = {
    "difference": difference,
    "left_out": left_out,
    "share_rises_with": share_rises_with,
    "shares_differ_with": shares_differ_with,
    "median_below": partial(below, share=0.5),
    "upper_quartile_below": partial(below, share=0.75),
    "spread": spread,
    "ranks_agree": ranks_agree,
    "alike_confused": alike_confused,
}
