"""How well marks of salient places agree with each other and with human gaze."""

from dataclasses import dataclass


@dataclass
class Params:
    """Section `annotations` of params.yaml."""

    near: float  # distance, share of the diagonal, within which two marks are of the same place
    draws: int  # random draws of as many vertices, for what chance gives
