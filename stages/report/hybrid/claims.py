"""Claims of T5.5 and 5.6: one network for vision and touch, and what two senses are worth together."""

from functools import partial

from stages.report.claims import Claim, Side
from stages.report.networks import SEEN, SETS, both

from .hybrid_senses import WHOLE
from .new_objects import METRIC
from .section_5_5 import MIDDLE, POINT, SENSES

UNHARMED = {"perturbation": WHOLE}
DARK = {"perturbation": "picture_darkness", "severity": 0.95}  # the harshest that was measured
PHRASES = {
    ("data", "hybrid"): "", ("mode", MIDDLE): f"layers {MIDDLE} shared", ("sense", "both"): "",
    ("sense", "vision"): "by sight", ("sense", "touch"): "by touch", ("perturbation", WHOLE): "",
    ("perturbation", None): "", ("perturbation", "picture_darkness"): "hardly any light", ("severity", 0.95): "",
    ("method", "vision"): "network for sight", ("method", "touch"): "network for touch",
    ("method", "better_sense"): "better sense alone", ("method", "fusion_entropy"): "both heads by certainty",
    ("method", "fusion_entropy_raw"): "both heads by certainty without temperatures",
    ("metric", METRIC): "new objects", ("severity", (1, 2, 5, 10)): "mean of 1, 2, 5 and 10 touches of each",
    ("method", "hybrid_head"): "head on the hybrid's features", ("severity", 1): "one touch of each",
    ("method", "imagenet_head"): "head on ImageNet's features", ("method", "hybrid_nearest"): "nearest touch",
    ("method", "sum_mean"): "streams summed", ("method", "hybrid_int8"): "hybrid of 8 bits",
}  # fmt: skip


def claim(key: str, section: str, sentence: str, first: Side, second: Side, where: Side, margin: float = 0.0) -> Claim:
    """The claim of one way to recognise over another. where: what both have in common."""
    return Claim(
        key=key, section=section, sentence=sentence, stage="transfer", first=first, second=second, margin=margin,
        where={"data": "hybrid", "mode": MIDDLE, "metric": "accuracy", **where}, phrases=PHRASES, within=SEEN,
        dataset=SETS, checked=section != "ours",  # ours compare ways to use the same networks
    )  # fmt: skip


def joined(key: str, section: str, sentence: str, first: str, second: str, damage: Side = UNHARMED) -> Claim:
    """A claim on both senses: one way of joining them, or one sense alone, over another."""
    return claim(key, section, sentence, {"method": first}, {"method": second}, {"sense": "both", **damage})


on_both_splits = partial(both, items="items", done="met")
THESIS = on_both_splits(
    claim("sight_over_touch", "T5.5", "The hybrid network recognises better by sight than by touch.",
          {"method": "vision", "sense": "vision"}, {"method": "touch", "sense": "touch"}, {"perturbation": None}),
    joined("touch_in_the_dark", "T5.5", "Where sight fails, touch helps.", "fusion_entropy", "vision", DARK),
)  # fmt: skip
OURS = on_both_splits(
    *(  # not of the hybrid of 32 bits: its answers are those of the two networks, so that no difference has a spread
        claim(f"eight_bits_{word}", "ours", f"With weights of 8 bits the hybrid recognises as well by {word} as one "
              "network, but for one point.", {"method": "hybrid_int8"}, {"method": sense},
              {"sense": sense, "perturbation": None}, POINT)
        for sense, word in SENSES.items()
    ),
    joined("both_over_better", "ours", "Both senses together recognise more than the better one alone.",
           "fusion_entropy", "better_sense"),
    joined("apart_over_sum", "ours", "Fed both senses, two answers joined beat the summed streams of the thesis.",
           "fusion_entropy", "sum_mean"),
    joined("harmless_in_the_dark", "ours", "Where sight fails, having it does no harm to touch.",
           "fusion_entropy", "touch", DARK),
    joined("temperatures_help", "ours", "In the dark temperatures make the certainty a better guide.",
           "fusion_entropy", "fusion_entropy_raw", DARK),
)  # fmt: skip
new_objects = partial(
    Claim, section="T6.3", stage="transfer", dataset="furniture", over=("item",), phrases=PHRASES,
    where={"metric": METRIC, "severity": (1, 2, 5, 10)},
)  # fmt: skip
DEVICE = [
    new_objects(key="new_object_hybrid_over_imagenet", first={"method": "hybrid_head"},
                second={"method": "imagenet_head"},
                sentence="A new head learns new objects better on the hybrid network's features than on ImageNet's."),
    new_objects(key="new_object_head_over_nearest", first={"method": "hybrid_head"},
                second={"method": "hybrid_nearest"},
                sentence="Of few touches a new head makes more than the nearest known touch does."),
    new_objects(key="new_object_over_guessing", first={"method": "hybrid_head"}, second=1 / 8,
                where={"metric": METRIC, "severity": 1},
                sentence="One touch of each is enough to tell eight new objects apart better than by guessing."),
]  # fmt: skip
CLAIMS = [*THESIS, *OURS, *DEVICE]
