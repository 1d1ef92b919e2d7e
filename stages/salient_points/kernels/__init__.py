"""The inner loops of detectors: compiled kernels on plain arrays."""

from .fpfh import fpfh
from .gaussian import gaussian_sums
from .peaks import scale_peaks
from .pressed import pressed
from .spaced import spaced
from .spin import spin_images
from .splat import splat
from .suppress import suppress

__all__ = ["fpfh", "gaussian_sums", "pressed", "scale_peaks", "spaced", "spin_images", "splat", "suppress"]
