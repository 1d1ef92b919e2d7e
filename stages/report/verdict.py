"""The one word that a measurement says to each claim, with the differences that it rests on."""

from collections.abc import Iterable

import numpy as np
import pandas as pd

from stages.kit.stats import discoveries

from .claims import POINTS, Claim
from .effects import Effect, PooledEffect, effect_of, effects
from .markdown import number
from .results import NotRun, Results, listed
from .words import dataset_text, tested_on

WORDS = ("supported", "contradicted", "no difference", "mixed", "open")
# By unit: what nobody would act on. Stated before the claims were judged by it; other units have none.
NEGLIGIBLE = {POINTS: 3.0, "% of the mean of both errors": 3.0, "PCC": 0.03, "NSS": 0.05, "AUC": 0.01}
FEW, HUNDRED = 5, 100  # units
CAUSES = (  # of open verdicts
    "not run", "no spread", f"{FEW} units or fewer a set", f"fewer than {HUNDRED} units needed",
    f"{HUNDRED} units or more needed", "more splits of the same data would not decide", "hardly an effect",
)  # fmt: skip
COLUMNS = [
    "section", "claim", "verdict", "effect", "low", "high", "unit", "p", "holds", "pairs", "over", "units", "shared",
    "i2", "by_set", "needed", "needed_of", "cause", "tested_on", "key",
]  # fmt: skip


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


def judge(claims: Iterable[Claim], results: Results) -> pd.DataFrame:
    """A frame with one row per claim: effect with its interval and the word; unmeasured ones are open and say why."""
    return judged(claims, results)[0]


def judged(claims: Iterable[Claim], results: Results) -> tuple[pd.DataFrame, pd.DataFrame]:
    """(the frame of `judge`, the differences behind it: columns key, pair, difference in the claim's unit).

    A verdict follows from its differences and `shared` alone. The pairs of a claim on several sets begin with the set.
    """
    rows, pairs = [], []
    for claim in claims:
        said = {"section": claim.section, "claim": claim.sentence, "unit": claim.unit, "key": claim.key}
        try:
            found, missing = effects(claim, results)
        except NotRun as absent:
            unmeasured = {"pairs": 0, "units": 0, "over": "", "tested_on": f"not run: {absent}", "cause": CAUSES[0]}
            rows.append(said | unmeasured | {"verdict": "open"})
            continue
        effect = effect_of(found)
        words = _words(claim, results, found, [] if results.own_meshes else missing)
        rows.append(said | _numbers(claim, effect) | words | {"pairs": sum(len(one.differences) for one in found)})
        for one in found:
            start = f"{one.dataset}/" if len(claim.sets) > 1 else ""
            named = (start + "/".join(map(str, listed(pair))) for pair in one.differences.index)
            pairs += zip([claim.key] * len(one.differences), named, one.differences, strict=False)
    frame = pd.DataFrame(rows, columns=COLUMNS)
    frame["holds"] = holding(frame)
    return frame, pd.DataFrame(pairs, columns=["key", "pair", "difference"])


def _numbers(claim: Claim, effect: Effect | PooledEffect) -> dict[str, object]:
    """The word with its numbers, and where it is open what would decide it."""
    mean, low, high = effect.interval
    pooled = isinstance(effect, PooledEffect)
    word = "mixed" if pooled and effect.disagree else verdict(low, high, claim.unit)
    found = {"verdict": word, "effect": mean, "low": low, "high": high, "p": effect.p_value, "over": claim.pairs}
    found |= {"units": len(effect.units), "shared": np.nan if pooled else effect.share}
    found |= {"i2": effect.pooled.i2} if pooled else {}
    return found | _open(claim, effect) if word == "open" else found


def _open(claim: Claim, effect: Effect | PooledEffect) -> dict[str, object]:
    """Columns needed, needed_of and cause: of how many units the present effect and spread would be decided.

    Decided is what excludes zero, or shows no difference.
    """
    mean, low, _ = effect.interval
    if np.isnan(low):
        return {"cause": CAUSES[1]}
    count = effect.needs(max(abs(mean), NEGLIGIBLE.get(claim.unit, 0.0) - abs(mean)))
    split = isinstance(effect, Effect) and effect.share > 0
    rank = 2 if effect.most <= FEW else 3 if count < HUNDRED else 4 if np.isfinite(count) else 5 if split else 6
    sets = isinstance(effect, PooledEffect) and effect.pooled.between > 0
    known = {"needed": count, "needed_of": "data sets" if sets else claim.units} if np.isfinite(count) else {}
    return {"cause": CAUSES[rank], **known}


def _words(claim: Claim, results: Results, found: list[Effect], missing: list[str]) -> dict[str, str]:
    """Columns tested_on and by_set."""
    words = tested_on(claim, results, [one.dataset for one in found])
    words += f"; not measured on {', '.join(map(dataset_text, missing))}" if missing else ""
    for one in found:
        if np.isnan(one.interval[1]):
            count = len(one.differences)
            why = f"all {count} differences are equal" if count > 1 else "fewer than two differences"
            words += f"; no interval{f' of {dataset_text(one.dataset)}' if len(found) > 1 else ''}: {why}"
    return {"tested_on": words, "by_set": "; ".join(map(_set_text, found)) if len(found) > 1 else ""}


def _set_text(effect: Effect) -> str:
    """`psb +3.1 [1.0, 5.2] (38)`: a set's own effect, and its units."""
    mean, low, high = map(number, effect.interval)
    return f"{dataset_text(effect.dataset)} {'+' if effect.interval[0] > 0 else ''}{mean} [{low}, {high}] " + (
        f"({len(effect.units)})"
    )


def holding(frame: pd.DataFrame) -> pd.Series:
    """ "yes" or "no" of verdicts that are decided: whether they hold among the claims of their chapter; else empty.

    By Benjamini and Hochberg, at a false discovery rate of 5 %. A chapter is `T3`, say; ours is one by itself.
    """
    chapters = frame["section"].str.partition(".")[0]
    held = frame["p"].astype(float).groupby(chapters).transform(discoveries)
    return held.map({True: "yes", False: "no"}).where(frame["verdict"].isin(["supported", "contradicted"]), "")
