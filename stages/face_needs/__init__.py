"""How many faces an object needs to be seen, to be felt and to be recognised by touch: no more than a task needs."""

from dataclasses import dataclass

COLUMNS = {
    "task": "seen, felt or recognised",
    "condition": "metres to the camera, or the largest difference of the reading, or the accuracy given up",
}


@dataclass
class Params:
    """Section `face_needs` of params.yaml."""

    distances: list[float]  # metres from which an object is seen, all round
    views: int  # cameras around the object
    screen: list[int]  # rows, columns of the screen in pixels
    angle: float  # vertical view angle in degrees
    tolerance: float  # pixels that the picture may be displaced
    detector: str  # whose places are touched, one of salient_points.methods
    touches: int  # places an object, at most
    cells: list[int]  # rows, columns of the pressure array
    pitch: float  # distance of two sensels
    readings: list[float]  # root mean square differences of the reading that pass for the same, share of full scale
    slack: float  # accuracy that the simplified model may lack of the full one's
    folds: int  # parts of the places, of which each is held out once
    repetitions: int  # foldings
