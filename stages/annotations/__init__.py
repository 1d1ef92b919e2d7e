"""How well marks of salient places agree with each other and with human gaze."""

from dataclasses import dataclass


@dataclass
class Params:
    """Section `annotations` of params.yaml."""

    near: float
    draws: int
