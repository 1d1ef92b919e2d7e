"""Computes the conspicuity maps of a data set."""

from dataclasses import dataclass

COLUMNS = {"viewpoint": "name of the viewpoint of the map"}


@dataclass
class Params:
    """Section `conspicuity` of params.yaml."""

    channels: list[str]  # which of the nine to work out, in this order
    size: list[int]  # rows, columns of the stored maps
    background: str  # filled: kept out of every filter; kept: filtered as rendered, as in the thesis
    symmetry: str  # perceived: only symmetries that people see; strongest: the best plane and axis of each object
    formulas: str  # ours; printed: those of the thesis to the letter; mended: the same without its two slips
    compare_background: bool  # also measure, on one view an object, the background left as rendered, and hues left out
