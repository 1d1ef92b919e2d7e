"""Recognises the objects of a data set by touch (T4.2)."""

from dataclasses import dataclass

COLUMNS = {
    "variant": "plain, or the name of a further experiment: see stages/classification/trials.py",
    "set": "number of a random set of objects, of those that are drawn",
    "scaling": "of samples before the classifier: a name of haptic_glance.know.classifiers.SCALINGS",
    "classifier": "a name of haptic_glance.know.CLASSIFIERS",
    "repetition": "number of the random split",
    "imprints": "samples that were trained and tested on",
}


@dataclass
class Params:
    """Section `classification` of params.yaml."""

    sets: dict[str, list[str]]  # name of the set: its objects, each with imprints in data/SET/imprints
    drawn: int
    classifiers: list[str]  # names of haptic_glance.know.CLASSIFIERS
    repetitions: int
    closer: list[str]
    touches: list[int]
    combinations: int
