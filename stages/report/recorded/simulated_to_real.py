"""How far simulated imprints help to recognise real touches."""

import pandas as pd

from stages.kit.split import shared_by
from stages.kit.stats import interval
from stages.report.items import Table
from stages.report.markdown import with_interval
from stages.report.style import label

BY = ["training", "simulation", "aligned", "touches", "classifier"]
SIMULATIONS = {
    "none": "none", "array": "the thesis's array", "resting": "resting", "resting_skin": "resting, skin",
    "resting_grain": "resting, skin, gain and grain", "resting_small": "resting, objects at 56 %",
}  # fmt: skip
SHOWN = "knn"  # the best of the five on real touches
COUNTERPARTS = (
    "ball: the three spheres; bottle: waterbottle; box: cubemedium, cubelarge; can: cylindermedium, cylinderlarge; "
    "hand: hand; pen: toothbrush; rubber: cubesmall; scissors: scissors; sticky_tape: torussmall, torusmedium; tube: "
    "flute"
)
NOTES = [
    "Accuracy of kNN in per cent [95 % interval] on real touches held out, by the number of real touches of each class "
    "in training; all five classifiers are in the CSV. 0: simulated imprints alone. Chance is 10 %.",
    f"Ten classes with a counterpart among the household meshes, chosen by name and shape beforehand: {COUNTERPARTS}. "
    "They are of the kind, not copies: the real bottle is ribbed, the real box a hollow frame, and most real ones are "
    "smaller. 48 simulated imprints a class, shared by its objects.",
    "The array: the thesis's, at vertices drawn by area, upright, normalised. Resting: the object lies on the array as "
    "on a table, in one of its stable poses, turned anyhow, its middle in the middle half of the array, 0.5 to 2 mm "
    "into the skin. Skin: blur of 0.8 cells, noise of 2 %. Gain and grain: blur of 0.6 cells, a gain of 0.3 to 1 a "
    "touch, 30 % deviation a cell. Stable poses, gain and grain were set once, by the look of the real touches beside "
    "the simulated ones, after first results were known. Sensor: 28 x 50 cells 1.9 mm apart (Tekscan 6077), mesh sizes "
    "from their files; at 56 %: as if 3.4 mm apart.",
    "Aligned: each feature scaled by its mean and deviation within its kind, simulated or real (real touches outside "
    "the test part, classes unknown). Twenty repetitions; the test part is a run of neighbouring numbers, a quarter of "
    "each class; intervals over the repetitions, widened for what they share (Nadeau and Bengio 2003).",
    "Real touches: Gandarias, García-Cerezo and Gómez-de-Gabriel, IEEE Sensors Journal 19(16), 6872-6882, 2019.",
]


def build(results):
    frame = accuracies(results)
    return Table("From simulated to real touch", frame, [*NOTES, *_by_class(results), _best(frame)], _wide(frame))


def accuracies(results):
    """Tidy frame: training, simulation, aligned, touches, classifier, accuracy, low, high."""
    rows = results.rows("simulated_to_real")
    rows = rows[rows["group"] == "all"].fillna({"simulation": "none", "aligned": False})
    found = []
    for key, group in rows.groupby(BY, sort=False):
        mean, low, high = interval(group["value"], shared_by("random"))
        found.append(dict(zip(BY, key, strict=True)) | {"accuracy": mean, "low": max(low, 0.0), "high": min(high, 1.0)})
    return pd.DataFrame(found).astype({"aligned": bool})


def _by_class(results):
    rows = results.rows("simulated_to_real")
    rows = rows[(rows["group"] != "all") & (rows["training"] == "simulated")].fillna({"aligned": False})
    means = rows.groupby(["simulation", "aligned", "group"])["value"].mean()
    best = means.groupby(level=[0, 1]).mean().idxmax()
    shares = means.loc[best].sort_values(ascending=False)
    told = ", ".join(f"{name} {100 * share:.0f}" for name, share in shares.items())
    way = SIMULATIONS[best[0]] + (", aligned" if best[1] else "")
    yield f"By simulated imprints alone ({way}, the best), real touches recognised of each class, per cent: {told}."


def _best(frame):
    """The best of all classifiers by the number of real touches, with and without simulated imprints."""
    top = frame.loc[frame.groupby(["training", "touches"])["accuracy"].idxmax()].set_index(["training", "touches"])
    told = [
        f"{touches}: {_named(top.loc['real', touches])} without, {_named(top.loc['both', touches])} with"
        for touches in sorted(set(frame["touches"]) - {0})
    ]
    return (
        f"Best of the five classifiers by real touches a class, per cent: {'; '.join(told)}. With simulated "
        "imprints it is the best of many more ways, which flatters it."
    )


def _named(row):
    way = "" if row["simulation"] == "none" else f", {SIMULATIONS[row['simulation']]}"
    return f"{100 * row['accuracy']:.0f} ({label(row['classifier'])}{way}{', aligned' if row['aligned'] else ''})"


def _wide(frame):
    mine = frame[frame["classifier"] == SHOWN].copy()
    mine["text"] = [with_interval(row.accuracy, row.low, row.high, 100, 0) for row in mine.itertuples()]
    mine["way"] = mine["simulation"].map(SIMULATIONS) + mine["aligned"].map({True: ", aligned", False: ""})
    wide = mine.pivot(index="way", columns="touches", values="text").reindex(dict.fromkeys(mine["way"]))
    first = [way for way in wide.index if way == "none"]
    wide = wide.loc[first + [way for way in wide.index if way not in first]].fillna("–")
    wide = wide.rename(columns=lambda count: f"{count} real touches a class, {label(SHOWN)}, %")
    return wide.reset_index().rename(columns={"way": "simulated imprints"})
