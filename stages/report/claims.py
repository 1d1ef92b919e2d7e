"""A claim of the thesis as data: which rows are compared, in which pairs, and the words for them."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from haptic_glance.know.split import Split, shared_by
from haptic_glance.look.points.methods import METHODS, SUMMED
from stages.charts.datasets import dataset_text
from stages.charts.drawing import label
from stages.charts.results import Results
from stages.charts.tables import number

Phrases = Mapping[tuple[str, Any], str]  # (column, value) -> words
Side = Mapping[str, Any]  # column -> value; a tuple: the mean of several; a Pick: one of several, by its mean

POINTS = "points of accuracy"
OVER = {
    "repetition": "repetitions",
    "item": "objects",
    "fold": "folds",
    "method": "methods",
    "group": "classes",
    "set": "sets",
}


@dataclass(frozen=True)
class Pick:
    """The one of several values of a column with the highest (or lowest) mean over the pairs that all of them have.

    names: the values, none for all but those of `but`, such as `*_seen`, and those of the other side.
    """

    names: tuple[str, ...] = ()
    lowest: bool = False
    but: tuple[str, ...] = ()


Methods = str | tuple[str, ...] | Pick  # of one side of a claim


def highest_of(*names: str, but: tuple[str, ...] = ()) -> Pick:
    """The value with the highest mean: the best by accuracy, the worst by error."""
    return Pick(names, False, but)


def lowest_of(*names: str, but: tuple[str, ...] = ()) -> Pick:
    """The value with the lowest mean: the worst by accuracy, the best by error."""
    return Pick(names, True, but)


@dataclass(frozen=True)
class Reading:
    """Another reasonable reading of an ambiguous protocol.

    name: the reading in words. changes: the fields of the claim that differ; a mapping such as `where` is merged into
    that of the claim. literal: whether this reading follows a printed formula to the letter and the claim does not.
    """

    name: str
    changes: Mapping[str, Any]
    literal: bool = False

    def of(self, claim: "Claim") -> "Claim":
        """The claim in this reading."""
        merged = {
            field: {**old, **value} if isinstance(old := getattr(claim, field), Mapping) else value
            for field, value in self.changes.items()
        }
        return replace(claim, readings=(), **merged)


def reading(name: str, **changes: Any) -> Reading:
    """The Reading with these changes: `reading("15 imprints", where={"variant": "first_15"})`."""
    return Reading(name, changes)


SCALE = {"scaling": "beforehand"}  # "The entire data is standardized beforehand using z-transform" (T4.2.4)
TRAINED = {"scaling": "training"}  # fitted to the training part alone, so that nothing of the test part leaks
OF_TRAINING = reading("z-transform of the training part", where=TRAINED)
RANGE = reading("all data from 0 to 1", where={"scaling": "min_max"})  # gamma 1 at its own scale
SCALED = (OF_TRAINING, RANGE)
ALIVE = ("knn", "decision_tree", "naive_bayes", "deep_learning")
NO_SVM = reading("without the SVM", where={"classifier": ALIVE})


SUMS = "sums of maps, as eq. 3.1 to 3.6 print them"  # the channels are means of these maps


def in_sums(*sides: Methods, **more: Any) -> tuple[Reading, ...]:
    """The reading of a claim on the methods of its first and second side with SUMS; none where sums change nothing.

    more: further fields that the reading changes.
    """
    summed = tuple(_renamed(side, _with_sums) for side in sides)
    changes = {side: {"method": methods} for side, methods in zip(("first", "second"), summed, strict=False)}
    return () if summed == sides else (Reading(SUMS, {**changes, **more}, literal=True),)


def _with_sums(method: str) -> str:
    base, dash, way = method.partition("-")
    base = "VisAtt" if base == "itti" else base
    return f"{base}{SUMMED}{dash}{way}" if f"{base}{SUMMED}" in METHODS else method


@dataclass(frozen=True, kw_only=True)
class Claim:
    """One testable sentence: the paired differences of two sides of the rows of a stage, positive as it is claimed.

    dataset: the set of the rows; None: the first that has rows of the stage and is not named. Several: the effects of
    those that have such rows are pooled. elsewhere: {method: the one in its place on all sets but the first}. first,
    second: the rows of each side, of another set where a side names a `dataset`; second may be a number (before
    scaling) or None. where: what both have in common. A text value with `*` is a pattern. over: columns whose
    combinations are the pairs, the outermost unit of the analysis first (stages.engine.rows); within: columns that are
    matched too, before the differences of a pair are averaged. relative: differences as shares of the mean of both
    sides. mean_of: the side ("first" or "second") that counts by the mean of all its rows. contrast: two selections;
    the difference under the first of them minus that under the second. scale, then margin: from differences to `unit`.
    statistic: a name of stages.report.effects.STATISTICS. shared: test over training share (haptic_glance.know.split),
    or a function of the set; None: that of the split where the pairs are repetitions, else 0. phrases: {(column,
    value): words} of the topic. note: words behind all others. printed: how many of the sets, from the first on, follow
    the printed protocol: their rows alone give the verdict, and the other sets show whether it carries over; 0 for all.
    None: 1 for the thesis's claims, 0 for ours. of: key of the primary claim whose sentence this claim tests elsewhere;
    a later claim in the same words and chapter is secondary without being told. readings: other readings of the
    protocol, in which the verdict must hold too. checked: whether rows that stages.report.effects refuses are out.
    ties: whether two equal meshes are a result, a difference of zero; otherwise such a pair is invalid. fixed: whether
    the claim is about the mean of its sets, in which each counts alike, and not about any sets.
    """

    key: str
    section: str
    sentence: str
    stage: str
    first: Side = field(default_factory=dict)
    second: Side | float | None = None
    where: Side = field(default_factory=dict)
    dataset: str | None | tuple[str | None, ...] = None
    elsewhere: Mapping[str, str] = field(default_factory=dict)
    over: tuple[str, ...] = ("repetition",)
    within: tuple[str, ...] = ()
    relative: bool = False
    mean_of: str = ""
    contrast: tuple[Side, Side] | None = None
    scale: float = 100.0
    margin: float = 0.0
    unit: str = POINTS
    statistic: str = "difference"
    shared: float | Callable[[str], float] | None = None
    phrases: Phrases = field(default_factory=dict)
    note: str = ""
    of: str = ""  # key of the primary claim; this one asks whether its sentence carries over
    printed: int | None = None
    readings: tuple[Reading, ...] = ()
    checked: bool = True
    ties: bool = False
    fixed: bool = False

    @property
    def is_ours(self) -> bool:
        """Whether the claim is the project's own, and not the thesis's."""
        return self.section == "ours"

    @property
    def judging(self) -> int:
        """The number of leading sets whose rows give the verdict."""
        printed = self.printed if self.printed is not None else 0 if self.is_ours else 1
        return printed or len(self.sets)

    @property
    def other(self) -> Side:
        """The second side; ValueError where that is a number, or none."""
        if self.second is None or isinstance(self.second, int | float):
            raise ValueError(f"claim {self.key} has no second side")
        return self.second

    @property
    def share(self) -> float:
        """Test over training share of the pairs, for the interval."""
        if callable(self.shared):
            return self.shared(self.sets[0] or "")
        if self.shared is not None:
            return self.shared
        split = {**self.where, **self.first}.get("split")
        return shared_by(str(split)) if "repetition" in self.over and split else 0.0

    @property
    def sets(self) -> tuple[str | None, ...]:
        """The data sets, as they were named."""
        return self.dataset if isinstance(self.dataset, tuple) else (self.dataset,)

    def on(self, dataset: str | None) -> "Claim":
        """The claim on one set; on all but the first of its own, methods give way to those of `elsewhere`."""
        shared = self.shared(dataset or "") if callable(self.shared) else self.shared
        sides = {"first": self.first, "second": self.second}
        if self.elsewhere and dataset != self.sets[0]:
            sides = {
                name: _renamed(side, lambda value: self.elsewhere.get(value, value)) for name, side in sides.items()
            }
        return replace(self, dataset=dataset, shared=shared, **sides)  # pyright: ignore[reportArgumentType]

    @property
    def pairs(self) -> str:
        """The pairs, in words."""
        return " and ".join(map(self._words_of, self.over))

    @property
    def units(self) -> str:
        """The outermost units, in words."""
        return self._words_of(self.over[0])

    def _words_of(self, column: str) -> str:
        return self.phrases.get(("over", column), OVER.get(column, column))


def _renamed(value: Any, rename: Callable[[Any], Any]) -> Any:
    """A side of a claim, or a part of it, with other names of methods."""
    if isinstance(value, Mapping):
        return {column: _renamed(part, rename) for column, part in value.items()}
    if isinstance(value, Pick):
        return replace(value, names=_renamed(value.names, rename))
    return tuple(_renamed(entry, rename) for entry in value) if isinstance(value, tuple) else rename(value)


METRICS = {  # "" where the claim's unit says it
    "accuracy": "", "recall": "mean of the objects' rates", "nss": "NSS", "auc": "AUC", "pcc": "PCC",
}  # fmt: skip
NAMED = ("method", "classifier", "network")  # columns whose values have a label


def tested_on(claim: Claim, results: Results, sets: Sequence[str]) -> str:
    """`household: kNN, six objects, first minus second`: sets, what both sides share, the sides, and the note."""
    claim, set_names = claim.on(sets[0]), " and ".join(map(dataset_text, sets))
    shared = [_phrase(claim, results, column, value) for column, value in claim.where.items()]
    parts = [set_names, *shared, _sides(claim, results), claim.note]
    return ", ".join(part.rstrip(",") for part in parts if part)


def _sides(claim: Claim, results: Results) -> str:
    text = _side(claim, results, claim.first)
    if isinstance(claim.second, int | float):
        if claim.second:
            text = text or str(claim.where.get("metric", "value")).replace("_", " ")
            text += f" minus {number(claim.scale * claim.second)}"
    elif claim.second is not None:
        text += f" minus {_side(claim, results, claim.second)}"
    if claim.contrast:
        first, second = (_side(claim, results, where) for where in claim.contrast)
        text = f"{text}: {first} minus {second}"
    return text + (f", {claim.margin:+g} {claim.unit}" if claim.margin else "")


def _side(claim: Claim, results: Results, side: Side) -> str:
    return " ".join(filter(None, (_phrase(claim, results, column, value) for column, value in side.items())))


def _phrase(claim: Claim, results: Results, column: str, value: object) -> str:
    """One column and its value in words; the topic's own words first."""
    if isinstance(value, Pick):
        rank = "lowest" if value.lowest else "highest"
        names = ", ".join(_phrase(claim, results, column, name) for name in value.names)
        return f"the {rank} of {names}" if names else f"the {rank} of the others"
    if (column, value) in claim.phrases:
        return claim.phrases[column, value]
    if isinstance(value, tuple):
        return f"mean of {', '.join(_phrase(claim, results, column, part) for part in value)}"
    if value is None:
        return ""
    if column == "group":
        return results.group_text(str(value), claim.sets[0])
    if column == "dataset":
        return dataset_text(str(value))
    if column == "split":
        return Split(str(value)).words
    if column == "metric":
        return METRICS.get(str(value), str(value).replace("_", " "))
    return label(value) if column in NAMED else f"{column} {value}"
