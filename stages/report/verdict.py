"""Verdicts on claims: the word that the measured differences give each claim, and the number of claims per word.

An interval above 0 supports a claim, one below 0 contradicts it. An interval within NEGLIGIBLE shows no difference;
other intervals leave the claim open. Data sets that disagree make a claim mixed, and readings that
disagree make it depend on the reading. `holding` corrects for the claims of a chapter (Benjamini and Hochberg).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import pandas as pd

from stages.charts.datasets import dataset_text
from stages.charts.numbers import number
from stages.engine.measurements import Measurements, Missing, listed
from stages.engine.statistics import discoveries

from .claims import POINTS, Claim, Pick, Words
from .effects import Effect, PooledEffect, effect_of, effects

DECIDED = ("supported", "contradicted", "no difference")
MIXED, DEPENDS, UNTESTABLE = "mixed", "depends on the reading", "not testable"
WORDS = (*DECIDED, MIXED, DEPENDS, UNTESTABLE, "open")
# By unit: what nobody would act on. Stated before the claims were judged by it; other units have none.
NEGLIGIBLE = {POINTS: 3.0, "% of the mean of both errors": 3.0, "PCC": 0.03, "NSS": 0.05, "AUC": 0.01}
ALPHA = 0.05  # of a p-value
PROPOSED = "T6.3"  # the section that proposes future work, and states no result
WORDING = Words()
WRITTEN = "as written"  # the name of the reading that a claim itself is
COLUMNS = [
    "section", "claim", "verdict", "effect", "low", "high", "unit", "p", "holds", "pairs", "over", "units", "shared",
    "i2", "by_set", "readings", "validity", "tested_on", "of", "key",
]  # fmt: skip
TEXTS = ["by_set", "readings", "validity"]  # columns that are empty where there is nothing to say
Row = tuple[Mapping[str, object], list[tuple[str, str, float, bool]]]  # (columns of a claim, the differences behind it)


def verdict(low: float, high: float, unit: str = "") -> str:
    """The word: supported when the interval lies above 0 (the claimed side), contradicted when it lies below.

    An interval that covers 0 and no effect that matters (NEGLIGIBLE) shows no difference; else the claim is open.
    Before any of these comes *mixed*, of several sets (`PooledEffect.disagree`).
    """
    if low > 0:
        return "supported"
    if high < 0:
        return "contradicted"
    return "no difference" if max(-low, high) <= NEGLIGIBLE.get(unit, -1.0) else "open"


def judge(claims: Sequence[Claim], results: Measurements) -> pd.DataFrame:
    """A frame with one row per claim: effect with its interval and the word; unmeasured ones are open and say why."""
    return judged(claims, results)[0]


def judged(claims: Sequence[Claim], results: Measurements) -> tuple[pd.DataFrame, pd.DataFrame]:
    """(the frame of `judge`, the differences behind it: columns key, pair, difference in the claim's unit, judged).

    A verdict follows from the differences, `shared` and the readings. The pairs of a claim on several sets begin with
    the set; `judged` tells those of the sets that give the numbers. Where the claim as it is written cannot be tested,
    its first reading that can be gives the numbers.
    """
    return tabled(by_claim(claims, results))


def by_claim(claims: Sequence[Claim], results: Measurements) -> list[Row]:
    """The row of each claim with its differences."""
    return [judge_one(claim, results) for claim in claims]


def tabled(rows: Sequence[Row]) -> tuple[pd.DataFrame, pd.DataFrame]:
    """The frames of `judged` from the rows of `by_claim`: adds the column that depends on other claims."""
    frame = pd.DataFrame([columns for columns, _ in rows], columns=COLUMNS).fillna(dict.fromkeys(TEXTS, ""))
    frame["holds"] = holding(frame)
    pairs = [pair for _, differences in rows for pair in differences]
    return frame, pd.DataFrame(pairs, columns=["key", "pair", "difference", "judged"])


def judge_one(claim: Claim, results: Measurements) -> Row:
    """The row of a claim with its differences; a claim without measurements has the reason and no differences."""
    row = {"section": claim.section, "claim": claim.sentence, "unit": claim.unit, "of": claim.of, "key": claim.key}
    try:
        judgements, not_run = _judgements(claim, results)
    except Missing as absent:
        reason = str(absent).removeprefix("not run: ")  # a note of a stage may say so, too
        unmeasured = {"pairs": 0, "units": 0, "over": "", "tested_on": f"not run: {reason}"}
        return row | unmeasured | {"verdict": "open"}, []
    judgement = next((entry for entry in judgements if entry.word != UNTESTABLE), judgements[0])
    pairs = []
    for effect in judgement.set_effects:
        start = f"{effect.dataset}/" if len(judgement.claim.sets) > 1 else ""
        pair_names = (start + "/".join(map(str, listed(pair))) for pair in effect.differences.index)
        decides = any(effect is entry for entry in judgement.used)
        pairs += ((claim.key, name, value, decides) for name, value in zip(pair_names, effect.differences, strict=True))
    row |= _numbers(judgement) | _words(judgement, judgements[0])
    return row | _readings(judgement, judgements, not_run), pairs


@dataclass(frozen=True)
class Judgement:
    """A claim in one reading: its effects on the sets that were measured, the other sets, and the word."""

    name: str
    claim: Claim
    set_effects: list[Effect]
    missing: list[str]
    literal: bool = False

    @cached_property
    def word(self) -> str:
        """The word that the sets come to.

        A rival that is the best of several on the same rows leads by chance, too: it contradicts a claim only where its
        p-value times the number of rivals stays below 5 %.
        """
        word = word_of(self.set_effects, self.claim.unit)
        rivals = picked_from(self.claim)
        return "open" if word == "contradicted" and self.effect.p_value * rivals > ALPHA else word

    @cached_property
    def effect(self) -> Effect | PooledEffect:
        """The effect on all sets."""
        return effect_of(self.set_effects)

    @cached_property
    def used(self) -> Sequence[Effect]:
        """The effects of the sets that the numbers come from."""
        effect = self.effect
        return effect.sets if isinstance(effect, PooledEffect) else [effect]


def _judgements(claim: Claim, results: Measurements) -> tuple[list[Judgement], list[str]]:
    """(the claim as it is written, then in its other readings with an interval; the other readings, and why).

    Raises Missing where no reading was run.
    """
    judgements, errors, not_run = [], [], []
    others = [(reading.name, reading.of(claim), reading.literal) for reading in claim.readings]
    for name, variant, literal in [(WRITTEN, claim, False), *others]:
        try:
            set_effects, missing = effects(variant, results)
        except Missing as error:
            errors.append(error)
            not_run.append(f"{name}: not run")
            continue
        judgement = Judgement(name, variant, set_effects, missing, literal)
        if variant is claim or np.isfinite(judgement.effect.interval[1]):
            judgements.append(judgement)
        else:
            not_run.append(f"{name}: {_without_interval(judgement)}")
    if not judgements:
        raise errors[0]
    return judgements, not_run


def picked_from(claim: Claim) -> int:
    """The number of named values from which the second side, or a first side of errors, is picked by its mean."""
    picks = (value for side in (claim.first, claim.second) if isinstance(side, Mapping) for value in side.values())
    return max([len(pick.names) for pick in picks if isinstance(pick, Pick)], default=1) or 1


def _without_interval(judgement: Judgement) -> str:
    """`not testable, 2 of 3 pairs invalid: ...` of a reading that was run."""
    if reasons := [effect.validity for effect in judgement.set_effects if effect.validity]:
        return f"{UNTESTABLE}, {'; '.join(reasons)}"
    return f"{UNTESTABLE}, no interval"


def word_of(effects: Sequence[Effect], unit: str) -> str:
    """The word that the effects on one set or several come to."""
    if not any(single.testable for single in effects):
        return UNTESTABLE
    effect = effect_of(effects)
    if isinstance(effect, PooledEffect) and effect.disagree:
        return MIXED
    return verdict(*effect.interval[1:], unit)


def over_readings(words: Sequence[str], literal: str = UNTESTABLE) -> str:
    """The word of a claim from those of its readings: the first that can be tested, unless readings contradict.

    A reading in which the data sets disagree contradicts a decided word, too. An open word depends on the reading where
    one reading supports the claim and another contradicts it. literal: the word of the literal reading
    (`stages.report.claims.Reading`); a claim that this reading alone supports, contradicts or leaves open depends on
    the reading.
    """
    words = [word for word in words if word != UNTESTABLE] or [UNTESTABLE]
    opposed = {"supported", "contradicted"} <= {*words}
    differs = words[0] in DECIDED and {*words} & {*DECIDED, MIXED} != {words[0]}
    alone = "open" in (words[0], literal) and {words[0], literal} & {"supported", "contradicted"}
    return DEPENDS if opposed or differs or alone else words[0]


def _readings(judged_one: Judgement, judgements: Sequence[Judgement], not_run: Sequence[str]) -> dict[str, str]:
    """Columns verdict and readings: the word and the effect in each reading, the judged one first; those not run."""
    if len(judgements) == 1 and judged_one.name == WRITTEN and not not_run:
        return {}
    ordered = sorted(judgements, key=lambda reading: reading is not judged_one)
    texts = [f"{reading.name}: {reading.word} {_interval_text(reading.effect)}" for reading in ordered]
    texts += not_run
    words, written = [reading.word for reading in judgements], judgements[0]
    if written is not judged_one and any(len(effect.refused) < effect.pairs for effect in written.used):
        # Its valid pairs count as a reading.
        words.append(verdict(*written.effect.interval[1:], written.claim.unit))
    literal = next((reading.word for reading in judgements if reading.literal), UNTESTABLE)
    return {"verdict": over_readings(words, literal), "readings": "; ".join(texts)}


def _numbers(judgement: Judgement) -> dict[str, object]:
    """The word with its numbers."""
    effect, word, claim = judgement.effect, judgement.word, judgement.claim
    mean, low, high = effect.interval
    pooled = isinstance(effect, PooledEffect)
    columns: dict[str, object] = {"verdict": word, "effect": mean, "low": low, "high": high}
    over = " and ".join(map(WORDING.over, claim.over))
    columns |= {"p": effect.p_value, "over": over}
    columns |= {"units": len(effect.units), "shared": np.nan if pooled else effect.share}
    columns |= {"pairs": sum(len(single.differences) for single in judgement.used)}
    return columns | ({"i2": effect.pooled.i2} if pooled else {})


def _words(judgement: Judgement, written: Judgement) -> dict[str, str]:
    """Columns tested_on, by_set and validity; written: the first of the claim's readings that were run."""
    set_effects, missing = judgement.set_effects, judgement.missing
    words = WORDING.tested_on(judgement.claim, [effect.dataset for effect in judgement.used])
    words += f"; not measured on {', '.join(map(dataset_text, missing))}" if missing else ""
    invalid_sets = _invalid_sets(judgement)
    if judgement.name != WRITTEN:
        was_run = written.name == WRITTEN
        words += (
            f"; in the reading {judgement.name}, since as written it {'cannot be tested' if was_run else 'was not run'}"
        )
        invalid_sets += [f"{WRITTEN}, {text}" for text in _invalid_sets(written) if was_run]
    for effect in set_effects:
        if np.isnan(effect.interval[1]):
            count = len(effect.differences)
            reason = f"all {count} differences are equal" if count > 1 else "fewer than two differences"
            words += f"; no interval{f' of {dataset_text(effect.dataset)}' if len(set_effects) > 1 else ''}: {reason}"
    return {
        "tested_on": words, "validity": "; ".join(invalid_sets),
        "by_set": "; ".join(map(_set_text, set_effects)) if len(set_effects) > 1 else "",
    }  # fmt: skip


def _invalid_sets(judgement: Judgement) -> list[str]:
    return [f"{dataset_text(effect.dataset)}: {effect.validity}" for effect in judgement.set_effects if effect.validity]


def _interval_text(effect: Effect | PooledEffect) -> str:
    mean, low, high = map(number, effect.interval)
    return f"{'+' if effect.interval[0] > 0 else ''}{mean} [{low}, {high}]"


def _set_text(effect: Effect) -> str:
    """`psb +3.1 [1.0, 5.2] (38)`: a set's own effect, and its units."""
    note = "" if effect.testable else ", not testable"
    return f"{dataset_text(effect.dataset)} {_interval_text(effect)} ({len(effect.units)}{note})"


def holding(frame: pd.DataFrame) -> pd.Series:
    """ "yes" or "no" of verdicts that are decided: whether they hold among the claims of their chapter; else empty.

    By Benjamini and Hochberg, at a false discovery rate of 5 %. A chapter is `T3`, say; ours is one by itself.
    """
    chapters = frame["section"].str.partition(".")[0]
    is_discovery = frame["p"].astype(float).groupby(chapters).transform(discoveries)
    return is_discovery.map({True: "yes", False: "no"}).where(frame["verdict"].isin(["supported", "contradicted"]), "")


def counts(claims: pd.DataFrame) -> dict[str, int]:
    """{word: how many there are of it} in a frame of `judge`."""
    return {word: list(claims["verdict"]).count(word) for word in WORDS}


def sentences(claims: pd.DataFrame) -> pd.DataFrame:
    """A row a sentence: section, claim, verdict and pairs of its primary claim; other claims ask whether it carries."""
    primary = claims["of"].eq("")
    return claims.loc[primary, ["section", "claim", "verdict", "pairs"]].reset_index(drop=True)


def of_thesis(claims: pd.DataFrame) -> pd.DataFrame:
    """The sentences that the thesis states as results: neither the proposals of PROPOSED nor this project's own."""
    frame = sentences(claims)
    return frame[~frame["section"].isin(["ours", PROPOSED])]


def counted(claims: pd.DataFrame) -> str:
    """On a frame of `judge`: how many verdicts there are of each word, how many of them hold, how many sentences."""
    decided = claims["holds"].isin(["yes", "no"]).sum()
    frame, thesis = sentences(claims), of_thesis(claims)
    ours, proposals = (frame[frame["section"] == section] for section in ("ours", PROPOSED))
    return (
        f"Sentences of the thesis ({len(thesis)}): {_counts(thesis)}. "
        f"Its proposals for future work ({PROPOSED}, {len(proposals)}): {_counts(proposals)}. "
        f"Sentences of this project ({len(ours)}): {_counts(ours)}. "
        f"Verdicts, with {len(claims) - len(frame)} that test a sentence elsewhere ({len(claims)}): {_counts(claims)}. "
        f"Of the {decided} that are supported or contradicted, {(claims['holds'] == 'yes').sum()} hold among the "
        "claims of their chapter, at a false discovery rate of 5 %."
    )


def _counts(frame: pd.DataFrame) -> str:
    return ", ".join(f"{count} {word}" for word, count in counts(frame).items() if count) or "none"


def over_text(row: Any) -> str:
    """`50 objects, 40 units`: the pairs, and how many units they are of where these are fewer."""
    return f"{row.pairs} {row.over}" + (f", {row.units} units" if row.units != row.pairs else "")


def sets_text(row: Any) -> str:
    """The effect on each set, and the share of their variation that is between them; empty for one set."""
    shown = row.by_set and row.i2 == row.i2
    return row.by_set + (f"; {100 * row.i2:.0f} % of the variation between sets" if shown else "")
