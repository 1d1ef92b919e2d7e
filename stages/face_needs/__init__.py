"""How many faces an object needs to be seen, to be felt and to be recognised by touch: no more than a task needs."""

from dataclasses import dataclass

COLUMNS = {
    "task": "seen, felt or recognised",
    "condition": "metres to the camera, or the largest difference of the reading, or the accuracy given up",
}


@dataclass
class Params:
    """Section `face_needs` of params.yaml."""

    distances: list[float]
    views: int
    screen: list[int]
    angle: float
    tolerance: float
    detector: str
    touches: int
    cells: list[int]
    pitch: float
    readings: list[float]
    slack: float
    folds: int
    repetitions: int
