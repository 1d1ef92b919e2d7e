"""How this folder's kernels are compiled."""

from stages.kit.jit import helper, kernel_of

kernel = kernel_of(__file__)

__all__ = ["helper", "kernel"]
