"""The common shape of the tables on agreement with people, and what their numbers say in words."""

from contextlib import suppress

import pandas as pd

from stages.report.items import Table
from stages.report.judged import (
    CLASSICAL,
    GAINS,
    HUMAN,
    OURS,
    THESIS,
    agreement,
    best_rival,
    difference,
    rivals,
    scores,
    seconds,
    signed,
    spoken,
)
from stages.report.markdown import with_interval
from stages.report.results import NotRun
from stages.report.style import label
from stages.weights.agreement import mean_interval

ALONE = {"nss": "NSS", "auc": "AUC"}  # shown with their interval
MEANS = {
    "cc": "CC", "sim": "SIM", "kl": "KL", "points_strong": "points", "fne@0.05": "FNE", "fpe@0.05": "FPE",
    "wme@0.05": "WME",
}  # fmt: skip
COUNTED = "points_strong"
NAMED = 5  # methods that a sentence names at most
PEEKED = {"enhanced": "fixations_seen", "guided_ssim": "guided_ssim_seen", "guided_ed": "guided_ed_seen",
          "svm": "svm_object"}  # fmt: skip
READING = [
    "NSS: standard deviations that the map lies above its mean where people looked (0 is chance); AUC: how often a "
    "place looked at beats a random one (0.5 is chance); CC, SIM: correlation and overlap with the spread truth; KL: "
    "information lost, less is better. All weigh the surface by area (Bylinskii et al., PAMI 2019). NSS, AUC: mean "
    "[95 % interval, bootstrap over objects]; intervals of the others are in the CSV.",
    "Points: those that pass the method's own threshold. FNE, FPE, WME: points missed, points too many, weighted "
    "misses, at 5 % of the diagonal (Dutagaci et al. 2012); many points miss little and are too many.",
    "Two methods differ beyond chance where the interval of their paired difference (ours − it) excludes zero, not "
    "where their own intervals are apart.",
]


def agreement_table(rows, metrics, title, notes):
    """The Table of judged rows for a choice of metrics; notes follow those that the numbers say."""
    frame = agreement(rows, metrics)
    said = [sentence for build in (ours_and_rivals, equal_and_classical, learned, peeking) for sentence in build(rows)]
    return Table(title, frame, [*said, *notes, *READING], _wide(frame, metrics, seconds(rows)))


def ours_and_rivals(rows):
    """Where ours stands, and which rivals it does not beat beyond chance."""
    table = scores(rows, "nss")
    if OURS not in table:
        return []
    sentences = [f"{label(OURS)}: NSS {with_interval(*mean_interval(table[OURS].dropna()), places=2)}"]
    if HUMAN in table:
        sentences[0] += f"; {label(HUMAN)}, spread as smoothly, has {table[HUMAN].mean():.2f}"
    with suppress(NotRun):
        best = best_rival(rows)
        gains = [f"{name} {signed(*mean_interval(difference(rows, key, OURS, best)))}" for key, name in ALONE.items()]
        sentences.append(
            f"The best other method that has not seen the object is {label(best)}: ours − it {_and(gains)}"
        )
        sentences += [_beaten(rows, key) for key in GAINS]
    return [f"{sentence}." for sentence in sentences]


def _beaten(rows, metric):
    table = scores(rows, metric)
    others = table[rivals(table)].mean().sort_values(ascending=False).index
    ends = {method: mean_interval(difference(rows, metric, OURS, method))[1] for method in others}
    left = [label(method) for method, low in ends.items() if not low > 0]
    named = left if len(left) <= NAMED else [*left[:NAMED], f"{len(left) - NAMED} more"]
    word = (
        f"In {ALONE[metric]} ours is higher than {len(others) - len(left)} of the {len(others)} others that have not "
    )
    return f"{word}seen the object, with an interval that excludes zero" + (f"; not than {_and(named)}" if left else "")


def equal_and_classical(rows):
    """Whether more channels with equal weights agree better than the classical model."""
    sentences = []
    for method in (THESIS, "equal"):
        with suppress(NotRun):
            gains = [_compared(rows, key, method, CLASSICAL) for key in ALONE]
            sentences.append(f"{label(method)} − {label(CLASSICAL)}: {_and(gains)}.")
    return sentences


def learned(rows):
    """What learned weights of channels are worth over equal ones."""
    sentences = []
    base = "equal" if "equal" in scores(rows, "nss") else THESIS
    for method in ("guided_ssim", "guided_ed"):
        with suppress(NotRun):
            gains = [_compared(rows, key, method, base) for key in ALONE]
            sentences.append(f"{label(method)} − {label(base)}: {_and(gains)}.")
    return sentences


def peeking(rows):
    """What the same method gains from having seen the object: the leak of the thesis's way of testing."""
    found = []
    for clean, seen in PEEKED.items():
        with suppress(NotRun):
            found.append(f"{label(clean)} {signed(*mean_interval(difference(rows, 'nss', seen, clean)))}")
    word = "* has seen the object: learned from its own truth too. What that adds in NSS: "
    return [f"{word}{'; '.join(found)}."] if found else []


def _compared(rows, metric, first, second):
    mean, low, high = mean_interval(difference(rows, metric, first, second))
    word = "higher" if low > 0 else "lower" if high < 0 else "not told apart"
    return f"{ALONE[metric]} {signed(mean, low, high, places=3)} ({word})"


def _and(parts):
    return " and ".join([", ".join(parts[:-1]), parts[-1]]) if len(parts) > 1 else "".join(parts)


def _wide(frame, metrics, cost):
    lines = []
    for method, group in frame.groupby("method", sort=False):
        cell = group.set_index("metric")
        line = {"method": spoken(method)}
        for metric in metrics:
            if metric in ALONE:
                line[ALONE[metric]] = with_interval(*cell.loc[metric, ["mean", "low", "high"]], places=2)
            else:
                mean = cell["mean"].get(metric, float("nan"))
                line[MEANS[metric]] = f"{mean:.{1 if metric == COUNTED else 2}f}" if mean == mean else "–"
        for metric in GAINS:
            gain = cell.loc[metric].reindex(["gain", "gain_low", "gain_high"])
            line[f"ours − it, {ALONE[metric]}"] = signed(*gain) if gain["gain"] == gain["gain"] else "–"
        lines.append(line | {"seconds": cost.get(method, "–")})
    shown = pd.DataFrame(lines)
    first = ["method", *ALONE.values(), *(f"ours − it, {ALONE[metric]}" for metric in GAINS)]
    return shown[[*first, *(column for column in shown if column not in first)]]
