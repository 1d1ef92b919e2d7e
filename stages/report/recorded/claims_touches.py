"""Claims of T4.2.4 on the real sensor (table 4.4), on the touches that others recorded; and ours on simulation."""

from functools import partial
from typing import Any

from haptic_glance.know.split import Split, shared_by
from stages.report.claims import Claim, highest_of, reading

from .grasps import SELECTIONS, SETS
from .networks import SIMULATIONS as KINDS

SIMULATED = "resting_skin"  # the simulation that was meant to be the closest, before any result was seen
SCALE = {"scaling": "training"}  # z-transform fitted to the training part; other scalings are readings
SCALED = (
    reading("z-transform of all data beforehand", where={"scaling": "beforehand"}),
    reading("all data from 0 to 1", where={"scaling": "min_max"}),
)
NO_SVM = reading("without the SVM", where={"classifier": ("knn", "decision_tree", "naive_bayes", "deep_learning")})
ALL = {"metric": "accuracy", "split": Split.RANDOM} | SCALE  # the mean of all classifiers
KNN = {"group": "all", "classifier": "knn", "metric": "accuracy"}
PHRASES = {
    **{("group", name): words for name, words in SETS.items()},
    **{("method", name): words for name, words in SELECTIONS.items()},
    ("method", "selected"): "selection before the split, as in the thesis,",
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


def on_set(group: str, **fields: Any) -> Claim:
    """A claim on one set of classes; of those that are drawn each repetition has its own."""
    drawn = group.endswith("drawn")
    phrases = PHRASES | ({("over", "repetition"): "sets of classes"} if drawn else {})
    where = {"group": group} | ALL | fields.pop("where", {})
    return touches(where=where, shared=0.0 if drawn else None, phrases=phrases, **fields)


CLAIMS = [
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
        on_set(group, key=f"real_selection_control_{group}", first={"method": "selected"},
               second={"method": "selected_control"}, note="mean of all classifiers", readings=(NO_SVM, *SCALED),
               sentence="Selection of real touches is better than as many left out at random.")
        for group in ("six_drawn", "six_alike", "all")
    ),
    *(
        on_set(group, key=key, sentence="kNN is the best classifier with real touches.", where={"method": "all"},
               first={"classifier": "knn"}, second={"classifier": highest_of()}, readings=SCALED)
        for key, group in (("real_knn_best_six", "six_drawn"), ("real_knn_best_all", "all"))
    ),
    touches(key="real_blocked", section="ours", sentence="A random hold-out of real touches flatters.", phrases=PHRASES,
            where=KNN | SCALE | {"method": "all"}, first={"split": Split.RANDOM}, second={"split": Split.BLOCKS}),
    *(
        touches(key=f"simulation_helps_{count}", section="ours", stage="simulated_to_real", phrases=OF_TEN,
                sentence="Simulated imprints help to recognise real touches.", shared=shared_by(Split.BLOCKS),
                where=KNN | {"touches": count}, second={"training": "real"},
                first={"training": "both", "simulation": SIMULATED, "aligned": False}, readings=SIMULATIONS)
        for count in (5, 1, 20)
    ),
]  # fmt: skip
