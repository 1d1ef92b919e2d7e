"""The inner loops of detectors: compiled kernels on plain arrays."""

from .gaussian import gaussian_sums
from .suppress import suppress

__all__ = ["gaussian_sums", "suppress"]
