"""Claims of T4.2: which points, classifiers, imprints and groups of objects make touch recognisable."""

from functools import partial

from stages.kit.split import Split
from stages.report import claims as data
from stages.report.claims import highest_of

from .rows import ENHANCED, MODEL, PHRASES, STAGE

NEAR = 0.95  # what "up to 100 % accuracy" is held to
SECTION = "T4.2.4"
SIX = {"classifier": "knn", "group": "six", "metric": "accuracy", "split": Split.RANDOM, "variant": "plain"}
REGIONS = SIX | {"split": Split.REGIONS}
FEW = SIX | {"variant": "first_15"}
EVERY = {column: value for column, value in SIX.items() if column != "classifier"}  # the mean of all classifiers
ALL = "mean of all classifiers"
claim = partial(data.Claim, stage=STAGE, phrases=PHRASES)


def by_points(key, sentence, first, second, where=SIX, section=SECTION, **further):
    """A claim that touch at points of `first` is better than at points of `second`."""
    sides = {"first": {"method": first}, "second": {"method": second}}
    return claim(key=key, section=section, sentence=sentence, **sides, where=where, **further)


def by_variant(key, sentence, first, second, where=SIX, section=SECTION, **further):
    """A claim that one variant is better than another, at enhanced points."""
    sides = {"first": {"variant": first}, "second": {"variant": second}}
    where = {column: value for column, value in where.items() if column != "variant"} | {"method": ENHANCED}
    return claim(key=key, section=section, sentence=sentence, **sides, where=where, **further)


POINTS = [
    by_points("enhanced_over_itti", "Touch guided by the enhanced model is better than by the classical one.",
              ENHANCED, "itti"),
    by_points("itti_over_blind", "Touch guided by the classical model is better than blind touch.", "itti", "random"),
    by_points("enhanced_over_blind", "Touch guided by the enhanced model is better than blind touch.",
              ENHANCED, "random"),
    by_points("enhanced_over_blind_four", "Enhanced beats blind touch with four objects too.", ENHANCED, "random",
              SIX | {"group": "four"}),
    by_points("enhanced_over_blind_all", "Enhanced beats blind touch over all classifiers.", ENHANCED, "random", EVERY,
              note=ALL),
    by_points("enhanced_over_blind_apart", "Enhanced beats blind touch where no training touch overlaps.",
              ENHANCED, "random", REGIONS),
    *(
        by_points(f"enhanced_over_{rival}", f"Touch guided by the enhanced model is better than by {words}.",
                  ENHANCED, rival)
        for rival, words in (("heat_kernel", "heat kernel signatures"), ("salient_points", "salient points"),
                             ("mesh_saliency", "mesh saliency"))
    ),
    by_points("ours_over_blind", "Touch guided by our model of gaze is better than blind touch.", MODEL, "random",
              section="ours"),
    by_points("ours_over_enhanced", "Touch guided by our model of gaze is better than by the enhanced model.",
              MODEL, ENHANCED, section="ours"),
]  # fmt: skip
AT_ENHANCED = {column: value for column, value in SIX.items() if column != "classifier"} | {"method": ENHANCED}
CLASSIFIERS = [
    claim(key="knn_best", section=SECTION, sentence="kNN is the best classifier.", where=AT_ENHANCED,
          first={"classifier": "knn"}, second={"classifier": highest_of()}),
    claim(key="network_poor", section=SECTION, where=AT_ENHANCED,
          sentence="The small network does worse than kNN, having few imprints to learn from.",
          first={"classifier": "knn"}, second={"classifier": "deep_learning"}),
]  # fmt: skip
GROUPS = [
    claim(key=f"four_easier{key}", section=SECTION, sentence=sentence, statistic=statistic, note=note,
          where={"method": ENHANCED} | {column: value for column, value in SIX.items() if column != "group"},
          first={"group": "four"}, second={"group": "six"})
    for key, sentence, statistic, note in (
        ("", "Four objects are easier than six.", "difference", ""),
        ("_beyond_chance", "Similar objects degrade the performance: four are easier even beyond chance.",
         "beyond_chance", "guessing scaled to 0 and certainty to 100"),
    )
]  # fmt: skip
UNSEEN = [
    by_points("enhanced_over_itti_apart", "Touch guided by the enhanced model is better than by the classical one, on "
              "new regions.", ENHANCED, "itti", REGIONS),
    by_points("itti_over_blind_apart", "Touch guided by the classical model is better than blind touch, on new "
              "regions.", "itti", "random", REGIONS),
    by_points("enhanced_over_itti_first_15", "Enhanced beats classical attention with few imprints.",
              ENHANCED, "itti", FEW),
    by_points("enhanced_over_blind_first_15", "Enhanced attention beats blind touch with few imprints.",
              ENHANCED, "random", FEW),
    by_points("ours_over_blind_apart", "Touch guided by our model of gaze beats blind touch, on new regions.",
              MODEL, "random", REGIONS, "ours"),
    by_points("ours_over_blind_first_15", "Our model of gaze beats blind touch with few imprints.",
              MODEL, "random", FEW, "ours"),
]  # fmt: skip
DISSIMILAR = [
    by_points(f"dissimilar_{rival}{key}",
              f"Enhanced attention gives fewer imprints that others have than {words}.", rival, ENHANCED,
              {"group": "six", "metric": "similar_share", "variant": variant}, over=("item",),
              unit="points of the share")
    for variant, key in (("plain", ""), ("first_15", "_first_15"))
    for rival, words in (("itti", "the classical model"), ("random", "blind touch"))
]  # fmt: skip
SELECTION = [
    by_variant("selection_helps", "Removing imprints that other objects have enhances recognition.",
               "selected", "plain"),
    claim(key="selection_helps_all", section=SECTION, sentence="Selection enhances recognition by all classifiers.",
          where={"method": ENHANCED, "group": "six", "split": Split.RANDOM}, note=ALL,
          first={"variant": "selected", "metric": "recall"}, second={"variant": "plain", "metric": "accuracy"}),
    by_variant("selection_helps_train", "Selection enhances recognition where the test part is whole.",
               "selected_train", "plain"),
]  # fmt: skip
LOCATIONS = [
    by_variant("locations_help", "Adding the position of the touch enhances recognition.", "locations", "plain"),
    by_variant("locations_help_side", "Adding the position enhances recognition on a side not touched before.",
               "locations", "plain_side", REGIONS),
    by_variant("locations_help_turned", "Adding the position still helps when the objects have been turned.",
               "locations_turned", "plain", section="ours"),
]  # fmt: skip
SEVERAL = [
    by_variant("more_touches", "Five touches joined into one sample are better than one.", "touches_5", "touches_1"),
    by_variant("more_touches_all", "Five joined touches are better than one over all classifiers.",
               "touches_5", "touches_1", EVERY, note=ALL),
    by_variant("more_touches_bayes", "Five joined touches are better than one for naive Bayes.",
               "touches_5", "touches_1", SIX | {"classifier": "naive_bayes"}),
    by_variant("more_touches_many", "Five joined touches are better than one with many combinations to train on.",
               "touches_5_many", "touches_1_many"),
    claim(key="certain_at_five", section=SECTION, sentence="Recognition is near certain with five touches.",
          where={"method": ENHANCED} | SIX | {"variant": "touches_5"}, second=NEAR),
    by_variant("mixed_flatters", "Combinations drawn before the split flatter.", "touches_5_mixed", "touches_5",
               section="ours"),
    by_variant("network_dips", "The network does worse with five touches than with three.", "touches_3", "touches_5",
               SIX | {"classifier": "deep_learning"}),
    by_variant("network_dips_disjoint", "The network does worse with five touches where samples get fewer.",
               "touches_3_disjoint", "touches_5_disjoint", SIX | {"classifier": "deep_learning"}),
]  # fmt: skip
CLAIMS = [
    *POINTS, *CLASSIFIERS, *GROUPS, *UNSEEN, *DISSIMILAR, *SELECTION, *LOCATIONS, *SEVERAL,
]  # fmt: skip
