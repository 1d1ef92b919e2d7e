"""Claims of T5.4 to 5.6: what training on photographs is worth for touch, and which layers must learn."""

from dataclasses import replace

import numpy as np
import pandas as pd
from scipy.stats import spearmanr

from haptic_glance.know.split import shared_by
from stages.report.claims import Claim, reading
from stages.report.differences import statistic
from stages.report.networks import COARSE, FINE, GUESS, NETWORK, SEEN, SETS, THEIRS, both
from stages.report.results import Results

PHRASES = {
    ("data", FINE): "imprints of 128 x 128", ("data", COARSE): "imprints of 16 x 16",
    ("weights", "imagenet"): "ImageNet's weights", ("weights", "random"): "random weights",
    ("mode", "finetuned"): "fine-tuned", ("mode", "frozen"): "frozen",
    ("mode", "18:139"): "layers 18 to 139 frozen", ("mode", "1:134"): "layers 1 to 134 frozen",
    ("metric", "accuracy"): "accuracy", ("metric", "chance"): "guessing",
    ("passes", "printed"): "", ("passes", "converged"): "trained until nothing improves",
}  # fmt: skip
SETTING = {"method": NETWORK, "metric": "accuracy", "data": FINE, "weights": "imagenet", "passes": "printed"}
CONVERGED = (  # splits first: objects share the trainings, so that their interval is too narrow
    reading("trained until nothing improves", where={"passes": "converged"}),
    reading("trained until nothing improves, over objects", where={"passes": "converged", "metric": "object_accuracy"},
            over=("item",), within=("repetition", *SEEN), shared=0.0),
)  # fmt: skip


def claim(
    key: str, section: str, sentence: str, column: str, first: str, second: str, margin: float = 0.0, **where: str
) -> Claim:
    """The claim of one value of a column over another. where: what both have in common that differs from SETTING."""
    common = {name: value for name, value in (SETTING | where).items() if name != column}
    return Claim(
        key=key, section=section, sentence=sentence, stage="transfer", first={column: first}, second={column: second},
        where=common, margin=margin, phrases=PHRASES, within=SEEN, dataset=SETS,
        readings=CONVERGED,
    )  # fmt: skip


@statistic("later_convolutions_change_less")
def later_change_less(results: Results, claim: Claim) -> pd.Series:
    """Minus the rank correlation of a convolution's depth with its change, per training."""
    changes = results.measured("transfer", claim.sets[0], metric="layer_weight_change", **claim.where)
    return -changes.groupby("repetition")["value"].agg(lambda one: spearmanr(np.arange(len(one)), one)[0])


OWN = both(
    claim("tuned_over_frozen", "T5.4", "Fine-tuning on touch beats frozen filters.", "mode", "finetuned", "frozen"),
    claim("frozen_over_chance", "T5.4", "Frozen visual filters tell simulated imprints apart better than guessing.",
          "metric", "accuracy", "chance", mode="frozen"),
    claim("frozen_coarse_by_chance", "T5.4", "With 16 x 16 sensels frozen filters are hardly better than guessing.",
          "metric", "chance", "accuracy", GUESS, data=COARSE, mode="frozen"),
    claim("fine_over_coarse_frozen", "T5.4", "A finer array makes touch more like sight: frozen filters gain by it.",
          "data", FINE, COARSE, mode="frozen"),
    claim("fine_over_coarse_tuned", "T5.6", "A finer array makes touch easier to recognise.",
          "data", FINE, COARSE, mode="finetuned"),
    claim("seen_over_random_frozen", "T5.4",
          "Vision and touch share features: frozen filters trained on photographs help.",
          "weights", "imagenet", "random", mode="frozen"),
    claim("seen_over_random_tuned", "T5.4", "Vision and touch share features: sight is a better start for touch.",
          "weights", "imagenet", "random", mode="finetuned"),
    claim("early_and_late", "T5.5", "Tuning the first and the last layers alone beats frozen filters.",
          "mode", "18:139", "frozen"),
    claim("middle_frozen", "T5.5", "With layers 18 to 139 frozen touch is recognised as well as with all tuned, but "
          "for one point.", "mode", "18:139", "finetuned", 1.0),
)  # fmt: skip
EARLY = [  # by layers that the default run does not freeze
    replace(one, key=f"{one.key}_psb", dataset=THEIRS)
    for one in both(
        claim("early_decisive", "T5.5", "The early layers are decisive: tuning them too beats tuning the last ones "
              "alone.", "mode", "18:139", "1:134"),
    )
]  # fmt: skip
CHANGES = Claim(
    key="earlier_change_more", section="T5.4", stage="transfer", dataset=SETS, phrases=PHRASES, scale=1.0,
    shared=shared_by("random"),
    sentence="Earlier convolutions are altered more for touch than later ones.", unit="rank correlation",
    where={"method": NETWORK, "mode": "finetuned", "split": "random", "data": FINE, "weights": "imagenet",
           "passes": "printed"},
    statistic="later_convolutions_change_less", note="minus the rank correlation of depth and change",
)  # fmt: skip
CLAIMS = [*OWN, *EARLY, CHANGES]
