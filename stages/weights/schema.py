"""Settings of the weights stage."""

from dataclasses import dataclass


@dataclass
class Params:
    """Which weights are written, and which of them the saliency map uses."""

    methods: list[str]  # all that are written, for comparison: equal, thesis_ssim, thesis_ed
    method: str  # the one that the method `enhanced` of salient_points uses
