"""Touches objects until the belief is strong (T4.2.3.5)."""

from dataclasses import dataclass

from stages.engine.settings import setting
from stages.salient_points import method_names

COLUMNS = {
    "likelihood": "what the belief is computed from: a name of haptic_glance.know.LIKELIHOODS",
    "way": "how the next place is chosen: a name of haptic_glance.know.STRATEGIES",
    "stop": "fixed: after `level` touches; confidence: at a belief of `level`",
    "level": "touches or belief at which touching stops",
    "repetition": "number of the random split",
    "touches": "mean number of touches",
    "belief": "mean belief in the likeliest object when touching stops",
    "decided": "share of explorations that reached the confidence",
}


@dataclass
class Params:
    """Section `exploration` of params.yaml."""

    sets: list[str] = setting(["six", "four"], "names of classification.sets whose objects are explored")
    methods: list[str] = setting(
        ["thesis_ssim", "glance", "random"],
        "of imprints.methods: where the objects may be touched",
        names=method_names,
    )
    confidences: list[float] = setting(
        [0.6, 0.8, 0.9, 0.95, 0.99],
        "belief in one object at which touching stops",
        least=0,
        most=1,
    )
    most: int = setting(12, "touches after which it stops in any case", least=1)
    repetitions: int = setting(20, "random hold-outs of places", least=1)
