"""Classification of objects by following a contour: networks and conventional classifiers (T4.4.7 to T4.4.10).

Public names: directional_std, sequence_features, series, ImageNet, NormalNet.
"""

from typing import TYPE_CHECKING

from .contourlet import directional_std
from .series import sequence_features, series

if TYPE_CHECKING:
    from .networks import ImageNet, NormalNet

__all__ = ["ImageNet", "NormalNet", "directional_std", "sequence_features", "series"]


def __getattr__(name: str) -> object:
    # torch takes seconds to import, and whoever reads only the schema does without it.
    if name not in ("ImageNet", "NormalNet"):
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from . import networks

    return getattr(networks, name)
