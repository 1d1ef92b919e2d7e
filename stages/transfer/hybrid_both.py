"""Accuracy with both senses at the same time, undamaged, damaged or missing, by way of fusion (beyond T5.5)."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
import torch

from haptic_glance.base.rng import rng
from haptic_glance.deep.device import device_of
from haptic_glance.deep.hybrid import HybridNet, join_senses
from haptic_glance.deep.pictures import as_images
from haptic_glance.disturb.picture import IMPRINT, MISSING, PICTURE, damage

from . import fusion
from .hybrid_data import SenseData, pair_pictures
from .hybrid_scores import in_batches, row, sense_scores
from .schema import Params

UNDAMAGED = "none"  # the perturbation in rows without any


def fused_rows(
    hybrid: HybridNet, senses: Sequence[SenseData], settings: Params, random: np.random.Generator, seed: int
) -> Iterator[dict]:
    """Rows of the accuracy with both senses under every condition; each test touch has a picture of the same object."""
    vision, touch = senses
    paired = vision.test[pair_pictures(vision.objects[vision.test], touch.objects[touch.test], random)]
    raw, labels = (vision.raw[paired], touch.raw[touch.test]), touch.labels[touch.test]
    undamaged = [as_images(one, settings.size) for one in raw]
    clean = [sense_scores(hybrid, one, kind) for kind, one in enumerate(undamaged)]
    better = better_sense(hybrid, senses)
    for name, severity in conditions(settings.hybrid_severities):
        images, apart = list[torch.Tensor | None](undamaged), list(clean)
        if name != UNDAMAGED:
            kind = int(name.startswith(IMPRINT))
            damaged = damage(raw[kind], name, severity, rng(seed, f"{name} {severity}"))
            images[kind], apart[kind] = None, np.full_like(clean[kind], np.nan)
            if damaged is not None:
                images[kind] = changed = as_images(damaged, settings.size)
                apart[kind] = sense_scores(hybrid, changed, kind)
        summed = in_batches(hybrid, join_senses(*images), device_of(hybrid))
        for method, probabilities in method_probabilities(apart, summed, hybrid.temperature.tolist(), better).items():
            found = row(method, "accuracy", fusion.accuracy(probabilities, labels)) | {"sense": "both"}
            yield found | {"perturbation": name, "severity": severity}


def conditions(severities: Mapping[str, Sequence[float]]) -> list[tuple[str, float]]:
    """(name, severity) of all conditions: undamaged, each perturbation, and each sense missing."""
    found = [(name, severity) for name, every in severities.items() for severity in every]
    return [(UNDAMAGED, 0.0), *found, (PICTURE + MISSING, 1.0), (IMPRINT + MISSING, 1.0)]


def better_sense(hybrid: HybridNet, senses: Sequence[SenseData]) -> int:
    """The sense, 0 or 1, with the higher accuracy on the validation items."""
    own = [
        fusion.accuracy(sense_scores(hybrid, s.images[s.validation], kind), s.labels[s.validation])
        for kind, s in enumerate(senses)
    ]
    return int(own[1] > own[0])


def method_probabilities(
    apart: Sequence[np.ndarray], summed: Sequence[np.ndarray], temperatures: Sequence[float], better: int
) -> dict[str, np.ndarray]:
    """{method: probabilities (n, k)} of every method; NaN where it gives none.

    apart, summed: scores (n, k) of the two heads, each on its own stream, and on the sum of both as in the thesis. The
    methods are vision and touch alone, the sense that `better` names, the fusions of both, one of them without
    temperatures, and for the sum its two heads and their mean.
    """
    alone, heads = (
        [fusion.probabilities(scores, value) for scores, value in zip(both, temperatures, strict=True)]
        for both in (apart, summed)
    )
    found = {"vision": alone[0], "touch": alone[1], "better_sense": alone[better]}
    found |= {f"fusion_{rule}": fusion.fuse(alone[0], alone[1], rule) for rule in fusion.FUSIONS}
    found["fusion_entropy_raw"] = fusion.fuse(fusion.probabilities(apart[0]), fusion.probabilities(apart[1]), "entropy")
    return found | {"sum_vision": heads[0], "sum_touch": heads[1], "sum_mean": fusion.fuse(heads[0], heads[1], "mean")}
