"""Computes the conspicuity maps of a data set."""

from dataclasses import dataclass

from stages.engine.settings import setting

COLUMNS = {"viewpoint": "name of the viewpoint of the map"}


def _channels():
    from haptic_glance.look.channels.channels import MAPS

    return MAPS


def _background():
    from haptic_glance.look.channels.cropped_view import BACKGROUNDS

    return BACKGROUNDS


def _symmetry():
    from haptic_glance.look.channels.channels import SYMMETRIES

    return SYMMETRIES


def _formulas():
    from haptic_glance.look.channels.printed import FORMULAS

    return FORMULAS


@dataclass
class Params:
    """Section `conspicuity` of params.yaml."""

    channels: list[str] = setting(
        ["color", "contrast", "curvature", "dkl", "edge", "entropy", "intensity", "orientation", "symmetry"],
        "which channels to compute, in this order",
        names=_channels,
    )
    size: list[int] = setting([225, 300], "rows, columns of the stored maps: a quarter of the views'", least=1)
    background: str = setting(
        "filled",
        "filled (kept out of every filter) or kept (filtered as rendered, as in the thesis)",
        names=_background,
    )
    symmetry: str = setting(
        "perceived",
        "perceived (only symmetries that people see) or strongest (the best plane and axis of each object, T3.1.5)",
        names=_symmetry,
    )
    formulas: str = setting(
        "ours",
        "ours, printed (as in the thesis), mended (printed without its two errors) or zero_mean (printed, with Gabor "
        "kernels of sum zero); all but ours need background: kept",
        names=_formulas,
    )
    compare_background: bool = setting(
        True,
        "also measure, on one view an object, the maps with the black background left in, and without hues",
    )
