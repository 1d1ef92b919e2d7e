"""The nine channels of many views at once, on tensors: the same maps as stages.conspicuity, on CPU or GPU.

Nothing else in the project imports this package, so that torch is loaded where it is asked for and nowhere else.
"""

from .maps import conspicuity_batch

__all__ = ["conspicuity_batch"]
