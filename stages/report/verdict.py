"""The one word that a measurement says to each claim, with the differences that it rests on."""

from collections.abc import Iterable

import numpy as np
import pandas as pd

from stages.kit.stats import interval

from .claims import Claim
from .differences import differences
from .results import NotRun, Results, listed
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


def counts(claims: pd.DataFrame) -> dict[str, int]:
    """{word: how many there are of it} in a frame of `judge`."""
    return {word: list(claims["verdict"]).count(word) for word in WORDS}


def counted(claims: pd.DataFrame) -> str:
    """Two sentences on a frame of `judge`: how many there are of each word, and how many chance alone would give."""
    judged = np.isfinite(claims["low"].to_numpy(dtype=float)).sum()
    return (
        f"{len(claims)} verdicts: {', '.join(f'{count} {word}' for word, count in counts(claims).items())}. Were there "
        f"no effect in any of the {judged} that have an interval, chance alone would call about "
        f"{BY_CHANCE * judged:.0f} of them supported and as many contradicted: {100 * BY_CHANCE:g} % each."
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
        said = {"section": claim.section, "claim": claim.sentence, "unit": claim.unit, "key": claim.key}
        try:
            found, words = differences(results, claim), tested_on(claim, results)
        except NotRun as missing:
            rows.append(said | {"verdict": "open", "pairs": 0, "over": "", "tested_on": f"not run: {missing}"})
            continue
        found = found.map(lambda value: float(f"{value:.6g}"))  # as in a CSV: what is judged is what is written
        mean, low, high = interval(found, claim.share)
        if low != low:
            why = f"all {len(found)} differences are equal" if len(found) > 1 else "fewer than two differences"
            words += f"; no interval: {why}"
        numbers = {"verdict": verdict(low, high), "effect": mean, "low": low, "high": high, "shared": claim.share}
        rows.append(said | numbers | {"pairs": len(found), "over": claim.pairs, "tested_on": words})
        pairs += [(claim.key, "/".join(map(str, listed(pair))), value) for pair, value in found.items()]
    return pd.DataFrame(rows, columns=COLUMNS), pd.DataFrame(pairs, columns=["key", "pair", "difference"])
