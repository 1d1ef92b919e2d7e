"""The nine channels for a batch of views, on tensors: the same maps as stages.conspicuity, on CPU or GPU.

No other package imports this one, so that torch is loaded only where it is needed.
"""

from .maps import conspicuity_batch

__all__ = ["conspicuity_batch"]
