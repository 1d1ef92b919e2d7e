"""Both senses at once, whole, damaged or missing: what each way to join them recognises (beyond T5.5)."""

import numpy as np

from stages.kit.rng import rng
from stages.networks.device import device_of

from . import fusion
from .hybrid import join
from .hybrid_damage import IMPRINT, MISSING, PICTURE, damage
from .hybrid_data import as_images, pair
from .hybrid_scores import in_parts, row, scored

WHOLE = "none"  # the perturbation of senses that are as they should be


def fused(hybrid, senses, settings, random, seed):
    """Rows of the accuracy with both senses, under every condition: each test touch with a look at the same object."""
    vision, touch = senses
    looks = vision.test[pair(vision.objects[vision.test], touch.objects[touch.test], random)]
    raw, labels = (vision.raw[looks], touch.raw[touch.test]), touch.labels[touch.test]
    whole = [as_images(one, settings.size) for one in raw]
    clean = [scored(hybrid, one, kind) for kind, one in enumerate(whole)]
    better = better_sense(hybrid, senses)
    for name, severity in conditions(settings.hybrid_severities):
        images, apart = list(whole), list(clean)
        if name != WHOLE:
            kind = int(name.startswith(IMPRINT))
            worse = damage(raw[kind], name, severity, rng(seed, f"{name} {severity}"))
            images[kind] = None if worse is None else as_images(worse, settings.size)
            apart[kind] = np.full_like(clean[kind], np.nan)
            if worse is not None:
                apart[kind] = scored(hybrid, images[kind], kind)
        summed = in_parts(hybrid, join(*images), device_of(hybrid))
        for method, chances in answers(apart, summed, hybrid.temperature.tolist(), better).items():
            found = row(method, "accuracy", fusion.accuracy(chances, labels)) | {"sense": "both"}
            yield found | {"perturbation": name, "severity": severity}


def conditions(severities):
    """(name, severity) of all conditions: whole, each perturbation, and each sense missing."""
    found = [(name, severity) for name, every in severities.items() for severity in every]
    return [(WHOLE, 0.0), *found, (PICTURE + MISSING, 1.0), (IMPRINT + MISSING, 1.0)]


def better_sense(hybrid, senses):
    """Which of the two is right more often on the items that neither learned from."""
    own = [fusion.accuracy(scored(hybrid, s.images[s.check], kind), s.labels[s.check]) for kind, s in enumerate(senses)]
    return int(own[1] > own[0])


def answers(apart, summed, temperatures, better):
    """{method: probabilities (n, k)} of everything that answers; NaN where it says nothing.

    apart, summed: scores (n, k) of the two heads, each on its own stream, and on the sum of both, as the network of the
    thesis has it. vision and touch alone, the one that `better` names, the fusions of both, one of them without
    temperatures, and for the sum its two heads and their mean.
    """
    alone, heads = (
        [fusion.probabilities(scores, value) for scores, value in zip(both, temperatures, strict=True)]
        for both in (apart, summed)
    )
    found = {"vision": alone[0], "touch": alone[1], "better_sense": alone[better]}
    found |= {f"fusion_{rule}": fusion.fuse(*alone, rule) for rule in fusion.FUSIONS}
    found["fusion_entropy_raw"] = fusion.fuse(*map(fusion.probabilities, apart), "entropy")
    return found | {"sum_vision": heads[0], "sum_touch": heads[1], "sum_mean": fusion.fuse(*heads, "mean")}
