"""The inner loops of detectors: compiled kernels on plain arrays."""

from .gaussian import gaussian_sums
from .peaks import scale_peaks
from .suppress import suppress

__all__ = ["gaussian_sums", "scale_peaks", "suppress"]
