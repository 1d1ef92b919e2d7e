"""The inner loops that several stages share: compiled kernels on plain arrays."""

from .similarity import similarity

__all__ = ["similarity"]
