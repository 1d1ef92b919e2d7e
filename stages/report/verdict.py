"""The one word that a measurement says to each claim, with the differences that it rests on."""

from collections.abc import Iterable

import pandas as pd

from stages.kit.stats import discoveries, interval, p_value

from .claims import POINTS, Claim
from .differences import differences
from .results import NotRun, Results, listed
from .words import tested_on

WORDS = ("supported", "contradicted", "no difference", "open")
# By unit: what nobody would act on. Stated before the claims were judged by it; other units have none.
NEGLIGIBLE = {POINTS: 3.0, "% of the mean of both errors": 3.0, "PCC": 0.03, "NSS": 0.05}
COLUMNS = [
    "section", "claim", "verdict", "effect", "low", "high", "unit", "p", "holds", "pairs", "over", "shared",
    "tested_on", "key",
]  # fmt: skip


def verdict(low: float, high: float, unit: str = "") -> str:
    """The word: supported when the interval lies above 0 (the claimed side), contradicted when it lies below.

    An interval that covers 0 and no effect that matters (NEGLIGIBLE) shows no difference; else the claim is open.
    """
    if low > 0:
        return "supported"
    if high < 0:
        return "contradicted"
    return "no difference" if max(-low, high) <= NEGLIGIBLE.get(unit, -1.0) else "open"


def counts(claims: pd.DataFrame) -> dict[str, int]:
    """{word: how many there are of it} in a frame of `judge`."""
    return {word: list(claims["verdict"]).count(word) for word in WORDS}


def counted(claims: pd.DataFrame) -> str:
    """Two sentences on a frame of `judge`: how many there are of each word, and how many hold among so many."""
    decided = claims["holds"].isin(["yes", "no"]).sum()
    return (
        f"{len(claims)} verdicts: {', '.join(f'{count} {word}' for word, count in counts(claims).items())}. Of the "
        f"{decided} that are supported or contradicted, {(claims['holds'] == 'yes').sum()} hold among the claims of "
        "their chapter, at a false discovery rate of 5 %."
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
        numbers = {"verdict": verdict(low, high, claim.unit), "effect": mean, "low": low, "high": high}
        numbers |= {"shared": claim.share, "p": p_value(found, claim.share)}
        rows.append(said | numbers | {"pairs": len(found), "over": claim.pairs, "tested_on": words})
        pairs += [(claim.key, "/".join(map(str, listed(pair))), value) for pair, value in found.items()]
    frame = pd.DataFrame(rows, columns=COLUMNS)
    frame["holds"] = holding(frame)
    return frame, pd.DataFrame(pairs, columns=["key", "pair", "difference"])


def holding(frame: pd.DataFrame) -> pd.Series:
    """ "yes" or "no" of verdicts that are decided: whether they hold among the claims of their chapter; else empty.

    By Benjamini and Hochberg, at a false discovery rate of 5 %. A chapter is `T3`, say; ours is one by itself.
    """
    chapters = frame["section"].str.partition(".")[0]
    held = frame["p"].astype(float).groupby(chapters).transform(discoveries)
    return held.map({True: "yes", False: "no"}).where(frame["verdict"].isin(["supported", "contradicted"]), "")
