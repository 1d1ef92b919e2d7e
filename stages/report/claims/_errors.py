"""What the claims on simplified meshes compare: paired differences of errors, one value an object.

Each function here returns differences(results, source=OWN): a Series over objects, positive on the claimed side.
source: which data set (stages.report.lod_cells).
"""

import pandas as pd

from stages.kit.stats import bootstrap_interval
from stages.report.lod_cells import CELL, ERRORS, OWN, PLAIN, cells, paired_cells
from stages.report.results import NotRun
from stages.report.style import WAYS

LOW, HIGH = "1500", "3000"  # the thesis's two face counts
MANY = 5  # methods that a rank correlation needs


def errors(results, source, metric, methods, targets=None):
    """Frame (object, target) x methods of one error, where all of the methods that were run reach the target.

    targets: only these; NotRun where nothing is left.
    """
    rows = paired_cells(results, [metric], methods, source)
    rows = rows if targets is None else rows[rows["target"].isin(targets)]
    if rows.empty:
        where = f" at {' and '.join(targets)} faces" if targets else ""
        raise NotRun(f"no {metric} of {', '.join(methods)} on one object{where}", "lod", runnable=False)
    return rows.pivot(index=CELL, columns="method", values="value")


def sides(results, source, metric, first, second, targets=None):
    """(value of first, value of second), each a Series over (object, target): the mean of those that were run.

    first, second: a method, or a list of methods.
    """
    listed = [[side] if isinstance(side, str) else list(side) for side in (first, second)]
    table = errors(results, source, metric, list(dict.fromkeys(sum(listed, []))), targets)
    found = [table[[method for method in side if method in table]] for side in listed]
    for side, methods in zip(found, listed, strict=True):
        if side.empty:
            raise NotRun(f"lod did not run {' or '.join(methods)}", "lod", runnable=False)
    return tuple(side.mean(axis=1) for side in found)


def higher(first, second, metric="metro_mean", targets=None):
    """How much higher the error of `first` is than that of `second`, in % of the mean of the two.

    Face counts weigh the same whatever the size of their errors; two errors of zero are equal.
    """

    def differences(results, source=OWN):
        ours, theirs = sides(results, source, metric, first, second, targets)
        middle = (ours + theirs) / 2
        return (100 * (ours - theirs) / middle.where(middle > 0, 1.0)).groupby("object").mean()

    return differences


def higher_than_each(first, others, metric="metro_mean", targets=None, worst=True):
    """As `higher`, against the one of the others with the highest error on the mean (worst=False: the lowest)."""

    def differences(results, source=OWN):
        table = errors(results, source, metric, [first, *others], targets)
        means = table.drop(columns=first, errors="ignore").mean()
        if means.empty or first not in table:
            raise NotRun(f"lod did not run {first} beside another", "lod", runnable=False)
        rival = means.idxmax() if worst else means.idxmin()
        return higher(first, rival, metric, targets)(results, source)

    return differences


def more_at_few_faces(first, second, metric="metro_mean"):
    """The difference of `higher`, in the error's shown unit, at 1,500 faces minus that at 3,000."""

    def differences(results, source=OWN):
        ours, theirs = sides(results, source, metric, first, second, [LOW, HIGH])
        gap = (ERRORS[metric][1] * (ours - theirs)).unstack("target")
        return _both_counts(gap)

    return differences


def wider_at_few_faces(methods, metric="metro_mean"):
    """How much farther apart the methods are (standard deviation) at 1,500 faces than at 3,000."""

    def differences(results, source=OWN):
        table = errors(results, source, metric, methods, [LOW, HIGH])
        return _both_counts((ERRORS[metric][1] * table.std(axis=1)).unstack("target"))

    return differences


def falls_with_faces(method, metric="metro_mean"):
    """Error at the fewest faces minus error at the most, in the error's shown unit; of objects with several counts."""

    def differences(results, source=OWN):
        rows = cells(results, [metric], source, [method]).sort_values("faces")
        rows = rows[rows.groupby("object")["faces"].transform("nunique") > 1].groupby("object")["value"]
        if not len(rows):
            raise NotRun(f"no object that {method} takes to two face counts", "lod", runnable=False)
        return ERRORS[metric][1] * (rows.first() - rows.last())

    return differences


def room_within(margin, methods, base, metrics=("metro_mean",), targets=(LOW, HIGH)):
    """Margin minus the difference from `base` of the method and metric whose interval leaves the least room.

    An equivalence test by the interval: above zero where the whole interval of the difference lies within the margin
    (Schuirmann 1987, with the 95 % interval instead of 90 %: stricter). In the unit of the metric; margins and errors
    of metro_mean are shares of the diagonal.
    """

    def differences(results, source=OWN):
        gaps = []
        for metric in metrics:
            table = errors(results, source, metric, [base, *methods], targets)
            if base not in table or table.shape[1] < 2:
                raise NotRun(f"lod did not run {base} beside another", "lod", runnable=False)
            gaps += [(table[name] - table[base]).groupby("object").mean() for name in table if name != base]
        sides = [margin - side * gap for gap in gaps for side in (1, -1)]
        return min(sides, key=lambda room: bootstrap_interval(room)[1])

    return differences


def ranks_agree(first, second):
    """Rank correlation over the methods, an object. first, second: an error, or `points`.

    Methods with a way behind their name keep the same points in another way and are left out.
    """

    def differences(results, source=OWN):
        tables = [_by_method(results, source, column) for column in (first, second)]
        tables = [table[table.nunique(axis=1) > 1] for table in tables]  # equal values have no ranks
        if tables[0].empty or tables[0].shape[1] < MANY:
            raise NotRun(f"fewer than {MANY} methods to rank", "lod", runnable=False)
        return tables[0].corrwith(tables[1], axis=1, method="spearman").dropna()

    return differences


def _by_method(results, source, column):
    """Frame objects x methods of an error or the points, mean over the face counts that all methods reach."""
    metric = column if column in ERRORS else "metro_mean"
    every = set(cells(results, [metric], source)["method"]) - {PLAIN}
    rows = paired_cells(results, [metric], [name for name in every if name.rpartition("-")[2] not in WAYS], source)
    return rows.pivot_table(index="object", columns="method", values="value" if column in ERRORS else column)


def _both_counts(table):
    if not {LOW, HIGH} <= set(table):
        raise NotRun(f"no object was measured at both {HIGH} and {LOW} faces", "lod", runnable=False)
    return pd.Series(table[LOW] - table[HIGH]).dropna()
