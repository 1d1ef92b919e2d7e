"""Settings of the weights stage."""

from dataclasses import dataclass


@dataclass
class Params:
    """Which weights the method `enhanced` takes."""

    method: str  # gaze (learned from human gaze, comes with the package) or fixations (learned from this data set)
