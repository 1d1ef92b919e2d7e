"""How many faces an object needs to be seen, to be felt and to be recognised by touch: no more than a task needs."""

from dataclasses import dataclass

from stages.engine.settings import setting

COLUMNS = {
    "task": "seen, felt or recognised",
    "condition": "metres to the camera, or the largest difference of the reading, or the accuracy given up",
}


@dataclass
class Params:
    """Section `face_needs` of params.yaml."""

    distances: list[float] = setting([0.5, 1.0, 2.0], "metres from which an object is seen, all round", above=0)
    views: int = setting(6, "cameras around the object", least=1)
    screen: list[int] = setting([360, 640], "rows, columns of the screen", least=1)
    angle: float = setting(40, "vertical view angle in degrees", above=0, most=180)
    tolerance: float = setting(
        1.0,
        "pixels that the picture may be displaced: the 99 % quantile over an object's pixels",
        above=0,
    )
    detector: str = setting("glance", "whose places are touched, one of salient_points.methods")
    touches: int = setting(60, "places an object, at most", least=1)
    cells: list[int] = setting([16, 16], "rows, columns of the pressure array (T4.3.1)", least=1)
    pitch: float = setting(0.01, "distance of two sensels, in units of the normalised mesh", above=0)
    readings: list[float] = setting(
        [0.02, 0.05, 0.1],
        "root mean square differences of readings that count as equal, share of full scale",
    )
    slack: float = setting(0.02, "accuracy that the simplified model may lose against the full model", least=0)
    folds: int = setting(5, "folds of the places; each fold is held out once", least=2)
    repetitions: int = setting(4, "foldings", least=1)
