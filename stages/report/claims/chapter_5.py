"""Claims of chapter 5: what a network learned by sight is worth for touch."""

from stages.report.intervals import HOLD_OUT
from stages.report.verdict import Claim, paired

OVER = ["object", "method", "repetition"]
NETWORK = "mobilenet_v2"


def between(first, second):
    """differences(results): accuracy with the setting `first` minus with `second`, a repetition."""

    def differences(results):
        sides = {"first": {"metric": "accuracy"} | first, "second": {"metric": "accuracy"} | second}
        return 100 * paired(results, "transfer", OVER, **sides, method=NETWORK).to_numpy()

    return differences


def over_chance(setting):
    """differences(results): accuracy minus chance."""

    def differences(results):
        sides = {"first": {"metric": "accuracy"}, "second": {"metric": "chance"}}
        return 100 * paired(results, "transfer", OVER, **sides, **setting, method=NETWORK).to_numpy()

    return differences


def seen(mode, weights="imagenet"):
    """One setting of the network."""
    return {"weights": weights, "mode": mode}


def transfer_claim(key, section, sentence, tested_on, differences):
    """A claim on test accuracy; its pairs are repetitions over the same imprints."""
    return Claim(key, section, sentence, tested_on, "points of accuracy", "repetitions", differences, HOLD_OUT)


CLAIMS = [
    transfer_claim(
        "tuned_over_frozen", "T5.4", "Fine-tuning on touch beats frozen filters.",
        "MobileNetV2, ImageNet weights, fine-tuned minus frozen", between(seen("finetuned"), seen("frozen")),
    ),
    transfer_claim(
        "frozen_over_chance", "T5.4", "Frozen visual filters tell simulated imprints apart better than guessing.",
        "MobileNetV2, ImageNet weights, frozen minus chance", over_chance(seen("frozen")),
    ),
    transfer_claim(
        "seen_over_random_frozen", "T5.4", "Vision and touch share features: frozen filters learned by sight help.",
        "MobileNetV2 frozen, ImageNet minus random weights", between(seen("frozen"), seen("frozen", "random")),
    ),
    transfer_claim(
        "seen_over_random_tuned", "T5.4", "Vision and touch share features: sight is a better start for touch.",
        "MobileNetV2 fine-tuned, ImageNet minus random weights",
        between(seen("finetuned"), seen("finetuned", "random")),
    ),
]  # fmt: skip
