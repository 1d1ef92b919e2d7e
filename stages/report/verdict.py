"""Verdicts on claims: the word that the measured differences give each claim, and the number of claims per word.

An interval above 0 supports a claim, one below 0 contradicts it. An interval within NEGLIGIBLE shows no difference;
other intervals leave the claim open, with one of CAUSES. Data sets that disagree make a claim mixed, and readings that
disagree make it depend on the reading. `holding` corrects for the claims of a chapter (Benjamini and Hochberg).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import pandas as pd

from stages.charts.datasets import dataset_text
from stages.charts.results import NotRun, Results, listed
from stages.charts.tables import number
from stages.engine.statistics import discoveries

from .claims import POINTS, Claim, Pick, tested_on
from .effects import Effect, PooledEffect, deciding, effect_of, effects

DECIDED = ("supported", "contradicted", "no difference")
MIXED, DEPENDS, UNTESTABLE = "mixed", "depends on the reading", "not testable"
WORDS = (*DECIDED, MIXED, DEPENDS, UNTESTABLE, "open")
# By unit: what nobody would act on. Stated before the claims were judged by it; other units have none.
NEGLIGIBLE = {POINTS: 3.0, "% of the mean of both errors": 3.0, "PCC": 0.03, "NSS": 0.05, "AUC": 0.01}
ALPHA = 0.05  # of a p-value
FEW, HUNDRED = 5, 100  # units
PROPOSED = "T6.3"  # the section that proposes future work, and states no result
WRITTEN = "as written"  # the name of the reading that a claim itself is
CAUSES = (  # of open verdicts
    "not run", "no spread", f"{FEW} units or fewer a set", f"fewer than {HUNDRED} units needed",
    f"{HUNDRED} units or more needed", "more splits of the same data would not decide", "hardly an effect",
)  # fmt: skip
COLUMNS = [
    "section", "claim", "verdict", "effect", "low", "high", "unit", "p", "holds", "pairs", "over", "units", "shared",
    "i2", "by_set", "carries", "readings", "validity", "needed", "needed_of", "cause", "tested_on", "of", "key",
]  # fmt: skip
TEXTS = ["by_set", "carries", "readings", "validity", "cause"]  # columns that are empty where there is nothing to say
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


def judge(claims: Sequence[Claim], results: Results) -> pd.DataFrame:
    """A frame with one row per claim: effect with its interval and the word; unmeasured ones are open and say why."""
    return judged(claims, results)[0]


def judged(claims: Sequence[Claim], results: Results) -> tuple[pd.DataFrame, pd.DataFrame]:
    """(the frame of `judge`, the differences behind it: columns key, pair, difference in the claim's unit, judged).

    A verdict follows from the differences on the sets as printed, `shared` and the readings. The pairs of a claim on
    several sets begin with the set; `judged` tells those of the sets that give the verdict. Where the claim as it is
    written cannot be tested, its first reading that can be gives the numbers. Column `of`: the key of the primary
    claim, empty for a primary claim itself.
    """
    return tabled(claims, by_claim(claims, results))


def by_claim(claims: Sequence[Claim], results: Results) -> list[Row]:
    """The row of each claim with its differences; a claim without measurements has the reason and no differences."""
    return [_row(claim, results) for claim in claims]


def tabled(claims: Sequence[Claim], rows: Sequence[Row]) -> tuple[pd.DataFrame, pd.DataFrame]:
    """The frames of `judged` from the rows of `by_claim`: adds the columns that depend on other claims."""
    first: dict[tuple[bool, str], str] = {}
    primaries = [claim.of or first.setdefault((claim.is_ours, claim.sentence), claim.key) for claim in claims]
    frame = pd.DataFrame([columns for columns, _ in rows], columns=COLUMNS).fillna(dict.fromkeys(TEXTS, ""))
    frame["of"] = [key if key != claim.key else "" for key, claim in zip(primaries, claims, strict=True)]
    frame["holds"] = holding(frame)
    pairs = [pair for _, differences in rows for pair in differences]
    return frame, pd.DataFrame(pairs, columns=["key", "pair", "difference", "judged"])


def _row(claim: Claim, results: Results) -> Row:
    row = {"section": claim.section, "claim": claim.sentence, "unit": claim.unit, "key": claim.key}
    try:
        judgements, not_run = _judgements(claim, results)
    except NotRun as absent:
        reason = str(absent).removeprefix("not run: ")  # a note of a stage may say so, too
        unmeasured = {"pairs": 0, "units": 0, "over": "", "tested_on": f"not run: {reason}", "cause": CAUSES[0]}
        return row | unmeasured | {"verdict": "open"}, []
    judgement = next((entry for entry in judgements if entry.word != UNTESTABLE), judgements[0])
    if judgement.claim is not claim:  # a reading, so far on the judged sets alone
        complete = judgement.everywhere(results)
        judgements = [complete if entry is judgement else entry for entry in judgements]
        judgement = complete
    pairs = []
    for effect in judgement.set_effects:
        start = f"{effect.dataset}/" if len(claim.sets) > 1 else ""
        pair_names = (start + "/".join(map(str, listed(pair))) for pair in effect.differences.index)
        decides = any(effect is entry for entry in judgement.used)
        pairs += ((claim.key, name, value, decides) for name, value in zip(pair_names, effect.differences, strict=True))
    row |= _numbers(judgement) | _words(judgement, judgements[0], results)
    row |= _readings(judgement, judgements, not_run)
    return row | (_open(judgement.claim, judgement.effect) if row["verdict"] == "open" else {}), pairs


@dataclass(frozen=True)
class Judgement:
    """A claim in one reading: its effects on all sets, on the sets that are judged, and the word.

    A reading other than the claim as it is written has only the effects on the judged sets, which its word needs.
    """

    name: str
    claim: Claim
    set_effects: list[Effect]
    missing: list[str]
    chosen: list[Effect]
    literal: bool = False

    @cached_property
    def word(self) -> str:
        """The word that the judged sets come to.

        A rival that is the best of several on the same rows leads by chance, too: it contradicts a claim only where its
        p-value times the number of rivals stays below 5 %.
        """
        word = word_of(self.chosen, self.claim.unit, self.claim.fixed)
        rivals = picked_from(self.claim)
        return "open" if word == "contradicted" and self.effect.p_value * rivals > ALPHA else word

    @cached_property
    def effect(self) -> Effect | PooledEffect:
        """The effect on the judged sets."""
        return effect_of(self.chosen, self.claim.fixed)

    def everywhere(self, results: Results) -> "Judgement":
        """The reading with its effects on all sets."""
        set_effects, missing = effects(self.claim, results)
        return replace(self, set_effects=set_effects, missing=missing,
                       chosen=deciding(self.claim, set_effects, results, strict=True))  # fmt: skip

    @cached_property
    def used(self) -> Sequence[Effect]:
        """The effects of the judged sets that the numbers come from."""
        effect = self.effect
        return effect.sets if isinstance(effect, PooledEffect) else [effect]


def _judgements(claim: Claim, results: Results) -> tuple[list[Judgement], list[str]]:
    """(the claim as it is written, then in its other readings with an interval; the other readings, and why).

    A reading on data sets of its own was run where the first of them was. Raises NotRun where no reading was run.
    """
    judgements, errors, not_run = [], [], []
    others = [(reading.name, reading.of(claim), reading.literal) for reading in claim.readings]
    for name, variant, literal in [(WRITTEN, claim, False), *others]:
        try:
            set_effects, missing = effects(variant, results, judged_sets=variant is not claim)
        except NotRun as error:
            errors.append(error)
            not_run.append(f"{name}: not run")
            continue
        selection = deciding(variant, set_effects, results, strict=variant is not claim)
        judgement = Judgement(name, variant, set_effects, missing, selection, literal)
        if variant is claim or (selection and np.isfinite(judgement.effect.interval[1])):
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
    """`not testable, 2 of 3 pairs invalid: ...` of a reading that was run; `not run` where no set of it was judged."""
    if not judgement.chosen:
        return "not run"
    if reasons := [effect.validity for effect in judgement.chosen if effect.validity]:
        return f"{UNTESTABLE}, {'; '.join(reasons)}"
    return f"{UNTESTABLE}, no interval"


def word_of(effects: Sequence[Effect], unit: str, fixed: bool = False) -> str:
    """The word that the effects on one set or several come to."""
    if not any(single.testable for single in effects):
        return UNTESTABLE
    effect = effect_of(effects, fixed)
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
    columns |= {"p": effect.p_value, "over": claim.pairs}
    columns |= {"units": len(effect.units), "shared": np.nan if pooled else effect.share}
    columns |= {"pairs": sum(len(single.differences) for single in judgement.used)}
    return columns | ({"i2": effect.pooled.i2} if pooled else {})


def _open(claim: Claim, effect: Effect | PooledEffect) -> dict[str, object]:
    """Columns needed, needed_of and cause of an open claim: the number of units that would decide it at its present
    effect and spread.

    A claim is decided if its interval excludes zero, or shows no difference.
    """
    mean, low, _ = effect.interval
    if np.isnan(low):
        return {"cause": CAUSES[1]}
    count = effect.needs(max(abs(mean), NEGLIGIBLE.get(claim.unit, 0.0) - abs(mean)))
    split = isinstance(effect, Effect) and effect.share > 0
    rank = 2 if effect.most <= FEW else 3 if count < HUNDRED else 4 if np.isfinite(count) else 5 if split else 6
    sets = isinstance(effect, PooledEffect) and effect.pooled.between > 0
    need_columns = {"needed": count, "needed_of": "data sets" if sets else claim.units} if np.isfinite(count) else {}
    return {"cause": CAUSES[rank], **need_columns}


def _words(judgement: Judgement, written: Judgement, results: Results) -> dict[str, str]:
    """Columns tested_on, by_set, carries and validity; written: the first of the claim's readings that were run."""
    claim, set_effects, selection = judgement.claim, judgement.set_effects, judgement.chosen
    missing = [] if results.own_meshes else judgement.missing
    words = tested_on(claim, results, [effect.dataset for effect in judgement.used])
    words += f"; not measured on {', '.join(map(dataset_text, missing))}" if missing else ""
    invalid_sets = _invalid_sets(judgement)
    if judgement.name != WRITTEN:
        was_run = written.name == WRITTEN
        words += (
            f"; in the reading {judgement.name}, since as written it {'cannot be tested' if was_run else 'was not run'}"
        )
        invalid_sets += [f"{WRITTEN}, {text}" for text in _invalid_sets(written) if was_run]
    for effect in selection:
        if np.isnan(effect.interval[1]):
            count = len(effect.differences)
            reason = f"all {count} differences are equal" if count > 1 else "fewer than two differences"
            words += f"; no interval{f' of {dataset_text(effect.dataset)}' if len(set_effects) > 1 else ''}: {reason}"
    return {
        "tested_on": words, "validity": "; ".join(invalid_sets), "carries": _carries(claim, selection, set_effects),
        "by_set": "; ".join(map(_set_text, set_effects)) if len(set_effects) > 1 else "",
    }  # fmt: skip


def _invalid_sets(judgement: Judgement) -> list[str]:
    return [f"{dataset_text(effect.dataset)}: {effect.validity}" for effect in judgement.set_effects if effect.validity]


def _carries(claim: Claim, chosen: Sequence[Effect], measured: Sequence[Effect]) -> str:
    """`supported +1.2 [0.4, 2.0]`: the word and the pooled effect of all sets.

    Empty where all sets were judged, unless the pooled effect is open and each set by itself is decided the same way.
    """
    effect, word = effect_of(measured), word_of(measured, claim.unit)
    if not isinstance(effect, PooledEffect):
        return ""
    alike = word == "open" and effect.in_each
    if len(measured) == len(chosen) and not alike:
        return ""
    word += f", {verdict(*effect.sets[0].interval[1:])} in each set" if alike else ""
    return f"{word} {_interval_text(effect)}"


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
    return _tally(claims["verdict"])


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


def open_by_cause(claims: pd.DataFrame) -> str:
    """A sentence: of the open verdicts, how many there are of each of CAUSES."""
    tally = _tally(claims.loc[claims["verdict"] == "open", "cause"], CAUSES)
    return f"Open verdicts by cause: {', '.join(f'{cause} {count}' for cause, count in tally.items() if count)}."


def _counts(frame: pd.DataFrame) -> str:
    return ", ".join(f"{count} {word}" for word, count in counts(frame).items() if count) or "none"


def _tally(column: pd.Series, words: tuple[str, ...] = WORDS) -> dict[str, int]:
    return {word: list(column).count(word) for word in words}
