"""Claims of T5.4 on recorded touches: what filters learned by sight are worth on a pressure array and on fingertips."""

import numpy as np

from stages.kit.split import Split
from stages.report.claims import POINTS
from stages.report.networks import GUESS, NETWORK, PRINTED
from stages.report.results import NotRun
from stages.report.style import label, start
from stages.report.verdict import FunctionClaim as Claim

from .pairs import CLASSICAL, OVER, accuracies, gain, guesses, shared
from .rows import DATA, SPLITS

SIZES = {"frozen": 96, "finetuned": 64}  # pixels a side that recorded_networks shows to networks
SETTINGS = {
    "pressure_random": ("pressure", Split.RANDOM),
    "pressure_runs": ("pressure", Split.BLOCKS),
    "fingers_random": ("grasps_object", Split.RANDOM),
    "fingers_runs": ("grasps_object", Split.BLOCKS),
    "fingers_slip": ("grasps_slip", Split.TEST_OBJECTS),
}  # name in the key of a claim -> (data, split)
ARRAY = list(SETTINGS)[:2]


def trained(mode, weights="imagenet", network=NETWORK):
    """A way of training: the end of a key of `accuracies`."""
    return network, weights, mode, SIZES[mode]


def between(first, second):
    """setting -> differences(results): accuracy trained the `first` way minus the `second`, on the same splits."""

    def of(setting):
        def differences(results):
            found = accuracies(results)
            for way in (first, second):
                _measured(found, setting, way)
            return 100 * gain(found, (*setting, *first), (*setting, *second)).to_numpy()

        return differences

    return of


def over_guessing(setting):
    """differences(results): accuracy of frozen filters minus what guessing gets right."""

    def differences(results):
        mine = _measured(accuracies(results), setting, trained("frozen"))
        return 100 * (mine - guesses(results, *setting)).dropna().to_numpy()

    return differences


def near_guessing(setting):
    """differences(results): GUESS minus the lead of frozen filters over guessing."""
    return lambda results: GUESS - over_guessing(setting)(results)


def over_untrained(setting):
    """differences(results): frozen, ImageNet's minus random weights, a network; each the mean over its splits."""

    def differences(results):
        found, gains = accuracies(results), []
        for network in dict.fromkeys(key[2] for key in found):
            pair = [(*setting, *trained("frozen", weights, network)) for weights in ("imagenet", "random")]
            gains.append(100 * gain(found, *pair).mean())  # NaN without either
        gains = np.array(gains)
        if not np.isfinite(gains).any():
            raise NotRun(f"no network from random weights; {_where(setting)}", "recorded_networks", runnable=False)
        return gains[np.isfinite(gains)]

    return differences


def best(network, mode):
    """setting -> differences(results): a network minus the best of the thesis's others by their means."""

    def of(setting):
        def differences(results):
            found = accuracies(results)
            mine = _measured(found, setting, trained(mode, network=network))
            others = [found.get((*setting, *trained(mode, network=one))) for one in PRINTED if one != network]
            others = [values for values in others if values is not None]
            if not others:
                raise NotRun(f"only one network; {_where(setting)}", "recorded_networks", runnable=False)
            return 100 * (mine - max(others, key=lambda values: values.mean())).dropna().to_numpy()

        return differences

    return of


def _measured(found, setting, way):
    """The accuracies of a way of training; NotRun, with what is missing, without it."""
    if (*setting, *way) not in found:
        network, weights, mode, size = way
        said = f"{label(network)}, {label(mode)}, from {start(weights)}, {size} pixels" if mode else "features and kNN"
        raise NotRun(f"no {said}; {_where(setting)}", "recorded_networks")
    return found[(*setting, *way)]


def _where(setting):
    data, split = setting
    return f"{DATA[data]}, {SPLITS[split]}"


def claims(key, section, sentence, tested_on, differences, over=None, names=SETTINGS):
    """The claim on each of the settings `names`. over: what the pairs are, if not the repetitions or objects."""
    for name in names:
        setting = SETTINGS[name]
        units, part = over or ("objects" if setting[1] in OVER else "repetitions"), 0.0 if over else shared(setting[1])
        where = f"{tested_on}; {_where(setting)}"
        yield Claim(f"recorded_{key}_{name}", section, sentence, where, POINTS, units, differences(setting), part)


FROZEN, TUNED = trained("frozen"), trained("finetuned")
SHARED = "Vision and touch share features:"
CLAIMS = [
    *claims("frozen_over_guessing", "T5.4", "Frozen visual filters tell recorded touches apart better than guessing.",
            "MobileNetV2, frozen, ImageNet's weights, minus guessing", over_guessing),
    *claims("frozen_by_guessing", "T5.4", "On a pressure array frozen visual filters are hardly better than guessing.",
            f"28 x 50 cells, the thesis has 16 x 16; {GUESS:g} points, its own largest lead, minus that of MobileNetV2",
            near_guessing, names=ARRAY),
    *claims("seen_over_random_frozen", "T5.4", f"{SHARED} frozen filters learned by sight help with recorded touches.",
            "MobileNetV2, frozen, ImageNet's minus random weights", between(FROZEN, trained("frozen", "random"))),
    *claims("seen_over_random_networks", "T5.4", f"{SHARED} frozen filters learned by sight help, whichever network.",
            "each network that was run, frozen, ImageNet's minus random weights", over_untrained, "networks", ARRAY),
    *claims("seen_over_random_tuned", "T5.4", f"{SHARED} sight is a better start for recorded touches.",
            "MobileNetV2, fine-tuned, ImageNet's minus random weights", between(TUNED, trained("finetuned", "random"))),
    *claims("tuned_over_frozen", "T5.4", "Fine-tuning on recorded touches beats frozen filters.",
            "MobileNetV2, ImageNet's weights, fine-tuned on 64 pixels a side minus frozen on 96",
            between(TUNED, FROZEN)),
    *claims("resnet_best", "T5.4", "ResNet50 is the best of the networks on recorded touches.",
            "frozen, ImageNet's weights, ResNet50 minus the best of the thesis's others that were run (best in "
            "these tests, which is hard on ResNet50)",
            best("resnet50", "frozen"), names=ARRAY),
    *claims("frozen_over_features", "ours", "Frozen visual filters beat hand-made features on recorded touches.",
            "MobileNetV2, frozen, ImageNet's weights, minus features and kNN", between(FROZEN, CLASSICAL)),
]  # fmt: skip
