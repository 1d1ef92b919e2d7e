"""A claim of the thesis as data: which rows are compared, in which pairs, and in which words."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from stages.kit.split import shared_by

Phrases = Mapping[tuple[str, Any], str]  # (column, value) -> words
Side = Mapping[str, Any]  # column -> value; a tuple: the mean of several; a Pick: one of several, by its mean

POINTS = "points of accuracy"
OVER = {"repetition": "repetitions", "item": "objects", "fold": "folds", "method": "methods", "group": "groups"}


@dataclass(frozen=True)
class Pick:
    """The one of several values of a column with the highest (or lowest) mean over the pairs that all of them have.

    names: the values, none for all but those of `but`, such as `*_seen`, and those of the other side.
    """

    names: tuple[str, ...] = ()
    lowest: bool = False
    but: tuple[str, ...] = ()


def highest_of(*names: str, but: tuple[str, ...] = ()) -> Pick:
    """The value with the highest mean: the best by accuracy, the worst by error."""
    return Pick(names, False, but)


def lowest_of(*names: str, but: tuple[str, ...] = ()) -> Pick:
    """The value with the lowest mean: the worst by accuracy, the best by error."""
    return Pick(names, True, but)


@dataclass(frozen=True, kw_only=True)
class Claim:
    """One testable sentence: the paired differences of two sides of the rows of a stage, positive as it is claimed.

    dataset: the set of the rows; None: the first that has rows of the stage. first, second: the rows of each side, of
    another set where a side names a `dataset`; second may be a number (before scaling) or None. where: what both have
    in common. A text value with `*` is a pattern. over: columns whose combinations are the pairs, the unit of the
    analysis; within: columns that are matched too, before the differences of a unit are averaged. relative: differences
    as shares of the mean of both sides. mean_of: the side ("first" or "second") that counts by the mean of all its
    rows. contrast: two selections; the difference under the first of them minus that under the second. scale, then
    margin: from differences to `unit`.
    statistic: a name of stages.report.differences.STATISTICS. shared: test over training share (kit.split); None:
    that of the split where the pairs are repetitions, else 0. phrases: {(column, value): words} of the topic. note:
    words behind all others.
    """

    key: str
    section: str
    sentence: str
    stage: str
    first: Side = field(default_factory=dict)
    second: Side | float | None = None
    where: Side = field(default_factory=dict)
    dataset: str | None = None
    over: tuple[str, ...] = ("repetition",)
    within: tuple[str, ...] = ()
    relative: bool = False
    mean_of: str = ""
    contrast: tuple[Side, Side] | None = None
    scale: float = 100.0
    margin: float = 0.0
    unit: str = POINTS
    statistic: str = "difference"
    shared: float | None = None
    phrases: Phrases = field(default_factory=dict)
    note: str = ""

    @property
    def other(self) -> Side:
        """The second side; ValueError where that is a number, or none."""
        if self.second is None or isinstance(self.second, int | float):
            raise ValueError(f"claim {self.key} has no second side")
        return self.second

    @property
    def share(self) -> float:
        """Test over training share of the pairs, for the interval."""
        if self.shared is not None:
            return self.shared
        split = {**self.where, **self.first}.get("split")
        return shared_by(str(split)) if "repetition" in self.over and split else 0.0

    @property
    def pairs(self) -> str:
        """What the pairs are, in words."""
        return " and ".join(self.phrases.get(("over", column), OVER.get(column, column)) for column in self.over)
