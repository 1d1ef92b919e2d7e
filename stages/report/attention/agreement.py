"""Every method against where people looked, and against the marks: two tables, and what their numbers say in words."""

from collections.abc import Iterator, Sequence
from contextlib import suppress

import numpy as np
import pandas as pd

from stages.kit.stats import interval
from stages.report.items import Table
from stages.report.markdown import number, signed, with_interval
from stages.report.prose import shared_notes
from stages.report.results import NotRun, Results
from stages.report.style import label

from .rows import CLASSICAL, GAIN, GAINS, HUMAN, MEAN, OURS, THESIS, agreement, difference, method_text, rivals, scores

PACKAGE = str(__package__)
ALONE = {"nss": "NSS", "auc": "AUC"}  # shown with their interval
COUNTED = "points_strong"
MEANS = {
    "cc": "CC", "sim": "SIM", "kl": "KL", COUNTED: "points", "fne@0.05": "FNE", "fpe@0.05": "FPE", "wme@0.05": "WME",
}  # fmt: skip
NAMED = 5  # methods that a sentence names at most
PEEKED = {"enhanced": "fixations_seen", "guided_ssim": "guided_ssim_seen", "guided_ed": "guided_ed_seen",
          "svm": "svm_object"}  # fmt: skip
MARKED = "household"  # the data set whose marks come with the project


def against_gaze(results: Results) -> Table:
    """The meshes with human gaze, each left out of the learning."""
    rows = results.rows("salient_points", "gaze")
    return _table(rows, list(MEANS), {"count": rows["item"].nunique()})


def against_marks(results: Results) -> Table:
    """The marks on this run's own objects."""
    rows = results.measured("salient_points")
    dataset, count = rows["dataset"].iloc[0], rows.loc[rows["metric"] == "nss", "item"].nunique()
    other = f"The truth is what comes with the data set {dataset}."
    truth = shared_notes(PACKAGE, "marks") if dataset == MARKED else other
    return _table(rows, [COUNTED, "fne@0.05", "fpe@0.05"], {"count": count, "truth": truth})


def _table(rows: pd.DataFrame, beside: Sequence[str], words: dict) -> Table:
    """The judged rows, with those of MEANS that stand beside NSS and AUC; words: without those that the numbers say."""
    frame = agreement(rows, [*ALONE, *beside])
    timed = rows.dropna(subset=["seconds"]).drop_duplicates(["item", "method", "seconds"])
    cost = timed.groupby("method")["seconds"].median().map(number)
    lines = []
    for method, group in frame.groupby("method", sort=False):
        cells = group.set_index("metric").reindex(columns=[*MEAN, *GAIN]).T.to_dict("list")
        line = {"method": method_text(str(method))}
        line |= {name: with_interval(*cells[metric][:3], places=2) for metric, name in ALONE.items()}
        for metric in GAINS:
            over = cells[metric][3:]
            line[f"ours − it, {ALONE[metric]}"] = signed(*over) if over[0] == over[0] else "–"
        for metric in beside:
            mean = cells.get(metric, [np.nan])[0]
            line[MEANS[metric]] = f"{mean:.{1 if metric == COUNTED else 2}f}" if mean == mean else "–"
        lines.append(line | {"seconds": cost.get(method, "–")})
    said = "\n".join([*_ours_and_rivals(rows), *_learned(rows), *_peeking(rows)])
    return Table(frame, pd.DataFrame(lines), words | {"said": said, "reading": shared_notes(PACKAGE, "reading")})


def _ours_and_rivals(rows: pd.DataFrame) -> Iterator[str]:
    """Where ours stands, and which rivals it does not beat beyond chance."""
    table = scores(rows, "nss")
    if OURS not in table:
        return
    first = f"{label(OURS)}: NSS {with_interval(*interval(table[OURS]), places=2)}"
    if HUMAN in table:
        first += f"; {label(HUMAN)}, spread as smoothly, has {table[HUMAN].mean():.2f}"
    yield f"{first}."
    others = rivals(rows, "nss")
    if others:
        gains = [f"{name} {signed(*interval(difference(rows, key, OURS, others[0])))}" for key, name in ALONE.items()]
        yield f"The best other method that has not seen the object is {label(others[0])}: ours − it {_and(gains)}."
        yield from (_beaten(rows, key) for key in GAINS)


def _beaten(rows: pd.DataFrame, metric: str) -> str:
    others = rivals(rows, metric)
    left = [label(name) for name in others if not interval(difference(rows, metric, OURS, name))[1] > 0]
    named = left if len(left) <= NAMED else [*left[:NAMED], f"{len(left) - NAMED} more"]
    return (
        f"In {ALONE[metric]} ours is higher than {len(others) - len(left)} of the {len(others)} others that have not "
        "seen the object, with an interval that excludes zero" + (f"; not than {_and(named)}." if left else ".")
    )


def _learned(rows: pd.DataFrame) -> Iterator[str]:
    """What more channels with equal weights are worth over the classical model, and learned weights over equal ones."""
    base = "equal" if "equal" in scores(rows, "nss") else THESIS
    for pair in ((THESIS, CLASSICAL), ("equal", CLASSICAL), ("guided_ssim", base), ("guided_ed", base)):
        with suppress(NotRun):
            gains = []
            for metric, name in ALONE.items():
                mean, low, high = interval(difference(rows, metric, *pair))
                word = "higher" if low > 0 else "lower" if high < 0 else "not told apart"
                gains.append(f"{name} {signed(mean, low, high, places=3)} ({word})")
            yield f"{' − '.join(map(label, pair))}: {_and(gains)}."


def _peeking(rows: pd.DataFrame) -> Iterator[str]:
    """What the same method gains from having seen the object: the leak of the thesis's way of testing."""
    found = []
    for clean, seen in PEEKED.items():
        with suppress(NotRun):
            found.append(f"{label(clean)} {signed(*interval(difference(rows, 'nss', seen, clean)))}")
    if found:
        yield f"* has seen the object: learned from its own truth too. What that adds in NSS: {'; '.join(found)}."


def _and(parts: list[str]) -> str:
    return " and ".join([", ".join(parts[:-1]), parts[-1]]) if len(parts) > 1 else "".join(parts)
