"""Claims of T4.2: which points, classifiers, imprints and groups of objects make touch recognisable."""

from functools import partial
from typing import Any

from stages.kit.split import Split
from stages.report import claims as data
from stages.report.claims import Claim, Side, highest_of

from .rows import ENHANCED, MODEL, STAGE

NEAR = 0.95  # what "up to 100 % accuracy" is held to
EVERY: Side = {"group": "six", "metric": "accuracy", "split": Split.RANDOM}  # the mean of all classifiers
SIX: Side = {"classifier": "knn"} | EVERY
REGIONS, NETWORK = SIX | {"split": Split.REGIONS}, SIX | {"classifier": "deep_learning"}
PLAIN, FEW = {"variant": "plain"}, {"variant": "first_15"}
AT_ENHANCED = {"method": ENHANCED}
ALL = "mean of all classifiers"
PHRASES = {
    ("method", MODEL): "our model of gaze",
    ("method", ENHANCED): "enhanced attention",
    ("metric", "similar_share"): "share of imprints that correlate by 0.85 or more with one of another object",
    ("variant", "plain"): "all imprints",
    ("variant", "plain_side"): "all imprints",  # split regions: one side of all objects, not a region of each
    ("variant", "first_15"): "the first 15 imprints of each object, as the thesis had",
    ("variant", "selected"): "similar imprints removed from training and test part",
    ("variant", "selected_train"): "similar imprints removed from the training part",
    ("variant", "locations"): "imprints with positions",
    ("variant", "locations_turned"): "imprints with positions, tested on objects turned about the vertical,",
    **{
        ("variant", f"touches_{count}{suffix}"): f"{count} joined touch{'es' if count > 1 else ''}{words}"
        for count in (1, 3, 5)
        for suffix, words in (
            ("", ""), ("_many", ", five times as many combinations,"), ("_mixed", ", combined before the split,"),
            ("_disjoint", ", each imprint in one combination,"),
        )
    },
}  # fmt: skip
claim = partial(data.Claim, section="T4.2.4", stage=STAGE, phrases=PHRASES)


def by_points(key: str, sentence: str, first: str, second: str, where: Side = SIX | PLAIN, **further: Any) -> Claim:
    """A claim that touch at points of `first` is better than at points of `second`; ours where they are our model's."""
    further = ({"section": "ours"} if first == MODEL else {}) | further
    return claim(key=key, sentence=sentence, first={"method": first}, second={"method": second}, where=where, **further)


def by_variant(key: str, sentence: str, first: str, second: str, where: Side = SIX, **further: Any) -> Claim:
    """A claim that one variant is better than another, at enhanced points."""
    sides = {"first": {"variant": first}, "second": {"variant": second}}
    return claim(key=key, sentence=sentence, **sides, where={**where, **AT_ENHANCED}, **further)


CLAIMS = [
    # The points
    by_points("enhanced_over_itti", "Touch guided by the enhanced model is better than by the classical one.",
              ENHANCED, "itti"),
    by_points("itti_over_blind", "Touch guided by the classical model is better than blind touch.", "itti", "random"),
    by_points("enhanced_over_blind", "Touch guided by the enhanced model is better than blind touch.",
              ENHANCED, "random"),
    by_points("enhanced_over_blind_four", "Enhanced beats blind touch with four objects too.", ENHANCED, "random",
              SIX | PLAIN | {"group": "four"}),
    by_points("enhanced_over_blind_all", "Enhanced beats blind touch over all classifiers.", ENHANCED, "random",
              EVERY | PLAIN, note=ALL),
    by_points("enhanced_over_blind_apart", "Enhanced beats blind touch where no training touch overlaps.",
              ENHANCED, "random", REGIONS | PLAIN),
    *(
        by_points(f"enhanced_over_{rival}", f"Touch guided by the enhanced model is better than by {words}.",
                  ENHANCED, rival)
        for rival, words in (("heat_kernel", "heat kernel signatures"), ("salient_points", "salient points"),
                             ("mesh_saliency", "mesh saliency"))
    ),
    by_points("ours_over_blind", "Touch guided by our model of gaze is better than blind touch.", MODEL, "random"),
    by_points("ours_over_enhanced", "Touch guided by our model of gaze is better than by the enhanced model.",
              MODEL, ENHANCED),
    # The classifiers
    claim(key="knn_best", sentence="kNN is the best classifier.", where=EVERY | PLAIN | AT_ENHANCED,
          first={"classifier": "knn"}, second={"classifier": highest_of()}),
    claim(key="network_poor", sentence="The small network does worse than kNN, having few imprints to learn from.",
          where=EVERY | PLAIN | AT_ENHANCED, first={"classifier": "knn"}, second={"classifier": "deep_learning"}),
    # The groups of objects
    *(
        claim(key=f"four_easier{key}", sentence=sentence, statistic=statistic, note=note,
              where={**AT_ENHANCED, "classifier": "knn", "metric": "accuracy", "split": Split.RANDOM, **PLAIN},
              first={"group": "four"}, second={"group": "six"})
        for key, sentence, statistic, note in (
            ("", "Four objects are easier than six.", "difference", ""),
            ("_beyond_chance", "Similar objects degrade the performance: four are easier even beyond chance.",
             "beyond_chance", "guessing scaled to 0 and certainty to 100"),
        )
    ),
    # The points, on new regions and with few imprints
    by_points("enhanced_over_itti_apart", "Touch guided by the enhanced model is better than by the classical one, on "
              "new regions.", ENHANCED, "itti", REGIONS | PLAIN),
    by_points("itti_over_blind_apart", "Touch guided by the classical model is better than blind touch, on new "
              "regions.", "itti", "random", REGIONS | PLAIN),
    by_points("enhanced_over_itti_first_15", "Enhanced beats classical attention with few imprints.",
              ENHANCED, "itti", SIX | FEW),
    by_points("enhanced_over_blind_first_15", "Enhanced attention beats blind touch with few imprints.",
              ENHANCED, "random", SIX | FEW),
    by_points("ours_over_blind_apart", "Touch guided by our model of gaze beats blind touch, on new regions.",
              MODEL, "random", REGIONS | PLAIN),
    by_points("ours_over_blind_first_15", "Our model of gaze beats blind touch with few imprints.", MODEL, "random",
              SIX | FEW),
    # Imprints that another object has too
    *(
        by_points(f"dissimilar_{rival}{key}",
                  f"Enhanced attention gives fewer imprints that others have than {words}.", rival, ENHANCED,
                  {"group": "six", "metric": "similar_share"} | variant, over=("item",), unit="points of the share")
        for variant, key in ((PLAIN, ""), (FEW, "_first_15"))
        for rival, words in (("itti", "the classical model"), ("random", "blind touch"))
    ),
    by_variant("selection_helps", "Removing imprints that other objects have enhances recognition.",
               "selected", "plain"),
    claim(key="selection_helps_all", sentence="Selection enhances recognition by all classifiers.",
          where=AT_ENHANCED | {"group": "six", "split": Split.RANDOM}, note=ALL,
          first={"variant": "selected", "metric": "recall"}, second=PLAIN | {"metric": "accuracy"}),
    by_variant("selection_helps_train", "Selection enhances recognition where the test part is whole.",
               "selected_train", "plain"),
    # The position of the touch
    by_variant("locations_help", "Adding the position of the touch enhances recognition.", "locations", "plain"),
    by_variant("locations_help_side", "Adding the position enhances recognition on a side not touched before.",
               "locations", "plain_side", REGIONS),
    by_variant("locations_help_turned", "Adding the position still helps when the objects have been turned.",
               "locations_turned", "plain", section="ours"),
    # Several touches
    by_variant("more_touches", "Five touches joined into one sample are better than one.", "touches_5", "touches_1"),
    by_variant("more_touches_all", "Five joined touches are better than one over all classifiers.",
               "touches_5", "touches_1", EVERY, note=ALL),
    by_variant("more_touches_bayes", "Five joined touches are better than one for naive Bayes.",
               "touches_5", "touches_1", SIX | {"classifier": "naive_bayes"}),
    by_variant("more_touches_many", "Five joined touches are better than one with many combinations to train on.",
               "touches_5_many", "touches_1_many"),
    claim(key="certain_at_five", sentence="Recognition is near certain with five touches.",
          where={**AT_ENHANCED, **SIX, "variant": "touches_5"}, second=NEAR),
    by_variant("mixed_flatters", "Combinations drawn before the split flatter.", "touches_5_mixed", "touches_5",
               section="ours"),
    by_variant("network_dips", "The network does worse with five touches than with three.", "touches_3", "touches_5",
               NETWORK),
    by_variant("network_dips_disjoint", "The network does worse with five touches where samples get fewer.",
               "touches_3_disjoint", "touches_5_disjoint", NETWORK),
]  # fmt: skip
