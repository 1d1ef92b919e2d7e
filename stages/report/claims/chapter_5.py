"""Claims of T5.4 to 5.6: what a network learned by sight is worth for touch, and which of its layers must learn."""

from dataclasses import replace

import numpy as np
import pandas as pd
from scipy.stats import spearmanr

from stages.report.figures.figure_5_4 import layer_changes
from stages.report.intervals import HOLD_OUT
from stages.report.results import NotRun
from stages.report.tables._transfer import COARSE, FINE, PSB, SPLITS, on_psb, shared
from stages.report.verdict import Claim, paired

NETWORK = "mobilenet_v2"
POINTS = "points of accuracy"
UNITS = {"random": "repetitions", "objects": "folds"}  # what the pairs are
GUESS = 7.6  # points over chance that frozen filters reach in T table 5.3, which calls that around a random guess


def between(split, first, second):
    """differences(results): accuracy with the setting `first` minus with `second`, matched by repetition."""

    def differences(results):
        sides = {"first": {"metric": "accuracy"} | first, "second": {"metric": "accuracy"} | second}
        return 100 * paired(results, "transfer", ["repetition"], **sides, method=NETWORK, split=split).to_numpy()

    return differences


def over_chance(split, setting):
    """differences(results): accuracy minus chance."""

    def differences(results):
        sides = {"first": {"metric": "accuracy"}, "second": {"metric": "chance"}}
        where = {"method": NETWORK, "split": split} | setting
        return 100 * paired(results, "transfer", ["repetition"], **sides, **where).to_numpy()

    return differences


def seen(mode, weights="imagenet", data=FINE):
    """One setting of the network."""
    return {"weights": weights, "mode": mode, "data": data}


def both(key, section, sentence, tested_on, differences, items="touches", felt="touched"):
    """The claim with items drawn at random, as in the thesis, and on objects left out.

    differences: split -> differences(results). items, felt: what was drawn, and what was never done to the objects.
    """
    for split, over in UNITS.items():
        said = sentence if split == "random" else f"{sentence[:-1]}, on objects never {felt} too."
        where = f"{tested_on}, {SPLITS[split].replace('touches', items)}"
        yield Claim(f"{key}_{split}", section, said, where, POINTS, over, differences(split), shared(split))


def on_their_classes(claims):
    """The claims of `both` on trainings on the thesis's own classes, measured once."""
    for claim in claims:
        split = claim.key.rpartition("_")[2]
        where = f"thesis's classes of psb: {claim.tested_on}"
        changed = {"key": f"{claim.key}_psb", "tested_on": where, "shared": shared(split, PSB)}
        yield replace(claim, differences=_there(claim.differences), **changed)


def _there(differences):
    return lambda results: differences(on_psb(results))


def compared(first, second):
    """split -> differences(results)."""
    return lambda split: between(split, first, second)


def within_a_point(split):
    """differences(results): layers 18 to 139 frozen minus all tuned, and the one point that may be lost."""
    return lambda results: between(split, seen("18:139"), seen("finetuned"))(results) + 1


def near_chance(split):
    """differences(results): GUESS minus the lead of frozen filters on the coarse array over chance."""
    return lambda results: GUESS - over_chance(split, seen("frozen", data=COARSE))(results)


def earlier_change_more(results):
    """(k,): minus the rank correlation of a convolution's depth with its change, a training."""
    changes = layer_changes(results)
    wanted = {"network": NETWORK, "mode": "finetuned", "weights": "imagenet", "data": FINE, "split": "random"}
    mine = changes[(changes[list(wanted)] == pd.Series(wanted)).all(axis=1)]
    if mine.empty:
        raise NotRun("MobileNetV2 was not fine-tuned", "transfer")
    return np.array([-spearmanr(np.arange(len(one)), one["value"])[0] for _, one in mine.groupby("trial", sort=False)])


OWN = [
    *both("tuned_over_frozen", "T5.4", "Fine-tuning on touch beats frozen filters.",
          "MobileNetV2, ImageNet's weights, fine-tuned minus frozen", compared(seen("finetuned"), seen("frozen"))),
    *both("frozen_over_chance", "T5.4", "Frozen visual filters tell simulated imprints apart better than guessing.",
          "MobileNetV2, ImageNet's weights, frozen minus chance", lambda split: over_chance(split, seen("frozen"))),
    *both("frozen_coarse_by_chance", "T5.4", "With 16 x 16 sensels frozen filters are hardly better than guessing.",
          f"MobileNetV2, 16 x 16, ImageNet's weights, {GUESS:g} points, the thesis's own largest lead, minus that of "
          "frozen filters", near_chance),
    *both("fine_over_coarse_frozen", "T5.4", "A finer array makes touch more like sight: frozen filters gain by it.",
          "MobileNetV2, frozen, 128 x 128 minus 16 x 16", compared(seen("frozen"), seen("frozen", data=COARSE))),
    *both("fine_over_coarse_tuned", "T5.6", "A finer array makes touch easier to recognise.",
          "MobileNetV2, fine-tuned, 128 x 128 minus 16 x 16",
          compared(seen("finetuned"), seen("finetuned", data=COARSE))),
    *both("seen_over_random_frozen", "T5.4", "Vision and touch share features: frozen filters learned by sight help.",
          "MobileNetV2, frozen, ImageNet's minus random weights", compared(seen("frozen"), seen("frozen", "random"))),
    *both("seen_over_random_tuned", "T5.4", "Vision and touch share features: sight is a better start for touch.",
          "MobileNetV2, fine-tuned for ten epochs, ImageNet's minus random weights",
          compared(seen("finetuned"), seen("finetuned", "random"))),
    *both("early_and_late", "T5.5", "Tuning the first and the last layers alone beats frozen filters.",
          "MobileNetV2, layers 18 to 139 frozen minus all frozen", compared(seen("18:139"), seen("frozen"))),
    *both("middle_frozen", "T5.5", "With layers 18 to 139 frozen touch is recognised as well as with all layers tuned.",
          "MobileNetV2, layers 18 to 139 frozen minus all tuned, plus the one point that may be lost", within_a_point),
]  # fmt: skip
EARLY = [  # by layers that this run does not freeze
    *both("early_decisive", "T5.5", "The early layers are decisive: tuning them too beats tuning the last ones alone.",
          "MobileNetV2, layers 18 to 139 frozen minus 1 to 134 frozen", compared(seen("18:139"), seen("1:134"))),
]  # fmt: skip
CLAIMS = [
    *OWN,
    Claim(
        "earlier_change_more", "T5.4", "Earlier convolutions are altered more for touch than later ones.",
        "MobileNetV2, fine-tuned, minus the rank correlation of depth and change", "rank correlation", "repetitions",
        earlier_change_more, HOLD_OUT,
    ),
    *on_their_classes([*OWN, *EARLY]),
]  # fmt: skip
