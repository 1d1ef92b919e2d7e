"""The settings of the sensor_size stage."""

from dataclasses import dataclass


@dataclass
class Params:
    """Section `sensor_size` of params.yaml."""

    classes: list[str]  # of the classes stage, which to tell apart; all when empty
    method: str  # where to touch: a detector of classes.methods
    touches: int  # imprints an object, its most salient points
    cells: list[int]  # sensels a side that are tried
    pitches: list[float]  # distances of two sensels that are tried, in units of the mesh
    classifiers: list[str]  # names of stages.sensor_size.CLASSIFIERS
    slack: float  # accuracy that the smallest sensor may lack of the best one's
