"""Kernels compiled by numba, which caches them on disk between runs."""

import functools
import hashlib
import types
import uuid
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numba
import numpy as np
from numba.core.caching import IndexDataCacheFile

from .cache_folder import cache_folder

# error_model: divides as numpy does, with no branch on zero. The wrappers that are left out have no caller, and would
# take a tenth of the time to compile.
OPTIONS: dict[str, Any] = {"nogil": True, "error_model": "numpy", "no_cfunc_wrapper": True}
HELPER = {"forceinline": True, "error_model": "numpy", "no_cfunc_wrapper": True, "no_cpython_wrapper": True}
helper = numba.njit(**HELPER)  # for what kernels alone call: typed once for all of them, and cached with them
config: Any = getattr(numba, "config")  # noqa: B009  # numba does not declare it


@functools.cache
def kernel_folder() -> Path:
    """Where kernels are cached.

    numba renews a kernel when its own file changes, not when a helper of another file does. So the folder's name is a
    digest of this file and of all folders `kernels`, whose files call each other.
    """
    sources = [Path(__file__), *sorted(Path(__file__).parents[1].rglob("kernels/*.py"))]
    digest = hashlib.sha256(b"".join(path.read_bytes() for path in sources)).hexdigest()[:12]
    return Path(config.CACHE_DIR or cache_folder() / "kernels") / digest


class _CacheFiles(IndexDataCacheFile):
    """numba's cache of a kernel, with a unique name for each file of machine code.

    numba numbers these files. Two processes that compile a kernel for different types at once would take one number,
    and the index could then name the code of the one for the types of the other.
    """

    def _data_name(self, number: int) -> str:
        return super()._data_name(number).replace(f".{number}.nbc", f".{uuid.uuid4().hex}.nbc")


def cached_njit(**options: Any) -> Callable[[Callable[..., Any]], Any]:
    """The decorator of a kernel that is cached in `kernel_folder()`; options are numba's.

    Where that folder is read-only numba caches beside the source or in its own folder, and if it cannot do that either
    each process compiles anew.
    """

    def decorate(function: Callable[..., Any]) -> Any:
        kernel: Any = numba.njit(**OPTIONS, **options)(function)
        if kernel is function:  # NUMBA_DISABLE_JIT is set
            return kernel
        before, config.CACHE_DIR = config.CACHE_DIR, str(kernel_folder())  # read by enable_caching alone
        try:
            kernel.enable_caching()
            kernel._cache._cache_file.__class__ = _CacheFiles
        except RuntimeError:  # no folder can be written to
            pass
        finally:
            config.CACHE_DIR = before
        return kernel

    return decorate


@helper
def lesser(a: Any, b: Any) -> Any:
    """min(a, b), which numba would compile with wrappers, anew for each pair of types and each literal."""
    return b if b < a else a


@helper
def greater(a: Any, b: Any) -> Any:
    """max(a, b), compiled in less time than numba's."""
    return b if b > a else a


class UntilWorthCompiling:
    """A kernel that is interpreted while its compilation would take longer than the work.

    Both give the same numbers, bit for bit. A first imprint then takes tenths of a second instead of three seconds.

    kernel: of `cached_njit`; budget: work of one process up to which it is interpreted, in any unit. A kernel that is
    cached on disk is never interpreted.
    """

    def __init__(self, kernel: Any, budget: float) -> None:
        self._kernel, self._left = kernel, budget

    def compile_always(self) -> None:
        """Ends interpretation, before time is measured or much is done."""
        self._left = 0

    def for_work(self, work: float) -> Callable[..., Any]:
        """The kernel, or its interpreted twin, for so much work."""
        if self._left > 0:
            cached = any(kernel_folder().rglob(f"*.{self._kernel.__name__}-*.nbc"))
            self._left = 0 if cached else self._left - work
        return self._kernel if self._left <= 0 else interpreted(self._kernel)


@functools.cache
def interpreted(kernel: Any) -> Callable[..., Any]:
    """The Python function behind a kernel, and behind all kernels that it calls."""
    plain = _plain(kernel)

    def run(*arguments: Any) -> Any:
        with np.errstate(all="ignore"):  # as compiled
            return plain(*arguments)

    return run


@functools.cache
def _plain(kernel: Any) -> Any:
    function = getattr(kernel, "py_func", kernel)
    names = {name: function.__globals__.get(name) for name in function.__code__.co_names}
    plain = {name: _plain(value) for name, value in names.items() if hasattr(value, "py_func")}
    return types.FunctionType(function.__code__, function.__globals__ | plain, function.__name__)
