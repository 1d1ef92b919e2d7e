"""How this folder's kernels are compiled."""

from collections.abc import Callable
from typing import TypeVar

import numpy as np

from stages.kit import jit
from stages.kit.jit import inlined, kept_in, kernel_of

Id = int | np.integer  # of a vertex, half-edge, face or bucket
Result = TypeVar("Result")

# Inlined throughout: a call passes seven words for each array, which took as long as the work.
_compiled = kernel_of(__file__, forceinline=True, _nrt=False)
_allocating = kernel_of(__file__, forceinline=True)
FOLDER = kept_in(__file__)


def kernel(function: Callable[..., Result]) -> Callable[..., Result]:
    """The function compiled, for arguments of any numeric type; it makes no array."""
    return _compiled(function)


def allocating_kernel(function: Callable[..., Result]) -> Callable[..., Result]:
    """The same for one that makes arrays: to count references to them takes longer to compile."""
    return _allocating(function)


def helper(function: Callable[..., Result]) -> Callable[..., Result]:
    """The function compiled as a part of the kernels that call it."""
    return jit.helper(function)


__all__ = ["FOLDER", "Id", "allocating_kernel", "helper", "inlined", "kernel"]
