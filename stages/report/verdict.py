"""The one word that a measurement says to each claim, with the differences that it rests on."""

from collections.abc import Iterable

import numpy as np
import pandas as pd

from stages.kit.stats import interval

from .claims import Claim
from .differences import differences, rounded
from .results import NotRun, Results
from .words import tested_on

BY_CHANCE = 0.025  # how often a 95 % interval lies wholly on one side of zero where the truth is zero
WORDS = ("supported", "contradicted", "open")
COLUMNS = [
    "section", "claim", "verdict", "effect", "low", "high", "unit", "pairs", "over", "shared", "tested_on", "key",
]  # fmt: skip


def verdict(low: float, high: float) -> str:
    """The word: supported when the interval lies above 0 (the claimed side), contradicted below, else open."""
    if low > 0:
        return "supported"
    return "contradicted" if high < 0 else "open"


def counted(claims: pd.DataFrame) -> str:
    """Two sentences on a frame of `judge`: how many there are of each word, and how many chance alone would give."""
    words = {word: list(claims["verdict"]).count(word) for word in WORDS}
    judged = np.isfinite(claims["low"].to_numpy(dtype=float)).sum()
    return (
        f"{len(claims)} verdicts: {', '.join(f'{count} {word}' for word, count in words.items())}. Were there no "
        f"effect in any of the {judged} that have an interval, chance alone would call about {BY_CHANCE * judged:.0f} "
        f"of them supported and as many contradicted: {100 * BY_CHANCE:g} % each."
    )


def judge(claims: Iterable[Claim], results: Results) -> pd.DataFrame:
    """A frame with one row per claim: effect with its interval and the word; unmeasured ones are open and say why."""
    return judged(claims, results)[0]


def judged(claims: Iterable[Claim], results: Results) -> tuple[pd.DataFrame, pd.DataFrame]:
    """(the frame of `judge`, the differences behind it: columns key, pair, difference in the claim's unit).

    A verdict follows from its differences and `shared` alone: `verdict(*interval(differences, shared)[1:])`.
    """
    rows, pairs = [], []
    for claim in claims:
        row, found = _row(claim, results)
        rows.append(row)
        names = ["/".join(map(str, one)) if isinstance(one, tuple) else str(one) for one in found.index]
        pairs.append(pd.DataFrame({"key": claim.key, "pair": names, "difference": found.to_numpy()}))
    empty = pd.DataFrame({"key": [], "pair": [], "difference": []})
    return pd.DataFrame(rows, columns=COLUMNS), pd.concat(pairs, ignore_index=True) if pairs else empty


def _row(claim: Claim, results: Results) -> tuple[dict, pd.Series]:
    said = {"section": claim.section, "claim": claim.sentence, "unit": claim.unit, "key": claim.key}
    try:
        found, words = differences(results, claim), tested_on(claim, results)
    except NotRun as missing:
        said |= {"verdict": "open", "pairs": 0, "over": "", "tested_on": f"not run: {missing}"}
        return said, pd.Series(dtype=float)
    found = pd.Series(rounded(found), index=found.index)
    mean, low, high = interval(found, claim.share)
    numbers = {"verdict": verdict(low, high), "effect": mean, "low": low, "high": high}
    numbers |= {"pairs": len(found), "over": claim.pairs, "shared": claim.share}
    return said | numbers | {"tested_on": words + _unknown(low, len(found))}, found


def _unknown(low: float, pairs: int) -> str:
    """Why there is no interval, where there is none."""
    if low == low:
        return ""
    return "; no interval: " + (f"all {pairs} differences are equal" if pairs > 1 else "fewer than two differences")
