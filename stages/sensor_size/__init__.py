"""The size and resolution that a pressure array needs to classify objects (T4.3.2, figure 4.11)."""

from dataclasses import dataclass

from stages.engine.settings import setting

COLUMNS = {
    "classifier": "a name of stages.sensor_size.protocol.CLASSIFIERS",
    "cells": "sensels along each side of the array",
    "pitch": "distance of two sensels, in units of the mesh",
    "fine": "CELLS-PITCH of a second, finer array that is pressed at the same place; empty: none",
    "extent": "where the touches of a sample lie: points, region or disc; empty: one touch a sample",
    "touches": "imprints per object at most",
    "set": "number of a random set of classes, of those that are drawn",
    "fold": "number of the round in which the item was tested",
}


def _extents():
    from stages.sensor_size.protocol import EXTENTS

    return EXTENTS


def _classifiers():
    from stages.sensor_size.protocol import CLASSIFIERS

    return CLASSIFIERS


@dataclass
class Params:
    """Section `sensor_size` of params.yaml."""

    classes: list[str] = setting([], "of meshes.classes, which to recognise; all when empty")
    drawn: int = setting(
        0,
        "number of random sets of four classes of three objects (T figure 4.10) that replace the whole; 0: the whole",
        least=0,
    )
    method: str = setting("thesis_ssim", "where to touch: a method of salient_points.methods")
    touches: int = setting(60, "imprints per object, at its most salient points", least=1)
    cells: list[int] = setting([8, 16, 32, 64], "sensels a side; the thesis has 16 and 32 (T figure 4.11)", least=1)
    pitches: list[float] = setting(
        [0.002, 0.005, 0.01, 0.02],
        "distances of two sensels; the thesis has 0.002 and 0.01",
        above=0,
    )
    pairs: list[str] = setting(
        [],
        "two arrays of one hand, CELLS-PITCH+CELLS-PITCH, pressed at the same place (T6.3): experiment=hands",
    )
    extents: list[str] = setting(
        [],
        "where the five touches that vote on one answer lie: points, region or disc (T6.3): experiment=hands",
        names=_extents,
    )
    classifiers: list[str] = setting(
        ["knn", "svm", "decision_tree", "deep_learning"],
        "names of CLASSIFIERS in stages/sensor_size/protocol.py (T4.3.1)",
        names=_classifiers,
    )
    slack: float = setting(0.02, "accuracy that the smallest sensor may lose against the best sensor", least=0)
