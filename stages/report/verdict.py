"""Verdicts on claims: five words, the size beside the printed effect, the readings that differ, and the caveats.

An interval above zero supports a claim, one below contradicts it, one within MARGINS shows no difference; else the
claim is open. It is not testable where the printed run says nothing: no point found, or both sides the same mesh. The
printed protocol judges. A training that ran as printed is judged as printed; whether it was finished is a caveat.
"""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import pandas as pd
from scipy import special

from stages.charts.datasets import dataset_text
from stages.charts.numbers import number
from stages.engine.measurements import Measurements, Missing
from stages.engine.rows import by_unit
from stages.engine.statistics import Pooled, discoveries, interval, p_value, pool

from .claims import Claim, Pick
from .pairs import Pairs, require_rows
from .statistics import STATISTICS

WORDS = ("supported", "contradicted", "no difference", "open", "not testable")
SUPPORTED, CONTRADICTED, NO_DIFFERENCE, OPEN, NOT_TESTABLE = WORDS
# By unit: what nobody would act on. Stated before the claims were judged by it; other units have none.
MARGINS = {"points": 3.0, "% of the mean error": 3.0, "PCC": 0.03, "NSS": 0.05, "AUC": 0.01}
TOO_MANY = 0.2  # share of silent pairs from which a claim cannot be tested
RINGLESS = 0.2  # share of meshes without a ring about their points that a reader must know
ALPHA = 0.05  # of a p-value
FEW = 2  # units of a set whose spread says nothing
COLUMNS = [
    "section", "claim", "verdict", "effect", "low", "high", "unit", "printed", "size", "readings", "caveat", "p",
    "pairs", "over", "units", "sets", "key",
]  # fmt: skip
TEXTS = [
    "printed",
    "size",
    "readings",
    "caveat",
    "over",
    "sets",
]  # columns that are empty where there is nothing to say


@dataclass(frozen=True)
class Effect:
    """The differences of a claim on one set, in its unit; share: as `Claim.share`."""

    dataset: str
    pairs: Pairs
    share: float

    @property
    def testable(self) -> bool:
        """Whether at most a fifth of the pairs is silent."""
        return self.pairs.silent.total() <= TOO_MANY * self.pairs.count

    @cached_property
    def units(self) -> pd.Series:
        """The differences of the outermost units."""
        return by_unit(self.pairs.differences)

    @cached_property
    def interval(self) -> tuple[float, float, float]:
        """(mean, low, high) over the units; no ends (NaN) where their spread is unknown."""
        return interval(self.units, self.share)

    @cached_property
    def p_value(self) -> float:
        """Two-sided, of no effect."""
        return p_value(self.units, self.share)


@dataclass(frozen=True)
class Judgement:
    """A claim in one reading: its effects on the sets that were measured, and the names of the others."""

    claim: Claim
    effects: list[Effect]
    missing: list[str]

    @cached_property
    def used(self) -> list[Effect]:
        """The testable sets with an interval, or the only one; all where none is testable.

        A set of two units is left out beside others: their spread is often tiny by luck, and would rule the mean.
        """
        testable = [effect for effect in self.effects if effect.testable] or self.effects
        usable = [effect for effect in testable if np.isfinite(effect.interval[1])]
        usable = [effect for effect in usable if len(usable) == 1 or len(effect.units) > FEW] or usable
        return usable or testable[:1]

    @cached_property
    def pooled(self) -> Pooled | None:
        """The effect of several sets, by random effects."""
        if len(self.used) < 2:
            return None
        freedoms = [len(effect.units) - 1 for effect in self.used]
        halves = [(effect.interval[2] - effect.interval[1]) / 2 for effect in self.used]
        errors = [half / float(special.stdtrit(free, 0.975)) for half, free in zip(halves, freedoms, strict=True)]
        return pool([effect.interval[0] for effect in self.used], errors, freedoms)

    @property
    def interval(self) -> tuple[float, float, float]:
        """(mean, low, high), before the margin."""
        return self.pooled.interval() if self.pooled else self.used[0].interval

    @property
    def p_value(self) -> float:
        """Two-sided, of no effect; NaN with a margin, which it would ignore."""
        if self.claim.margin:
            return float("nan")
        return self.pooled.p_value if self.pooled else self.used[0].p_value

    @cached_property
    def word(self) -> str:
        """The verdict.

        A rival that is the best of several on the same rows leads by chance, too: it contradicts a claim only where its
        p-value times the number of rivals stays below 5 %.
        """
        if self.claim.says_nothing or not any(effect.testable for effect in self.effects):
            return NOT_TESTABLE
        if not self.claim.over:
            return SUPPORTED if self.interval[0] + self.claim.margin > 0 else CONTRADICTED
        word = verdict(*self.interval[1:], self.claim.unit, self.claim.margin, self.claim.same)
        return OPEN if word == CONTRADICTED and self.p_value * rivals(self.claim) > ALPHA else word

    @property
    def disagree(self) -> bool:
        """Whether each side of zero has a set whose own interval excludes it, or sets of both signs differ by Q."""
        if not self.pooled:
            return False
        means, low, high = np.transpose([effect.interval for effect in self.used])
        both_signs = means.min() < 0 < means.max()
        return bool((low > 0).any() and (high < 0).any()) or bool(both_signs and self.pooled.differ < ALPHA)


def verdict(low: float, high: float, unit: str = "", margin: float = 0.0, same: bool = False) -> str:
    """The word for an interval: whether it lies above -margin, or within the margin where the claim is `same`."""
    if same:
        inside, outside = max(-low, high) <= margin, low > margin or high < -margin
        return SUPPORTED if inside else CONTRADICTED if outside else OPEN
    if low > -margin:
        return SUPPORTED
    if high < -margin:
        return CONTRADICTED
    return NO_DIFFERENCE if not margin and max(-low, high) <= MARGINS.get(unit, -1.0) else OPEN


def size(printed: float | None, mean: float, low: float, high: float) -> str:
    """The measured effect beside the printed one: as printed, smaller, larger or opposite; empty without one.

    As printed is an interval that covers it; a single number, where its first three digits are the same.
    """
    if printed is None:
        return ""
    if np.isnan(low):
        low, high = (mean, mean) if f"{mean:.3g}" != f"{printed:.3g}" else (printed, printed)
    sign = -1 if printed < 0 else 1
    low, high = sorted((sign * low, sign * high))
    if low <= abs(printed) <= high:
        return "as printed"
    return "opposite" if high < 0 else "smaller" if high < abs(printed) else "larger"


def rivals(claim: Claim) -> int:
    """The number of named values from which a side is picked by its mean."""
    picks = (value for side in claim.sides() for value in side.values())
    return max([len(pick.names) for pick in picks if isinstance(pick, Pick)], default=1) or 1


def judgement(claim: Claim, measurements: Measurements) -> Judgement:
    """The claim as its fields say; Missing where no set was measured."""
    effects, missing = [], {}
    for name in claim.sets:
        try:
            pairs = STATISTICS[claim.statistic](measurements, claim, name)
            pairs.differences = pairs.differences.dropna()
            require_rows(pairs.differences, f"no pairs for {claim.key}")
        except Missing as error:
            missing[name] = error
            continue
        pairs.differences = (claim.scale * pairs.differences).map(lambda value: float(f"{value:.6g}"))  # as in a CSV
        effects.append(Effect(name, pairs, claim.share(name)))
    if not effects:
        raise next(iter(missing.values()))
    return Judgement(claim, effects, list(missing))


def readings(claim: Claim, measurements: Measurements) -> dict[str, Judgement]:
    """{name: judgement} of the claim's other readings, those that were run."""
    found = {}
    for reading in claim.readings:
        try:
            found[reading.name] = judgement(reading.of(claim), measurements)
        except Missing:
            continue
    return found


def judge_one(claim: Claim, measurements: Measurements) -> dict[str, Any]:
    """The row of a claim, as COLUMNS; one without measurements is open, and its caveat says why."""
    row = {"section": claim.section, "claim": claim.sentence, "unit": claim.unit, "printed": claim.printed}
    row |= {"key": claim.key, "pairs": 0, "units": 0}
    try:
        judged = judgement(claim, measurements)
    except Missing as absent:
        return row | {"verdict": OPEN, "caveat": f"not run: {str(absent).removeprefix('not run: ')}"}
    mean, low, high = judged.interval
    words = {name: reading.word for name, reading in readings(claim, measurements).items()}
    return row | {
        "verdict": judged.word, "effect": mean, "low": low, "high": high, "p": judged.p_value,
        "size": size(claim.printed_effect, mean, low, high), "readings": differing(judged.word, words),
        "caveat": "; ".join(caveats(judged)), "over": " and ".join(over_words(claim)),
        "pairs": sum(len(effect.pairs.differences) for effect in judged.used),
        "units": sum(len(effect.units) for effect in judged.used),
        "sets": ", ".join(dataset_text(effect.dataset) for effect in judged.used),
    }  # fmt: skip


def judge(claims: Sequence[Claim], measurements: Measurements) -> pd.DataFrame:
    """A frame with one row per claim; a decided one that many tests explain has a caveat.

    Within a chapter, by Benjamini and Hochberg, at a false discovery rate of 5 %.
    """
    frame = pd.DataFrame([judge_one(claim, measurements) for claim in claims], columns=COLUMNS)
    frame = frame.fillna(dict.fromkeys(TEXTS, ""))
    chapters = frame["section"].str.partition(".")[0]
    is_discovery = frame["p"].astype(float).groupby(chapters).transform(discoveries).astype(bool)
    weak = frame["verdict"].isin([SUPPORTED, CONTRADICTED]) & frame["p"].notna() & ~is_discovery
    frame.loc[weak, "caveat"] = [f"{text}; one of many tests".removeprefix("; ") for text in frame.loc[weak, "caveat"]]
    return frame


def differing(word: str, others: Mapping[str, str]) -> str:
    """`contradicted: 1,500 faces / SVM alone; open: four viewpoints`: the testable readings with another word."""
    by_word: dict[str, list[str]] = {}
    for name, other in others.items():
        if other not in (word, NOT_TESTABLE):
            by_word.setdefault(other, []).append(name)
    return "; ".join(f"{other}: {' / '.join(names)}" for other, names in by_word.items())


def caveats(judged: Judgement) -> list[str]:
    """The clauses on what limits a test: the claim's own, and what its rows show."""
    claim = judged.claim
    clauses = [clause for clause in (claim.says_nothing, claim.caveat) if clause]
    effects = judged.effects if judged.word == NOT_TESTABLE else judged.used
    silent = sum((effect.pairs.silent for effect in effects), Counter())
    if silent:
        count = sum(effect.pairs.count for effect in effects)
        clauses.append(f"{silent.total():,} of {count:,} pairs say nothing: {' or '.join(silent)}")
    ringless = np.nanmax([effect.pairs.ringless for effect in effects] + [0.0])
    if claim.stage == "lod" and ringless >= RINGLESS:
        clauses.append(f"{ringless:.0%} of the meshes keep less than one ring".replace("%", " %"))
    if judged.disagree:
        own = (f"{dataset_text(effect.dataset)} {number(effect.interval[0])}" for effect in judged.used)
        clauses.append(f"the sets disagree: {', '.join(own)}")
    if judged.missing:
        clauses.append(f"not measured on {', '.join(map(dataset_text, judged.missing))}")
    if claim.over and np.isnan(judged.interval[1]):
        clauses.append("no interval: fewer than two units, or all equal")
    return clauses


OVER = {"item": "objects", "group": "classes", "set": "sets of objects", "repetition": "splits", "task": "tasks"}


def over_words(claim: Claim) -> list[str]:
    """What the pairs of a claim are."""
    return [OVER.get(column, f"{column}s") for column in claim.over]
