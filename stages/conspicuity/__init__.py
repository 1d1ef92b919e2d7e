"""Computes the conspicuity maps of a data set."""

from dataclasses import dataclass

COLUMNS = {"viewpoint": "name of the viewpoint of the map"}


@dataclass
class Params:
    """Section `conspicuity` of params.yaml."""

    channels: list[str]
    size: list[int]
    background: str
    symmetry: str
    formulas: str
    compare_background: bool
