"""How this folder's kernels are compiled."""

from stages.kit.jit import inlined, kept_in, kernel_of

# Inlined throughout: a call hands over seven words for each array, which took as long as the work.
kernel = kernel_of(__file__, forceinline=True)
FOLDER = kept_in(__file__)

__all__ = ["FOLDER", "inlined", "kernel"]
