"""Looks once, then touches where the candidates differ (T5.6, T6.3)."""

from dataclasses import dataclass

from stages.engine.settings import setting

COLUMNS = {
    "sight": "what was seen before the first touch: a name of stages.look_and_touch.protocol.SIGHTS",
    "touches": "number of touches before the answer",
    "perturbation": "what is harder than usual: a name of stages.look_and_touch.measure.PERTURBATIONS; none",
    "severity": "in the perturbation's own unit; 0 for none",
    "stated": "mean probability of the answers of a bin",
    "answers": "number of answers in a bin",
}


def _perturbations():
    from stages.look_and_touch.measure import PERTURBATIONS

    return PERTURBATIONS


@dataclass
class Params:
    """Section `look_and_touch` of params.yaml."""

    poses: int = setting(1, "drawn poses of each object", least=1)
    touches: int = setting(6, "touches of each pose", least=1)
    picture_seconds: float = setting(0.1, "what a picture costs a robot", least=0)
    touch_seconds: float = setting(5.0, "what a touch costs a robot", least=0)
    disturbed: bool = setting(True, "whether looks and touches are also disturbed")
    severities: dict[str, list[float]] = setting(
        {
            "hidden": [0.7, 0.8, 0.9, 0.95],  # share of the object's pixels
            "darkness": [0.5, 0.8, 0.9, 0.95, 0.98],  # share of the light that is absent
            "noise": [3.0, 6.0, 12.0],  # times the sensor's
            "position": [0.03, 0.06, 0.12],  # diameters
            "size": [1.05, 1.1, 1.2, 1.4],  # times the known mesh's
            "coarse_mesh": [2000.0, 500.0, 200.0, 100.0, 50.0],  # faces of the known meshes
        },
        "of each perturbation, in its own unit, from mild to harsh",
        names=_perturbations,
    )
