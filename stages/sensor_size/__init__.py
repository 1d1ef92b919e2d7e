"""The size and resolution that a pressure array needs to classify objects (T4.3.2, figure 4.11)."""

from dataclasses import dataclass

COLUMNS = {
    "classifier": "a name of stages.sensor_size.CLASSIFIERS",
    "cells": "sensels along each side of the array",
    "pitch": "distance of two sensels, in units of the mesh",
    "fine": "CELLS-PITCH of a second, finer array that is pressed at the same place; empty: none",
    "extent": "where the touches of a sample lie: points, region or disc; empty: one touch a sample",
    "touches": "imprints per object at most",
    "fold": "number of the round in which the item was tested",
}


@dataclass
class Params:
    """Section `sensor_size` of params.yaml."""

    classes: list[str]  # of meshes.classes, which to recognise; all when empty
    method: str  # where to touch: a method of salient_points.methods
    touches: int  # imprints per object, at its most salient points
    cells: list[int]  # sensels a side that are tried
    pitches: list[float]  # distances of two sensels that are tried, in units of the mesh
    pairs: list[str]  # two arrays of one hand, pressed at the same place: CELLS-PITCH+CELLS-PITCH, the fine one last
    extents: list[str]  # where the touches of a sample lie, which vote: names of stages.sensor_size.protocol.EXTENTS
    classifiers: list[str]  # names of stages.sensor_size.CLASSIFIERS
    slack: float  # accuracy that the smallest sensor may lack of the best one's
