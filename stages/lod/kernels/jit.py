"""How this folder's kernels are compiled."""

from collections.abc import Callable
from typing import TypeVar

import numpy as np

from stages.kit.jit import inlined, kept_in, kernel_of

Id = int | np.integer  # of a vertex, half-edge, face or bucket
Result = TypeVar("Result")

# Inlined throughout: a call passes seven words for each array, which took as long as the work.
_compiled = kernel_of(__file__, forceinline=True)
FOLDER = kept_in(__file__)


def kernel(function: Callable[..., Result]) -> Callable[..., Result]:
    """The function compiled, for arguments of any numeric type."""
    return _compiled(function)


__all__ = ["FOLDER", "Id", "inlined", "kernel"]
