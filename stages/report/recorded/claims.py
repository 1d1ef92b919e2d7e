"""Claims on recorded touches: the real sensor of T4.2.4, networks of sight (T5.4)."""

from collections.abc import Iterable, Iterator
from functools import partial
from typing import Any

import pandas as pd

from haptic_glance.know.split import Split, shared_by
from stages.charts.results import NUMBERS, Results
from stages.recorded.pressure_images import UNREDUCED
from stages.report.claims import NO_SVM, SCALE, SCALED, TRAINED, Claim, Side, highest_of, reading
from stages.report.effects import side, statistic
from stages.report.networks import GUESS, NETWORK, PRINTED, WORDS

from .networks import CLASSICAL, DATA, OVER, SPLITS, STAGE, commonest
from .networks import SIMULATIONS as KINDS
from .tables import CLASSES, SELECTIONS

SIMULATED = "resting_skin"  # the simulation that was meant to be the closest, before any result was seen
ALL = {"metric": "accuracy", "split": Split.RANDOM} | SCALE  # the mean of all classifiers
KNN = {"group": "all", "classifier": "knn", "metric": "accuracy"}
OF_SETS = {
    **{("group", name): words for name, words in CLASSES.items()},
    **{("method", name): words for name, words in SELECTIONS.items()},
    ("method", "selected"): "selection before the split, as in the thesis,",
    ("scaling", "beforehand"): "z-transform of all data beforehand", ("scaling", "training"): "",
    ("scaling", "min_max"): "all data from 0 to 1",
}  # fmt: skip
OF_TEN = {
    ("group", "all"): "ten classes",
    ("training", "both"): "real touches and", ("training", "real"): "real touches alone",
    ("simulation", SIMULATED): "resting imprints with skin", ("aligned", False): "",
    **{("touches", count): f"{count} real of each class" for count in (1, 5, 20)},
}  # fmt: skip
SIMULATIONS = tuple(
    reading(f"{words}{', aligned' if aligned else ''}", first={"simulation": name, "aligned": aligned})
    for name, words in KINDS.items()
    for aligned in (False, True)
    if name != "none" and (name, aligned) != (SIMULATED, False)
)
touches = partial(Claim, section="T4.2.4", stage="recorded", dataset="pressure_images")
RECORDED_CLASSES = 22  # of which sets are drawn


def shared_classes(group: str) -> float:
    """The test over training share of splits that are as much alike as drawn sets of classes (touch.tables)."""
    count = NUMBERS[group.partition("_")[0]]
    return count / (RECORDED_CLASSES - count)


def on_set(group: str, **fields: Any) -> Claim:
    """A claim on one set of classes; of those that are drawn each repetition has its own."""
    is_drawn = group.endswith("drawn")
    phrases = OF_SETS | ({("over", "repetition"): "sets of classes"} if is_drawn else {})
    where = {"group": group} | ALL | fields.pop("where", {})
    return touches(where=where, shared=shared_classes(group) if is_drawn else None, phrases=phrases, **fields)


TOUCHES = [
    *(
        on_set(group, key=f"real_selection_{group}", first={"method": "selected"}, second={"method": "all"},
               sentence="The selection of dissimilar imprints helps with real touches too.",
               note="mean of all classifiers", readings=(NO_SVM, *SCALED))
        for group in ("four_drawn", "six_drawn", "four_alike", "six_alike", "all")
    ),
    on_set("six_alike", key="real_selection_training", first={"method": "selected_training"}, second={"method": "all"},
           sentence="The selection helps with the test touches left as they are.", note="mean of all classifiers",
           of="real_selection_four_drawn",
           readings=(NO_SVM, *SCALED)),
    *(
        on_set(group, key=f"real_selection_control_{group}", section="ours", first={"method": "selected"},
               second={"method": "selected_control"}, note="mean of all classifiers", readings=(NO_SVM, *SCALED),
               sentence="Selection of real touches is better than as many left out at random.")
        for group in ("six_drawn", "six_alike", "all")
    ),
    *(
        on_set(group, key=f"real_knn_best_{key}", sentence="kNN is the best classifier with real touches.",
               where={"method": method}, first={"classifier": "knn"}, second={"classifier": highest_of()},
               readings=SCALED)
        for key, group, method in (
            ("six", "six_drawn", "all"), ("all", "all", "all"), ("four", "four_drawn", "all"),
            ("six_selected", "six_drawn", "selected"), ("four_selected", "four_drawn", "selected"),
        )
    ),
    *(
        touches(key=f"real_alike_harder{end}", of="alike_harder",
                sentence="The similarity between objects degrades the performance.",
                first={"group": f"{count}_drawn"}, second={"group": f"{count}_alike"}, mean_of="second",
                shared=shared_classes(count), where=ALL | {"method": "all"}, phrases=OF_SETS,
                note="mean of all classifiers", readings=(NO_SVM, *SCALED))
        for end, count in (("", "six"), ("_four", "four"))
    ),
    touches(key="real_blocked", section="ours", sentence="A random hold-out of real touches flatters.", phrases=OF_SETS,
            where=KNN | TRAINED | {"method": "all"}, first={"split": Split.RANDOM}, second={"split": Split.BLOCKS}),
    *(
        touches(key=f"simulation_helps_{count}", section="ours", stage="simulated_to_real", phrases=OF_TEN,
                sentence="Simulated imprints help to recognise real touches.", shared=shared_by(Split.BLOCKS),
                where=KNN | {"touches": count}, second={"training": "real"},
                first={"training": "both", "simulation": SIMULATED, "aligned": False}, readings=SIMULATIONS)
        for count in (5, 1, 20)
    ),
]  # fmt: skip


SETTINGS = {
    "pressure_random": ("pressure", Split.RANDOM),
    "pressure_runs": ("pressure", Split.BLOCKS),
    "fingers_random": ("grasps_object", Split.RANDOM),
    "fingers_runs": ("grasps_object", Split.BLOCKS),
    "fingers_slip": ("grasps_slip", Split.TEST_OBJECTS),
}  # name in the key of a claim -> (data, split)
OPTICAL = {name: (name, Split.RANDOM) for name in ("vitac", "vt60")}
HAND = {"hand_random": ("schunk_coarse", Split.RANDOM), "hand_grasps": ("schunk_coarse", Split.OBJECTS)}
SETS_OF = {"pressure": "pressure_images", "schunk_coarse": "schunk"} | {name: name for name in OPTICAL}
FINGERS = "fingers_random", "fingers_runs"
ARRAY, SLIP = ("pressure_random", "pressure_runs"), "fingers_slip"
FROZEN = {"method": NETWORK, "mode": "frozen", "weights": "imagenet"}
TUNED = FROZEN | {"mode": "finetuned"}
ANY = {"mode": "frozen"}  # of the networks
OTHER_NETWORKS = highest_of(*(network for network in PRINTED if network != "resnet50"))
SEEN, UNSEEN = {"weights": "imagenet"}, {"weights": "random"}
ACCURACY, GUESSING = {"metric": "accuracy"}, {"metric": highest_of("chance", "majority")}
OF_SIGHT = {
    **WORDS,
    **{("data", data): words.partition(", ")[2] for data, words in DATA.items()},
    **{("split", split): words for split, words in SPLITS.items()},
    ("method", CLASSICAL[0]): "features and kNN", ("over", "method"): "networks",
    ("metric", "majority"): "the commonest answer",
}  # fmt: skip


@statistic("over_commonest")
def over_commonest(results: Results, claim: Claim) -> pd.Series:
    """First side minus what the commonest answer gets right, which another stage has object by object."""
    return side(results, claim, claim.first, None) - commonest(results)


BEST = "minus the best of five classifiers, in any scaling, on the numbers themselves or on twelve components"


@statistic("over_classifiers")
def over_classifiers(results: Results, claim: Claim) -> pd.Series:
    """First side minus the classifier, of those without a network for photographs, that is right most often.

    Another stage has their rows, of the same splits: of features of the pressure array, of bare electrodes.
    """
    key, where = claim.over[0], {"metric": "accuracy", "split": claim.where["split"]}
    where |= {"group": "all", "method": ("all", UNREDUCED)} if "pressure" in claim.where["data"] else {"palm": "all"}
    rows = results.measured("recorded", claim.sets[0], **where)
    rows = rows[rows["classifier"] != "majority"].dropna(axis=1, how="all")
    ways = rows.columns.intersection(["classifier", "method", "scaling", "scaled", "components"])
    first = side(results, claim, claim.first, None)
    table = rows.pivot_table(index=key, columns=list(ways), values="value").reindex(first.index)
    return first - table[table.mean().idxmax()]


def claims(
    key: str, sentence: str, first: Side, second: Side | None, names: Iterable[str] = SETTINGS, where: Side = FROZEN,
    **fields: Any,
) -> Iterator[Claim]:  # fmt: skip
    """The claim on each of the settings `names`. where: what both sides have in common, unless they say otherwise."""
    for name in names:
        data, split = (SETTINGS | HAND | OPTICAL)[name]
        common = {"data": data, "split": split, **ACCURACY, **where, **(PASSES if data == "pressure" else {})}
        options = {"section": "T5.4", "over": ("item",) if split in OVER else ("repetition",)} | fields
        yield Claim(
            key=f"recorded_{key}_{name}", sentence=sentence, stage=STAGE, first=first, second=second, phrases=OF_SIGHT,
            dataset=SETS_OF.get(data, "biotac_grasps"),
            where={column: value for column, value in common.items() if column not in first}, **options,
        )  # fmt: skip


# T5.4 concludes that vision and touch share features from accuracies above guessing. A control with random weights is
# this project's.
SHARED = "Filters learned by sight help beyond their architecture:"
BEYOND: dict[str, Any] = {"section": "ours", "printed": 1}
INITIAL = reading("random side with its initial statistics", second={"weights": "random_initial"})
PASSES = {"passes": "printed"}  # others' rows have these alone, and do not say so
CONVERGED = reading("trained until nothing improves", first={"passes": "converged"}, second={"passes": "converged"})
TUNED_ON = reading(CONVERGED.name, first={"passes": "converged"})
OF_SIMULATION = "frozen_coarse_by_chance_random"  # the same sentence, on simulated imprints of the thesis's size
BETTER = "Frozen visual filters tell touches apart better than guessing:"  # of pressure arrays T5.4 says the contrary
OTHER: dict[str, Any] = {"note": "other electrodes than BiGS's"}
NETWORKS = [
    *claims("frozen_over_guessing", f"{BETTER} electrodes of fingers.", ACCURACY, GUESSING, FINGERS, **OTHER),
    *claims("frozen_over_guessing", f"{BETTER} electrodes of fingers.", ACCURACY, {"metric": "majority"}, [SLIP],
            statistic="over_commonest", **OTHER),
    *claims("frozen_over_guessing", f"{BETTER} optical sensors.", ACCURACY, GUESSING, OPTICAL),
    *claims("frozen_by_guessing", "On a pressure array frozen visual filters are hardly better than guessing.",
            GUESSING, ACCURACY, ARRAY, margin=GUESS, of=OF_SIMULATION,
            note="the thesis's own largest lead; 28 x 50 cells, the thesis has 16 x 16"),
    *claims("instant_by_guessing", "One reading of 7 x 3 cells is hardly better than guessing what is grasped.",
            GUESSING, ACCURACY, HAND, margin=GUESS, shared=shared_by(Split.RANDOM),
            note="another hand than BiGS's; at random, other fingers of a grasp are trained on"),
    *claims("series_over_instant", "A series of readings tells grasped objects apart better than one of 7 x 3 cells.",
            {"data": "schunk"}, {"data": "schunk_coarse"}, HAND, shared=shared_by(Split.RANDOM),
            note="another hand than BiGS's"),
    *claims("seen_over_random_frozen", f"{SHARED} frozen filters for recorded touches.",
            SEEN, UNSEEN, **BEYOND, readings=(reading("AlexNet", where={"method": "alexnet"}), INITIAL)),
    *claims("seen_over_random_networks", f"{SHARED} frozen filters, whichever network.",
            SEEN, UNSEEN, (*ARRAY, *FINGERS, *HAND), ANY, **BEYOND, over=("method",), within=("repetition",),
            readings=(INITIAL,), note="each network that was run"),
    *claims("seen_over_random_tuned", f"{SHARED} the start of a training on recorded touches.",
            SEEN, UNSEEN, where=TUNED, **BEYOND, readings=(CONVERGED,)),
    *claims("tuned_over_frozen", "Fine-tuning on recorded touches beats frozen filters.",
            {"mode": "finetuned"}, {"mode": "frozen"}, readings=(TUNED_ON,),
            note="tuned in 600 steps at most, of fingertips two passes"),
    *claims("resnet_best", "ResNet50 is the best of the networks on recorded touches.",
            {"method": "resnet50"}, {"method": OTHER_NETWORKS}, ARRAY,
            note="of those that were run; the highest in these tests, which is hard on ResNet50"),
    *claims("frozen_over_features", "Frozen visual filters beat hand-made features on recorded touches.",
            {"method": NETWORK}, None, ARRAY, section="ours", statistic="over_classifiers", note=BEST),
    *claims("frozen_over_electrodes", "Frozen visual filters beat a classifier of the bare readings of the electrodes.",
            {"method": NETWORK}, None, (*FINGERS, SLIP), section="ours", statistic="over_classifiers", note=BEST),
]  # fmt: skip
