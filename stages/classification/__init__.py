"""Recognises the objects of a data set by touch (T4.2)."""

from collections.abc import Container
from dataclasses import dataclass

from stages.engine.settings import REQUIRED, setting

COLUMNS = {
    "variant": "plain, or the name of a further experiment: see stages/classification/touch_trials.py",
    "set": "number of a random set of objects, of those that are drawn",
    "scaling": "of samples before the classifier: a name of haptic_glance.know.classifiers.SCALINGS",
    "classifier": "a name of haptic_glance.know.CLASSIFIERS",
    "repetition": "number of the random split",
    "imprints": "samples that were trained and tested on",
}


def classifier_names() -> Container[str]:
    """Classifiers of touches."""
    from haptic_glance.know.classifiers import CLASSIFIERS

    return CLASSIFIERS


@dataclass
class Params:
    """Section `classification` of params.yaml."""

    sets: dict[str, list[str]] = setting(
        REQUIRED,
        "name of the set: its objects, each with imprints in data/SET/imprints",
    )
    drawn: int = setting(
        0,
        "number of random sets that replace the named sets, with as many objects each; 0: use the named sets",
        least=0,
    )
    classifiers: list[str] = setting(REQUIRED, "names of haptic_glance.know.CLASSIFIERS", names=classifier_names)
    repetitions: int = setting(
        20,
        "random hold-outs and foldings, the same for every sampling and classifier; the intervals are over these",
        least=1,
    )
    closer: list[str] = setting(
        ["glance", "random"],
        "samplings studied closer: selection, and several touches of the first set; the first in full",
    )
    touches: list[int] = setting([1, 2, 3, 4, 5], "numbers of touches that form one sample (T table 4.6)", least=1)
    combinations: int = setting(4, "samples of several touches that start with the same imprint", least=1)
