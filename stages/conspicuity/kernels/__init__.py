"""What every pixel of a map asks for: compiled kernels on plain arrays."""

from .entropy import window_entropy
from .peaks import mean_of_maxima, mean_of_other_maxima
from .surface import locate_pixels

__all__ = ["locate_pixels", "mean_of_maxima", "mean_of_other_maxima", "window_entropy"]
