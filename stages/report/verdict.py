"""Claims of the thesis, and the one word that a measurement says to each."""

import re
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pandas as pd

from .intervals import interval
from .results import NotRun, Results

BY_CHANCE = 0.025  # how often a 95 % interval lies wholly on one side of zero where the truth is zero
COLUMNS = ["section", "claim", "verdict", "effect", "low", "high", "unit", "pairs", "over", "tested_on", "key"]


@dataclass(frozen=True)
class Claim:
    """One testable sentence of the thesis and the measurement that it is tested on.

    tested_on: {six} stands for the set six in words, with the number of objects that it held in this run.
    differences(results) returns the paired differences (k,), positive on the side that the thesis claims, in `unit`;
    it raises NotRun where the measurement is absent. over: what the pairs are (objects, repetitions). shared: test
    over training share where the pairs are repeated splits of the same imprints (see intervals.interval).
    """

    key: str
    section: str
    sentence: str
    tested_on: str
    unit: str
    over: str
    differences: Callable[[Results], np.ndarray]
    shared: float = 0.0


def verdict(low, high):
    """The word: supported when the interval lies above 0 (the claimed side), contradicted below, else open."""
    if low > 0:
        return "supported"
    return "contradicted" if high < 0 else "open"


def counted(claims):
    """Two sentences on a frame of `judge`: how many there are of each word, and how many chance alone would give."""
    words = {word: int((claims["verdict"] == word).sum()) for word in ("supported", "contradicted", "open")}
    judged = int(claims["low"].notna().sum())
    return (
        f"{len(claims)} verdicts: {', '.join(f'{count} {word}' for word, count in words.items())}. Were there no "
        f"effect in any of the {judged} that have an interval, chance alone would call about {BY_CHANCE * judged:.0f} "
        f"of them supported and as many contradicted: {100 * BY_CHANCE:g} % each."
    )


def judge(claims, results):
    """A frame with one row a claim: effect with its interval and the word; unmeasured ones are open and say why."""
    return pd.DataFrame([_row(claim, results) for claim in claims], columns=COLUMNS)


def _row(claim, results):
    said = {"section": claim.section, "claim": claim.sentence, "unit": claim.unit, "key": claim.key}
    try:
        differences = claim.differences(results)
        tested_on = _tested_on(claim, results)
    except NotRun as missing:
        return said | {"verdict": "open", "pairs": 0, "over": "", "tested_on": f"not run: {missing}"}
    mean, low, high = interval(differences, claim.shared)
    numbers = {"verdict": verdict(low, high), "effect": mean, "low": low, "high": high}
    numbers |= {"pairs": len(differences), "over": claim.over}
    return said | numbers | {"tested_on": tested_on + _unknown(low, len(differences))}


def _tested_on(claim, results):
    """What a claim is tested on, its sets of objects in words."""
    return re.sub(r"\{(\w+)\}", lambda found: results.set_text(found[1]), claim.tested_on)


def _unknown(low, pairs):
    """Why there is no interval, where there is none."""
    if low == low:
        return ""
    return "; no interval: " + (f"all {pairs} differences are equal" if pairs > 1 else "fewer than two differences")


def paired(results, stage, over, first, second, **where):
    """value of `first` minus value of `second`, matched on the columns `over`: a Series indexed by them.

    first, second: dict column -> value, the rows of each side; where: what both sides have in common. Several rows of
    one pair are averaged. Raises NotRun where a side was not measured or no pair is left.
    """
    sides = [results.measured(stage, **where, **side).groupby(over)["value"].mean() for side in (first, second)]
    joined = pd.concat(sides, axis=1, join="inner").dropna()
    if joined.empty:
        names = " and ".join(" ".join(map(str, side.values())) for side in (first, second))
        raise NotRun(f"no pairs of {names}", stage, runnable=False)
    return joined.iloc[:, 0] - joined.iloc[:, 1]
