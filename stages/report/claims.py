"""Claims as data: entries of conf/claims/*.yaml that say which rows are compared, in which pairs.

`load` reads the files of a folder into `Claim` objects, and names the file and line of an entry that is wrong.
"""

import difflib
from collections.abc import Mapping, Sequence
from dataclasses import MISSING, dataclass, fields, replace
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from typing import Any

import yaml

from stages.charts.datasets import dataset_text
from stages.charts.numbers import number
from stages.engine.measurements import listed

FOLDER = Path(__file__).resolve().parents[2] / "conf/claims"
WORDS_FILE = "words.yaml"
POINTS = "points of accuracy"
Side = Mapping[str, Any]  # column -> value; a tuple: the mean of several; a Pick: one of several, by its mean


class ClaimError(ValueError):
    """An entry that is wrong; the message names its file and line."""


@dataclass(frozen=True)
class Pick:
    """The one of several values of a column with the highest (or lowest) mean over the pairs that all of them have.

    names: the values, none for all but those of `but` and of the other side. In YAML: {highest: [a, b]}, or
    {lowest: all, but: [c]}.
    """

    names: tuple[str, ...] = ()
    lowest: bool = False
    but: tuple[str, ...] = ()


@dataclass(frozen=True)
class Reading:
    """Another reasonable reading of an ambiguous protocol.

    name: the reading in words. changes: the fields of the claim that differ; where, first and second are merged into
    those of the claim. literal: whether this reading follows a printed formula to the letter and the claim does not.
    """

    name: str
    changes: Mapping[str, Any]
    literal: bool = False

    def of(self, claim: "Claim") -> "Claim":
        """The claim in this reading."""
        merged = {
            field: {**old, **value} if field in SIDES and isinstance(old := getattr(claim, field), Mapping) else value
            for field, value in self.changes.items()
        }
        return replace(claim, readings=(), **merged)


@dataclass(frozen=True, kw_only=True)
class Claim:
    """One testable sentence: the paired differences of two sides of the rows of a stage, positive as it is claimed.

    section: of the thesis, as T4.2.4, or "ours". sets: the data sets of the rows, whose effects are pooled. first,
    second: the rows of each side, of another set where a side names a `dataset`; second may be a number (before
    scaling) or none. where: what both have in common. over: columns whose combinations are the pairs, the outermost
    unit of the analysis first (stages.engine.rows). within: columns that are matched too, before the differences of a
    pair are averaged. relative: differences as shares of the mean of both sides. mean_of: the side ("first" or
    "second") that counts by the mean of all its rows. contrast: two selections; the difference under the first minus
    that under the second. scale, then margin: from differences to `unit`. statistic: a name of
    stages.report.statistics. shared: test over training share of repeated splits of the same data, for the interval;
    of each set where they differ. readings: other readings, in which the verdict must hold too. checked: whether rows
    that stages.report.validity refuses are out. ties: whether two equal meshes are a result and not an invalid pair.
    of: key of the claim whose sentence this one tests elsewhere. note: words behind all others. place: file and line.
    """

    key: str
    section: str
    sentence: str
    stage: str
    sets: tuple[str, ...]
    where: Side
    first: Side
    second: Side | float | None = None
    contrast: tuple[Side, ...] = ()
    over: tuple[str, ...] = ("repetition",)
    within: tuple[str, ...] = ()
    relative: bool = False
    mean_of: str = ""
    statistic: str = "difference"
    scale: float = 100.0
    margin: float = 0.0
    unit: str = POINTS
    shared: float | Mapping[str, float] = 0.0
    readings: tuple[Reading, ...] = ()
    checked: bool = True
    ties: bool = False
    of: str = ""
    note: str = ""
    place: str = ""

    @property
    def other(self) -> Side:
        """The second side; ValueError where that is a number, or none."""
        if not isinstance(self.second, Mapping):
            raise ValueError(f"claim {self.key} has no second side")
        return self.second

    def share(self, dataset: str) -> float:
        """`shared` on one set."""
        return self.shared.get(dataset, 0.0) if isinstance(self.shared, Mapping) else self.shared

    def sets_read(self) -> list[str]:
        """The data sets whose rows the claim compares."""
        named = [str(side["dataset"]) for side in (self.first, self.second)
                 if isinstance(side, Mapping) and "dataset" in side]  # fmt: skip
        return list(dict.fromkeys(named or self.sets))


SIDES = ("where", "first", "second")
FIELDS = {field.name: field for field in fields(Claim) if field.name != "place"}
REQUIRED = [name for name, field in FIELDS.items() if field.default is MISSING]
LISTS = ("sets", "over", "within")


def load(folder: Path = FOLDER) -> list[Claim]:
    """The claims of all YAML files of a folder; ClaimError for one that is wrong."""
    claims: dict[str, Claim] = {}
    for path in sorted(folder.glob("*.yaml")):
        for claim in _read(path) if path.name != WORDS_FILE else ():
            if claim.key in claims:
                raise ClaimError(f"{claim.place}: {claim.key} is the key of {claims[claim.key].place}, too")
            claims[claim.key] = claim
    for claim in claims.values():
        if claim.of and claim.of not in claims:
            raise ClaimError(f"{claim.place}: {claim.key} is `of` {claim.of}, which is no claim")
    if not claims:
        raise ClaimError(f"no claims in {folder}")
    return list(claims.values())


def _read(path: Path) -> list[Claim]:
    place = "/".join(path.parts[-3:])
    loader = yaml.CSafeLoader(path.read_text(encoding="utf-8"))
    try:
        node = loader.get_single_node()
        content = loader.construct_document(node)
    except yaml.YAMLError as error:
        raise ClaimError(f"{place}: {error}") from error
    if not isinstance(content, dict) or not isinstance(content.get("claims"), list):
        raise ClaimError(f"{place}: no list `claims`")
    _known(content, ("defaults", "readings", "claims"), place)
    (entries,) = (value for name, value in node.value if name.value == "claims")  # pyright: ignore
    lines = [entry.start_mark.line + 1 for entry in entries.value]
    return [_claim(entry, content, f"{place}:{line}") for entry, line in zip(content["claims"], lines, strict=True)]


def _claim(entry: dict[str, Any], content: dict[str, Any], place: str) -> Claim:
    readings = content.get("readings", {})
    entry = {"where": {}, "first": {}, **content.get("defaults", {}).get(entry.get("stage"), {}), **entry}
    place_of = f"{place} ({entry.get('key', 'no key')})"
    _known(entry, FIELDS, place_of)
    if absent := [name for name in REQUIRED if name not in entry]:
        raise ClaimError(f"{place_of}: no {' and no '.join(absent)}")
    own = []
    for reading in entry.get("readings", ()):
        if isinstance(reading, str):
            _known([reading], readings, place_of)
            reading = {"name": reading, **readings[reading]}
        name, literal = reading.get("name", ""), reading.get("literal", False)
        changes = {field: value for field, value in reading.items() if field not in ("name", "literal")}
        _known(changes, FIELDS, place_of)
        own.append(Reading(name, _values(changes, place_of), literal))
    values = _values({name: value for name, value in entry.items() if name != "readings"}, place_of)
    claim = Claim(**values, readings=tuple(own), place=place)
    if claim.section != "ours" and not claim.section.startswith("T"):
        raise ClaimError(f"{place_of}: section {claim.section} is neither `ours` nor one of the thesis, as T4.2.4")
    for variant in (claim, *(reading.of(claim) for reading in own)):
        for name in variant.sets:
            if not (FOLDER.parent / f"data/{name}.yaml").exists():
                raise ClaimError(f"{place_of}: set {name} is not in conf/data")
    if not (FOLDER.parents[1] / "stages" / claim.stage / "__init__.py").exists():
        raise ClaimError(f"{place_of}: stage {claim.stage} is not in stages/")
    return claim


def _known(names: Any, known: Any, place: str) -> None:
    for name in names:
        if name not in known:
            close = difflib.get_close_matches(str(name), list(map(str, known)), 1)
            raise ClaimError(f"{place}: {name} is unknown" + (f", perhaps {close[0]}" if close else ""))


def _values(entry: dict[str, Any], place: str) -> dict[str, Any]:
    """The values of fields as Claim has them."""
    values = dict(entry)
    for name in values.keys() & {*LISTS}:
        values[name] = tuple(listed(values[name]))
    for name in values.keys() & {*SIDES}:
        values[name] = _side(values[name], place)
    if "contrast" in values:
        values["contrast"] = tuple(_side(side, place) for side in values["contrast"])
    if "shared" in values:
        shared = values["shared"]
        is_each = isinstance(shared, dict)
        values["shared"] = {name: _share(value) for name, value in shared.items()} if is_each else _share(shared)
    return values


def _share(value: Any) -> float:
    """A share, which may be written as 3/7."""
    return float(Fraction(value)) if isinstance(value, str) else float(value)


def _side(side: Any, place: str) -> Any:
    if not isinstance(side, dict):
        return side
    return {column: _value(value, f"{place}, {column}") for column, value in side.items()}


def _value(value: Any, place: str) -> Any:
    if isinstance(value, dict):
        _known(value, ("highest", "lowest", "but"), place)
        names = value.get("lowest", value.get("highest"))
        return Pick(() if names == "all" else tuple(names or ()), "lowest" in value, tuple(value.get("but", ())))
    return tuple(value) if isinstance(value, list) else value


class Words:
    """Words for the columns and values of claims; those that the file of words lacks are their own names."""

    NAMES = ("method", "classifier", "network", "metric")  # columns whose values say what they are

    def __init__(self, path: Path = FOLDER / WORDS_FILE) -> None:
        self.path = path

    @cached_property
    def by_column(self) -> dict[str, dict[Any, str]]:
        """{column: {value: words}}."""
        return yaml.load(self.path.read_text(encoding="utf-8"), yaml.CSafeLoader)

    def over(self, column: str) -> str:
        """The pairs by a column."""
        return self.by_column["over"].get(column, column)

    def tested_on(self, claim: Claim, sets: Sequence[str]) -> str:
        """`household, kNN, six objects, first minus second`: sets, what both sides share, the sides, and the note."""
        shared = [self._value(column, value) for column, value in claim.where.items()]
        parts = [" and ".join(map(dataset_text, sets)), *shared, self._sides(claim), claim.note]
        return ", ".join(part.rstrip(",") for part in parts if part)

    def _sides(self, claim: Claim) -> str:
        text = self._side(claim.first)
        if claim.second:
            if isinstance(claim.second, Mapping):
                second = self._side(claim.second) or _metric(claim, claim.second)
            else:
                second = number(claim.scale * claim.second)
            text = f"{text or _metric(claim, claim.first)} minus {second}"
        if claim.contrast:
            text = f"{text}: {' minus '.join(map(self._side, claim.contrast))}"
        return text + (f", {claim.margin:+g} {claim.unit}" if claim.margin else "")

    def _side(self, side: Side) -> str:
        return " ".join(filter(None, (self._value(column, value) for column, value in side.items())))

    def _value(self, column: str, value: Any) -> str:
        if isinstance(value, Pick):
            names = ", ".join(self._value(column, name) for name in value.names) or "the others"
            return f"the {'lowest' if value.lowest else 'highest'} of {names}"
        if isinstance(value, tuple):
            return f"mean of {', '.join(self._value(column, part) for part in value)}"
        if value is None:
            return ""
        if column == "dataset":
            return dataset_text(str(value))
        words = str(value).replace("_", " ") if column in self.NAMES else f"{column} {value}"
        return self.by_column.get(column, {}).get(value, words)


def _metric(claim: Claim, side: Side) -> str:
    return str({**claim.where, **side}.get("metric", "value")).replace("_", " ")
