"""Claims of T4.2: which points, classifiers, imprints and groups of objects make touch recognisable."""

from functools import partial
from typing import Any

from stages.kit.split import Split
from stages.report.claims import Claim, Side, highest_of

from .rows import ENHANCED, MODEL, STAGE

EVERY: Side = {"group": "six", "metric": "accuracy", "split": Split.RANDOM}  # the mean of all classifiers
SIX: Side = {"classifier": "knn"} | EVERY
FOUR, APART, NETWORK = SIX | {"group": "four"}, SIX | {"split": Split.REGIONS}, SIX | {"classifier": "deep_learning"}
PLAIN, FEW, AT_ENHANCED = {"variant": "plain"}, {"variant": "first_15"}, {"method": ENHANCED}
ALL = "mean of all classifiers"
# In the keys of claims: two points, and behind them the rows.
POINTS = {"enhanced": ENHANCED, "ours": MODEL, "blind": "random"}
ROWS = {"": SIX | PLAIN, "_four": FOUR | PLAIN, "_all": EVERY | PLAIN, "_apart": APART | PLAIN, "_first_15": SIX | FEW}
PHRASES = {
    ("method", MODEL): "our model of gaze", ("method", ENHANCED): "enhanced attention",
    ("metric", "similar_share"): "share of imprints that correlate by 0.85 or more with one of another object",
    ("variant", "plain"): "all imprints",
    ("variant", "plain_side"): "all imprints",  # split regions: one side of all objects, not a region of each
    ("variant", "first_15"): "the first 15 imprints of each object, as the thesis had",
    ("variant", "selected"): "similar imprints removed from training and test part",
    ("variant", "selected_train"): "similar imprints removed from the training part",
    ("variant", "locations"): "imprints with positions",
    ("variant", "locations_turned"): "imprints with positions, tested on objects turned about the vertical,",
    **{
        ("variant", f"touches_{count}{end}"): f"{count} joined touch{'es' if count > 1 else ''}{words}"
        for count in (1, 3, 5) for end, words in (
            ("", ""), ("_many", ", five times as many combinations,"), ("_mixed", ", combined before the split,"),
            ("_disjoint", ", each imprint in one combination,"))
    },
}  # fmt: skip
claim = partial(Claim, section="T4.2.4", stage=STAGE, phrases=PHRASES)
KNN = {"classifier": "knn", "metric": "accuracy", "split": Split.RANDOM}
four_to_six = partial(claim, where=AT_ENHANCED | KNN | PLAIN, first={"group": "four"}, second={"group": "six"})


def by_points(key: str, sentence: str, end: str = "") -> Claim:
    """A claim that touch at the first points of its key is better than at the second; end: of the key, for the ROWS."""
    first, second = ({"method": POINTS.get(name, name)} for name in key.split("_over_"))
    section, note = "ours" if key.startswith("ours") else "T4.2.4", ALL if end == "_all" else ""
    return claim(
        key=key + end, sentence=sentence, first=first, second=second, where=ROWS[end], section=section, note=note
    )


def by_variant(key: str, sentence: str, one: str, other: str = "plain", where: Side = SIX, **further: Any) -> Claim:
    """A claim that one variant is better than another, at enhanced points."""
    sides = {"first": {"variant": one}, "second": {"variant": other}}
    return claim(key=key, sentence=sentence, **sides, where={**where, **AT_ENHANCED}, **further)


CLAIMS = [
    by_points("enhanced_over_itti", "Touch guided by the enhanced model is better than by the classical one."),
    by_points("itti_over_blind", "Touch guided by the classical model is better than blind touch."),
    by_points("enhanced_over_blind", "Touch guided by the enhanced model is better than blind touch."),
    by_points("enhanced_over_blind", "Enhanced beats blind touch with four objects too.", "_four"),
    by_points("enhanced_over_blind", "Enhanced beats blind touch over all classifiers.", "_all"),
    by_points("enhanced_over_blind", "Enhanced beats blind touch where no training touch overlaps.", "_apart"),
    by_points("enhanced_over_heat_kernel",
              "Touch guided by the enhanced model is better than by heat kernel signatures."),
    by_points("enhanced_over_salient_points", "Touch guided by the enhanced model is better than by salient points."),
    by_points("enhanced_over_mesh_saliency", "Touch guided by the enhanced model is better than by mesh saliency."),
    by_points("ours_over_blind", "Touch guided by our model of gaze is better than blind touch."),
    by_points("ours_over_enhanced", "Touch guided by our model of gaze is better than by the enhanced model."),
    claim(key="knn_best", sentence="kNN is the best classifier.", where=EVERY | PLAIN | AT_ENHANCED,
          first={"classifier": "knn"}, second={"classifier": highest_of()}),
    claim(key="network_poor", sentence="The small network does worse than kNN, having few imprints to learn from.",
          where=EVERY | PLAIN | AT_ENHANCED, first={"classifier": "knn"}, second={"classifier": "deep_learning"}),
    four_to_six(key="four_easier", sentence="Four objects are easier than six."),
    four_to_six(key="four_easier_beyond_chance", statistic="beyond_chance",
                sentence="Similar objects degrade the performance: four are easier even beyond chance.",
                note="guessing scaled to 0 and certainty to 100"),
    by_points("enhanced_over_itti",
              "Touch guided by the enhanced model is better than by the classical one, on new regions.", "_apart"),
    by_points("itti_over_blind",
              "Touch guided by the classical model is better than blind touch, on new regions.", "_apart"),
    by_points("enhanced_over_itti", "Enhanced beats classical attention with few imprints.", "_first_15"),
    by_points("enhanced_over_blind", "Enhanced attention beats blind touch with few imprints.", "_first_15"),
    by_points("ours_over_blind", "Touch guided by our model of gaze beats blind touch, on new regions.", "_apart"),
    by_points("ours_over_blind", "Our model of gaze beats blind touch with few imprints.", "_first_15"),
    *(
        claim(key=f"dissimilar_{rival}{end}", first={"method": rival}, second=AT_ENHANCED, over=("item",),
              sentence=f"Enhanced attention gives fewer imprints that others have than {words}.",
              where={"group": "six", "metric": "similar_share"} | variant, unit="points of the share")
        for variant, end in ((PLAIN, ""), (FEW, "_first_15"))
        for rival, words in (("itti", "the classical model"), ("random", "blind touch"))
    ),
    by_variant("selection_helps", "Removing imprints that other objects have enhances recognition.", "selected"),
    claim(key="selection_helps_all", sentence="Selection enhances recognition by all classifiers.",
          where=AT_ENHANCED | {"group": "six", "split": Split.RANDOM}, note=ALL,
          first={"variant": "selected", "metric": "recall"}, second=PLAIN | {"metric": "accuracy"}),
    by_variant("selection_helps_train", "Selection enhances recognition where the test part is whole.",
               "selected_train"),
    by_variant("locations_help", "Adding the position of the touch enhances recognition.", "locations"),
    by_variant("locations_help_side", "Adding the position enhances recognition on a side not touched before.",
               "locations", "plain_side", APART),
    by_variant("locations_help_turned", "Adding the position still helps when the objects have been turned.",
               "locations_turned", section="ours"),
    by_variant("more_touches", "Five touches joined into one sample are better than one.", "touches_5", "touches_1"),
    by_variant("more_touches_all", "Five joined touches are better than one over all classifiers.",
               "touches_5", "touches_1", EVERY, note=ALL),
    by_variant("more_touches_bayes", "Five joined touches are better than one for naive Bayes.",
               "touches_5", "touches_1", SIX | {"classifier": "naive_bayes"}),
    by_variant("more_touches_many", "Five joined touches are better than one with many combinations to train on.",
               "touches_5_many", "touches_1_many"),
    claim(key="certain_at_five", sentence="Recognition is near certain with five touches.",
          where={**AT_ENHANCED, **SIX, "variant": "touches_5"}, second=0.95),  # "up to 100 % accuracy"
    by_variant("mixed_flatters", "Combinations drawn before the split flatter.", "touches_5_mixed", "touches_5",
               section="ours"),
    by_variant("network_dips", "The network does worse with five touches than with three.", "touches_3", "touches_5",
               NETWORK),
    by_variant("network_dips_disjoint", "The network does worse with five touches where samples get fewer.",
               "touches_3_disjoint", "touches_5_disjoint", NETWORK),
]  # fmt: skip
