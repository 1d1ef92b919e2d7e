"""Claims as data: entries of conf/claims/*.yaml that say which rows are compared, in which pairs.

`load` reads the files of a folder into `Claim` objects, and names the file and line of an entry that is wrong.
"""

import difflib
import re
from collections.abc import Iterable, Mapping
from dataclasses import MISSING, dataclass, fields, replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import yaml

from stages.engine.measurements import listed

FOLDER = Path(__file__).resolve().parents[2] / "conf/claims"
Side = Mapping[str, Any]  # column -> value; a tuple: the mean of several; a Pick: one of several, by its mean
PRINTED = re.compile(r"(?P<number>[+-]?[\d.]+) (?P<unit>[^,]+)(?:, (?P<source>.+))?")


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
    """Another reasonable reading of an ambiguous protocol, in which the word may differ.

    name: the reading in words. changes: the fields of the claim that differ; where, first and second are merged into
    those of the claim.
    """

    name: str
    changes: Mapping[str, Any]

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
    second: the rows of each side, of another stage or set where a side names `stage` or `dataset`; second may be a
    number (before scaling) or none. where: what both have in common. over: columns whose combinations are the pairs,
    the outermost unit of the analysis first (stages.engine.rows); none for a single number, such as a file's size,
    which has no interval. within: columns that are matched too, before the differences of a pair are averaged.
    relative: differences as shares of the mean of both sides. mean_of: the side ("first" or "second") that counts by
    the mean of all its rows. contrast: two selections; the difference under the first minus that under the second.
    scale: from differences to `unit`. margin: what the second side may be ahead by. same: whether the sentence says
    that both sides differ by the margin at most. statistic: a name of stages.report.statistics. shared: test over
    training share of repeated splits of the same data, for the interval; of each set where they differ. ties: whether
    two equal meshes are a result. printed: the effect in the thesis with its unit and source, as in
    `15.68 points, table 4.9`. says_nothing: why the printed run itself says nothing. caveat: a clause on what limits
    the test. readings: other readings. place: file and line.
    """

    key: str
    section: str
    sentence: str
    stage: str
    sets: tuple[str, ...]
    unit: str
    where: Side
    first: Side
    second: Side | float | None = None
    contrast: tuple[Side, ...] = ()
    over: tuple[str, ...] = ("repetition",)
    within: tuple[str, ...] = ()
    relative: bool = False
    mean_of: str = ""
    scale: float = 100.0
    margin: float = 0.0
    same: bool = False
    statistic: str = "difference"
    shared: float | Mapping[str, float] = 0.0
    ties: bool = False
    printed: str = ""
    says_nothing: str = ""
    caveat: str = ""
    readings: tuple[Reading, ...] = ()
    place: str = ""

    @property
    def printed_effect(self) -> float | None:
        """The printed number, in the claim's unit."""
        match = PRINTED.fullmatch(self.printed)
        return float(match["number"]) if match else None

    def share(self, dataset: str) -> float:
        """`shared` on one set."""
        return self.shared.get(dataset, 0.0) if isinstance(self.shared, Mapping) else self.shared

    def sides(self) -> list[Side]:
        """Its sides that select rows."""
        return [side for side in (self.first, self.second) if isinstance(side, Mapping)]

    def files(self) -> list[tuple[str, str]]:
        """(stage, set) of the rows that the claim compares."""
        found = [
            (str(side.get("stage", self.stage)), str(side.get("dataset", name)))
            for name in self.sets
            for side in self.sides()
        ]
        return list(dict.fromkeys(found))


SIDES = ("where", "first", "second")
FIELDS = {field.name: field for field in fields(Claim) if field.name != "place"}
REQUIRED = [name for name, field in FIELDS.items() if field.default is MISSING]
LISTS = ("sets", "over", "within")


def load(folder: Path = FOLDER) -> list[Claim]:
    """The claims of all YAML files of a folder; ClaimError for one that is wrong."""
    claims: dict[str, Claim] = {}
    for path in sorted(folder.glob("*.yaml")):
        for claim in _read(path):
            if claim.key in claims:
                raise ClaimError(f"{claim.place}: {claim.key} is the key of {claims[claim.key].place}, too")
            claims[claim.key] = claim
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
    entry = {"where": {}, "first": {}, **content.get("defaults", {}).get(entry.get("stage"), {}), **entry}
    name = f"{place} ({entry.get('key', 'no key')})"
    _known(entry, FIELDS, name)
    if absent := [field for field in REQUIRED if field not in entry]:
        raise ClaimError(f"{name}: no {' and no '.join(absent)}")
    readings = tuple(_reading(reading, content.get("readings", {}), name) for reading in entry.pop("readings", ()))
    claim = Claim(**_values(entry, name), readings=readings, place=name)
    if claim.section != "ours" and not claim.section.startswith("T"):
        raise ClaimError(f"{name}: section {claim.section} is neither `ours` nor one of the thesis, as T4.2.4")
    match = PRINTED.fullmatch(claim.printed)
    if claim.printed and (match is None or match["unit"] != claim.unit):
        raise ClaimError(
            f"{name}: printed is `{claim.printed}`; write the number with the unit of the claim, `{claim.unit}`"
        )
    for variant in (claim, *(reading.of(claim) for reading in readings)):
        for stage, dataset in variant.files():
            if not (FOLDER.parent / f"data/{dataset}.yaml").exists():
                raise ClaimError(f"{name}: set {dataset} is not in conf/data")
            if not (FOLDER.parents[1] / "stages" / stage / "__init__.py").exists():
                raise ClaimError(f"{name}: stage {stage} is not in stages/")
    return claim


def _reading(reading: Any, known: Mapping[str, Any], place: str) -> Reading:
    if isinstance(reading, str):
        _known([reading], known, place)
        reading = {"name": reading, **known[reading]}
    changes = {field: value for field, value in reading.items() if field != "name"}
    _known(changes, FIELDS, place)
    return Reading(reading.get("name", ""), _values(changes, place))


def _known(names: Iterable[Any], known: Iterable[Any], place: str) -> None:
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
    if isinstance(shared := values.get("shared", 0.0), dict):
        values["shared"] = {name: float(Fraction(value)) for name, value in shared.items()}
    else:
        values["shared"] = float(Fraction(shared))  # which may be written as 3/7
    return values if "shared" in entry else {name: value for name, value in values.items() if name != "shared"}


def _side(side: Any, place: str) -> Any:
    return (
        {column: _value(value, f"{place}, {column}") for column, value in side.items()}
        if isinstance(side, dict)
        else side
    )


def _value(value: Any, place: str) -> Any:
    if isinstance(value, dict):
        _known(value, ("highest", "lowest", "but"), place)
        names = value.get("lowest", value.get("highest"))
        return Pick(() if names == "all" else tuple(names or ()), "lowest" in value, tuple(value.get("but", ())))
    return tuple(value) if isinstance(value, list) else value
