"""How well marks of salient places agree with each other and with human gaze."""

from dataclasses import dataclass

from stages.engine.settings import setting


@dataclass
class Params:
    """Section `annotations` of params.yaml."""

    near: float = setting(
        0.05,
        "distance, share of the diagonal, within which two marks are of the same place",
        above=0,
    )
    draws: int = setting(20, "random draws of as many vertices, for what chance gives", least=1)
