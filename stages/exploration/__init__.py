"""Touches objects until the belief is strong (T4.2.3.5)."""

from dataclasses import dataclass

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

    sets: list[str]
    methods: list[str]
    confidences: list[float]
    most: int
    repetitions: int
