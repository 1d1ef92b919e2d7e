"""The size and resolution that a pressure array needs to classify objects (T4.3.2, figure 4.11)."""

from dataclasses import dataclass

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


@dataclass
class Params:
    """Section `sensor_size` of params.yaml."""

    classes: list[str]
    drawn: int
    method: str
    touches: int
    cells: list[int]
    pitches: list[float]
    pairs: list[str]
    extents: list[str]
    classifiers: list[str]
    slack: float
