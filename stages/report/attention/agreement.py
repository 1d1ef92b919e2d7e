"""Every method against where people looked, and against the marks: two tables, and what their numbers say in words."""

from contextlib import suppress

import pandas as pd

from stages.kit.stats import interval
from stages.report.items import Table
from stages.report.markdown import signed, with_interval
from stages.report.results import NotRun, Results
from stages.report.style import label

from .rows import (
    CLASSICAL,
    GAINS,
    HUMAN,
    OURS,
    THESIS,
    agreement,
    best_rival,
    difference,
    method_text,
    rivals,
    scores,
    seconds,
)  # fmt: skip

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
GAZE_NOTES = [
    "{count} meshes, about 20,000 vertices each, and the gaze of 32 people on them in virtual reality, summed over the "
    "people (raw hits, seconds a vertex); as published with FandosA/3D_Mesh_Saliency_Prediction_PyTorch. The truth is "
    "that gaze, and the same spread along the surface with a Gaussian of 2.5 % of the diagonal.",
    "What is learned is learned from the other meshes, but for the starred rows. Twelve views of 1200 x 900 pixels (T "
    "figure 3.2). The intervals are over {count} meshes, which are few; other kinds of objects or people may differ.",
    "Seconds: from the maps to the points, of the median mesh; pictures and maps come on top (see the chart of cost).",
]
MARKED = "household"  # the data set whose marks come with the project
MARKS = (
    "The truth here is no gaze: marks of three passes over rendered views by a vision model (data/annotations). No "
    "human subjects took part. A bunny is among these objects and among the meshes with gaze."
)
LEFT_OUT = (
    "Each object is judged with weights and SVMs that were learned without it; ours was learned from human gaze on "
    "other meshes and has seen no mark, unless weights.method says otherwise."
)


def against_gaze(results: Results) -> Table:
    """The meshes with human gaze, each left out of the learning."""
    rows = results.rows("salient_points", "gaze")
    count = rows["item"].nunique()
    notes = [note.format(count=count) for note in GAZE_NOTES]
    return _table(rows, ["nss", "auc", *MEANS], f"Attention against human gaze, {count} meshes", notes)


def against_marks(results: Results) -> Table:
    """The marks on this run's own objects."""
    rows = results.measured("salient_points")
    dataset, count = rows["dataset"].iloc[0], rows.loc[rows["metric"] == "nss", "item"].nunique()
    title = f"Attention against the marks on {count} objects of this run"
    note = MARKS if dataset == MARKED else f"The truth is what comes with the data set {dataset}."
    return _table(rows, ["nss", "auc", COUNTED, "fne@0.05", "fpe@0.05"], title, [note, LEFT_OUT])


def _table(rows, metrics, title, notes):
    """The Table of judged rows for a choice of metrics; notes follow those that the numbers say."""
    frame = agreement(rows, metrics)
    said = [sentence for build in (ours_and_rivals, learned, peeking) for sentence in build(rows)]
    return Table(title, frame, [*said, *notes, *READING], _wide(frame, metrics, seconds(rows)))


def ours_and_rivals(rows):
    """Where ours stands, and which rivals it does not beat beyond chance."""
    table = scores(rows, "nss")
    if OURS not in table:
        return []
    sentences = [f"{label(OURS)}: NSS {with_interval(*interval(table[OURS].dropna()), places=2)}"]
    if HUMAN in table:
        sentences[0] += f"; {label(HUMAN)}, spread as smoothly, has {table[HUMAN].mean():.2f}"
    with suppress(NotRun):
        best = best_rival(rows)
        gains = [f"{name} {signed(*interval(difference(rows, key, OURS, best)))}" for key, name in ALONE.items()]
        sentences.append(
            f"The best other method that has not seen the object is {label(best)}: ours − it {_and(gains)}"
        )
        sentences += [_beaten(rows, key) for key in GAINS]
    return [f"{sentence}." for sentence in sentences]


def _beaten(rows, metric):
    table = scores(rows, metric)
    others = table[rivals(table)].mean().sort_values(ascending=False).index
    ends = {method: interval(difference(rows, metric, OURS, method))[1] for method in others}
    left = [label(method) for method, low in ends.items() if not low > 0]
    named = left if len(left) <= NAMED else [*left[:NAMED], f"{len(left) - NAMED} more"]
    word = (
        f"In {ALONE[metric]} ours is higher than {len(others) - len(left)} of the {len(others)} others that have not "
    )
    return f"{word}seen the object, with an interval that excludes zero" + (f"; not than {_and(named)}" if left else "")


def learned(rows):
    """What more channels with equal weights are worth over the classical model, and learned weights over equal ones."""
    base = "equal" if "equal" in scores(rows, "nss") else THESIS
    pairs = [(THESIS, CLASSICAL), ("equal", CLASSICAL), ("guided_ssim", base), ("guided_ed", base)]
    sentences = []
    for first, second in pairs:
        with suppress(NotRun):
            gains = [_compared(rows, key, first, second) for key in ALONE]
            sentences.append(f"{label(first)} − {label(second)}: {_and(gains)}.")
    return sentences


def peeking(rows):
    """What the same method gains from having seen the object: the leak of the thesis's way of testing."""
    found = []
    for clean, seen in PEEKED.items():
        with suppress(NotRun):
            found.append(f"{label(clean)} {signed(*interval(difference(rows, 'nss', seen, clean)))}")
    word = "* has seen the object: learned from its own truth too. What that adds in NSS: "
    return [f"{word}{'; '.join(found)}."] if found else []


def _compared(rows, metric, first, second):
    mean, low, high = interval(difference(rows, metric, first, second))
    word = "higher" if low > 0 else "lower" if high < 0 else "not told apart"
    return f"{ALONE[metric]} {signed(mean, low, high, places=3)} ({word})"


def _and(parts):
    return " and ".join([", ".join(parts[:-1]), parts[-1]]) if len(parts) > 1 else "".join(parts)


def _wide(frame, metrics, cost):
    lines = []
    for method, group in frame.groupby("method", sort=False):
        cell = group.set_index("metric")
        line = {"method": method_text(method)}
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
