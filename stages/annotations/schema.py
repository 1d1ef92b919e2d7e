"""The settings of the annotations stage; its rows hold the common columns alone."""

from dataclasses import dataclass


@dataclass
class Params:
    """Section `annotations` of params.yaml."""

    near: float  # distance, share of the diagonal, within which two marks are of the same place
    draws: int  # random draws of as many vertices, for what chance gives
