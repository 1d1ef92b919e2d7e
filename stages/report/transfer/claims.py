"""Claims of T5.4 to 5.6: what training on photographs is worth for touch, and which layers must learn."""

from functools import partial

import numpy as np
import pandas as pd
from scipy.stats import spearmanr

from stages.kit.split import shared_by
from stages.report import claims as data
from stages.report.differences import statistic
from stages.report.networks import COARSE, FINE, GUESS, NETWORK, both, on_their_classes
from stages.report.results import NotRun, Results

from .figure_5_4 import layer_changes

PHRASES = {
    ("data", FINE): "imprints of 128 x 128", ("data", COARSE): "imprints of 16 x 16",
    ("weights", "imagenet"): "ImageNet's weights", ("weights", "random"): "random weights",
    ("mode", "finetuned"): "fine-tuned", ("mode", "frozen"): "frozen",
    ("mode", "18:139"): "layers 18 to 139 frozen", ("mode", "1:134"): "layers 1 to 134 frozen",
    ("metric", "accuracy"): "accuracy", ("metric", "chance"): "guessing",
}  # fmt: skip
SETTING = {"data": FINE, "weights": "imagenet"}


def claims(key, section, sentence, first, second, margin=0.0, **where):
    """The claim of one setting of the network over another, on both splits. where: what differs from SETTING."""
    common = {"method": NETWORK, "metric": "accuracy"} | SETTING | where
    common = {column: value for column, value in common.items() if column not in first}
    one = data.Claim(
        key=key, section=section, sentence=sentence, stage="transfer", first=first, second=second, where=common,
        margin=margin, phrases=PHRASES,
    )  # fmt: skip
    return list(both(one))


def over_chance(key, section, sentence, **where):
    """The claim that a setting is better than guessing."""
    return claims(key, section, sentence, {"metric": "accuracy"}, {"metric": "chance"}, **where)


def by(column, first, second):
    """The two sides of `claims` that differ in one column."""
    return {column: first}, {column: second}


@statistic("later_convolutions_change_less")
def later_change_less(results: Results, claim: data.Claim) -> pd.Series:
    """Minus the rank correlation of a convolution's depth with its change, per training."""
    changes = layer_changes(results)
    wanted = {column: value for column, value in claim.where.items() if column in changes}
    mine = changes[(changes[list(wanted)] == pd.Series(wanted)).all(axis=1)]
    if mine.empty:
        raise NotRun("MobileNetV2 was not fine-tuned", "transfer")
    return pd.Series(
        {
            trial: -spearmanr(np.arange(len(one)), one["value"]).statistic
            for trial, one in mine.groupby("trial", sort=False)
        }
    )


modes, weights, arrays = partial(by, "mode"), partial(by, "weights"), partial(by, "data")
OWN = [
    *claims("tuned_over_frozen", "T5.4", "Fine-tuning on touch beats frozen filters.", *modes("finetuned", "frozen")),
    *over_chance("frozen_over_chance", "T5.4",
                 "Frozen visual filters tell simulated imprints apart better than guessing.", mode="frozen"),
    *claims("frozen_coarse_by_chance", "T5.4", "With 16 x 16 sensels frozen filters are hardly better than guessing.",
            {"metric": "chance"}, {"metric": "accuracy"}, GUESS, data=COARSE, mode="frozen"),
    *claims("fine_over_coarse_frozen", "T5.4", "A finer array makes touch more like sight: frozen filters gain by it.",
            *arrays(FINE, COARSE), mode="frozen"),
    *claims("fine_over_coarse_tuned", "T5.6", "A finer array makes touch easier to recognise.", *arrays(FINE, COARSE),
            mode="finetuned"),
    *claims("seen_over_random_frozen", "T5.4",
            "Vision and touch share features: frozen filters trained on photographs help.",
            *weights("imagenet", "random"), mode="frozen"),
    *claims("seen_over_random_tuned", "T5.4", "Vision and touch share features: sight is a better start for touch.",
            *weights("imagenet", "random"), mode="finetuned"),
    *claims("early_and_late", "T5.5", "Tuning the first and the last layers alone beats frozen filters.",
            *modes("18:139", "frozen")),
    *claims("middle_frozen", "T5.5", "With layers 18 to 139 frozen touch is recognised as well as with all tuned, "
            "but for one point.", *modes("18:139", "finetuned"), 1.0),
]  # fmt: skip
EARLY = claims(  # by layers that the default run does not freeze
    "early_decisive", "T5.5", "The early layers are decisive: tuning them too beats tuning the last ones alone.",
    *modes("18:139", "1:134"),
)  # fmt: skip
CLAIMS = [
    *OWN,
    data.Claim(
        key="earlier_change_more", section="T5.4",
        sentence="Earlier convolutions are altered more for touch than later ones.", stage="transfer",
        where={"network": NETWORK, "mode": "finetuned", "split": "random"} | SETTING, phrases=PHRASES, scale=1.0,
        statistic="later_convolutions_change_less", shared=shared_by("random"), unit="rank correlation",
        note="minus the rank correlation of depth and change",
    ),
    *on_their_classes([*OWN, *EARLY]),
]  # fmt: skip
