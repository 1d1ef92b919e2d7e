"""Every method against where people looked, and against the marks: two tables, and what their numbers say in words."""

from collections.abc import Iterator, Sequence
from contextlib import suppress

import pandas as pd

from stages.bench import has_seen
from stages.kit.stats import interval
from stages.report.costs import attention_seconds
from stages.report.grid import records
from stages.report.items import Table
from stages.report.markdown import number, signed, with_interval
from stages.report.prose import shared_notes
from stages.report.ranking import Ranking
from stages.report.results import ON_BLACK, NotRun, Results
from stages.report.style import label

from .rows import ALONE, BLACK, CLASSICAL, GAIN, HUMAN, OURS, THESIS, agreement, difference, method_text, rivals, scores

COUNTED = "points_strong"
MEANS = {
    "cc": "CC", "sim": "SIM", "kl": "KL", COUNTED: "points", "fne@0.05": "FNE", "fpe@0.05": "FPE", "wme@0.05": "WME",
}  # fmt: skip
NAMED = 5  # methods that a sentence names at most
PEEKED = {"guided_ssim": "guided_ssim_seen", "guided_ed": "guided_ed_seen", "svm": "svm_object"}
FILTERED = (CLASSICAL, THESIS, "thesis_ssim", "thesis_ed", "guided_ssim", "guided_ed")  # the thesis's, on black too
MARKED = "household"  # the data set whose marks come with the project


def against_gaze(results: Results) -> Table:
    """The meshes with human gaze, each left out of the learning."""
    rows, black = results.rows("salient_points", "gaze"), None
    with suppress(NotRun):
        black = results.rows("salient_points", ON_BLACK, method=list(FILTERED))
        black = black.assign(method=black["method"] + BLACK)
    return _table(results, rows, list(MEANS), {"count": rows["item"].nunique()}, black)


def against_clouds(results: Results) -> Table:
    """The point clouds with human gaze, each left out of the learning; how their surfaces are made costs apart."""
    rows = results.rows("salient_points", "gaze_clouds")
    return _table(results, rows, list(MEANS), {"count": rows["item"].nunique()})


def against_marks(results: Results) -> Table:
    """The marks on this run's own objects."""
    rows = results.measured("salient_points")
    dataset, count = rows["dataset"].iloc[0], rows.loc[rows["metric"] == "nss", "item"].nunique()
    other = f"The truth is what comes with the data set {dataset}."
    truth = shared_notes(__package__, "marks") if dataset == MARKED else other
    return _table(results, rows, [COUNTED, "fne@0.05", "fpe@0.05"], {"count": count, "truth": truth})


def _table(
    results: Results, rows: pd.DataFrame, beside: Sequence[str], words: dict, more: pd.DataFrame | None = None
) -> Table:
    """The judged rows, with those of MEANS that stand beside NSS and AUC; words: without those that the numbers say.

    more: rows that stand in the table too, of which nothing is said. The seconds are those from the pictures to the
    points; of a set without rows of pictures or maps there are none.
    """
    cost: dict[str, float] = {}
    with suppress(NotRun):
        cost = attention_seconds(results, rows["dataset"].iloc[0])
    shown = rows if more is None else pd.concat([rows, more])
    frame = agreement(shown, [*ALONE, *beside])
    names, lines = list(ALONE.values()), {}
    columns = ["method", *names, *(f"ours − it, {name}" for name in names), *map(MEANS.get, beside)]
    columns += ["seconds"] if cost else []
    for row in records(frame.reindex(columns=frame.columns.union(GAIN))):
        line = lines.setdefault(row.method, dict.fromkeys(columns, "–"))
        line |= {"method": method_text(row.method), "seconds": number(cost[row.method]) if row.method in cost else "–"}
        if row.metric in ALONE:
            line[ALONE[row.metric]] = with_interval(row.mean, row.low, row.high, places=2)
        elif row.mean == row.mean:
            line[MEANS[row.metric]] = f"{row.mean:.{1 if row.metric == COUNTED else 2}f}"
        if row.gain == row.gain:
            line[f"ours − it, {ALONE[row.metric]}"] = signed(row.gain, row.gain_low, row.gain_high)
    said = "\n".join([*_ours_and_rivals(rows), *_learned(rows), *_peeking(rows)])
    words = words | {"said": said, "reading": shared_notes(__package__, "reading")}
    found = pd.DataFrame(lines.values())
    truth_and_peeking = [method_text(name) for name in lines if name == HUMAN or has_seen(name)]
    answer = [name for name in columns if name not in MEANS.values() or name == MEANS[COUNTED]]
    return Table(frame, found, words, Ranking("NSS", exempt=truth_and_peeking), answer)


def _ours_and_rivals(rows: pd.DataFrame) -> Iterator[str]:
    """Where ours stands, and which rivals it does not beat beyond chance."""
    table = scores(rows, "nss")
    if OURS not in table:
        return
    first = f"{label(OURS)}: NSS {with_interval(*interval(table[OURS]), places=2)}"
    if HUMAN in table:
        first += f"; {label(HUMAN)}, spread as smoothly, has {table[HUMAN].mean():.2f}"
    yield f"{first}."
    best = next(iter(rivals(rows, "nss")), None)
    if best is None:
        return
    gains = [f"{name} {signed(*interval(difference(rows, metric, OURS, best)))}" for metric, name in ALONE.items()]
    yield f"The best other method that has not seen the object is {label(best)}: ours − it {_and(gains)}."
    for metric, name in ALONE.items():
        others = rivals(rows, metric)
        left = [label(other) for other in others if not interval(difference(rows, metric, OURS, other))[1] > 0]
        named = left if len(left) <= NAMED else [*left[:NAMED], f"{len(left) - NAMED} more"]
        yield (
            f"In {name} ours is higher than {len(others) - len(left)} of the {len(others)} others that have not seen "
            "the object, with an interval that excludes zero" + (f"; not than {_and(named)}." if left else ".")
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
