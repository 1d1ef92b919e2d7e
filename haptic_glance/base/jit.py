"""Compiled kernels: numba, kept on disk between runs."""

import functools
import gc
import hashlib
import types
import uuid
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numba
import numpy as np
from numba.core import event
from numba.core.caching import FunctionCache, UserProvidedCacheLocator

from .fetch import cache_folder

# Where a kernel is kept: by what its folder holds, or, if that is not writable, where numba itself would.
LOCATORS = f"{__name__}.ByContent,InTreeCacheLocator,UserWideCacheLocator"
# error_model: divides as numpy does, with no branch on zero. no_cfunc_wrapper: no entry for callers in C, which would
# take a twentieth of the time to compile.
OPTIONS: dict[str, Any] = {"cache": True, "nogil": True, "error_model": "numpy", "no_cfunc_wrapper": True}
inlined = numba.njit(inline="always", error_model="numpy")  # where a call costs as much as what it does
# For what kernels alone call, and what makes no array: inlined as late as machine code, so that it is typed once for
# all its callers, without an entry for callers in Python, and without counts of references (_nrt). It is not kept, as
# the kernels that call it are.
HELPER: dict[str, Any] = {
    "forceinline": True, "error_model": "numpy", "no_cpython_wrapper": True, "no_cfunc_wrapper": True, "_nrt": False,
}  # fmt: skip
helper = numba.njit(**HELPER)


class NoGarbageCollection(event.Listener):
    """While numba compiles: the collector would go through its growing graphs again and again, a tenth of the time."""

    def __init__(self) -> None:
        self._before: list[bool] = []  # of each compilation under way: a kernel's holds those of what it calls

    def on_start(self, event: event.Event) -> None:
        """Stops the collector."""
        self._before.append(gc.isenabled())
        gc.disable()

    def on_end(self, event: event.Event) -> None:
        """Starts the collector, if it ran before."""
        if self._before.pop():
            gc.enable()


event.register("numba:compile", NoGarbageCollection())


def kept_in(file: str) -> Path:
    """The folder in which the kernels of the folder of a file (`__file__`) are kept.

    numba renews a kept kernel when its own file changes, not when a kernel of another file that it calls does: so all
    kernels of a folder are kept under one digest of all its files.
    """
    sources = sorted(Path(file).parent.glob("*.py"))
    digest = hashlib.sha256(b"".join(path.read_bytes() for path in sources)).hexdigest()[:12]
    return cache_folder() / "kernels" / digest


class ByContent(UserProvidedCacheLocator):
    """numba's locator, but for the path of the sources: another copy of them finds what one copy has compiled."""

    @classmethod
    def get_suitable_cache_subpath(cls, py_file: str) -> str:
        return ""


def kernel_of(file: str, **options: Any) -> Callable[[Callable[..., Any]], Any]:
    """The decorator for all kernels of the folder that a file (`__file__`) lies in; options are numba's.

    Where kernels are kept is in numba's settings for the whole process, read when a function is decorated: they are
    put back.
    """
    folder = str(kept_in(file))

    def kernel(function: Callable[..., Any]) -> Any:
        config: Any = getattr(numba, "config")  # noqa: B009  # numba does not declare it
        before = config.CACHE_DIR, config.CACHE_LOCATOR_CLASSES
        config.CACHE_DIR, config.CACHE_LOCATOR_CLASSES = folder, LOCATORS
        try:
            return _kept_apart(numba.njit(**OPTIONS, **options)(function))
        finally:
            config.CACHE_DIR, config.CACHE_LOCATOR_CLASSES = before

    return kernel


def _kept_apart(compiled: Any) -> Any:
    """The compiled function, whose machine code for each choice of types gets a file of its own, whoever writes it.

    numba numbers these files: two processes that compile a kernel at once for different types take one number, and the
    index may then name the code of the one for the types of the other.
    """
    cache = getattr(compiled, "_cache", None)  # none where NUMBA_DISABLE_JIT is set
    if isinstance(cache, FunctionCache):
        file: Any = cache._cache_file
        pattern = file._data_name_pattern
        file._data_name = lambda number: pattern.replace("{number:d}", uuid.uuid4().hex)
    return compiled


class UntilWorthCompiling:
    """A kernel that is interpreted while its machine code would take longer to make than the work takes.

    Both give the same numbers, bit for bit. A first imprint then takes tenths of a second instead of three seconds.

    kernel: compiled by `kernel_of(file)`; budget: work of one process up to which it is interpreted, in any unit. A
    kernel whose machine code is kept on disk is never interpreted.
    """

    def __init__(self, kernel: Any, file: str, budget: float) -> None:
        self._kernel, self._folder, self._left = kernel, kept_in(file), budget

    def compile_always(self) -> None:
        """Ends interpretation, before time is measured or much is done."""
        self._left = 0

    def for_work(self, work: float) -> Callable[..., Any]:
        """The kernel, or its interpreted twin, for so much work."""
        if self._left > 0:
            kept = any(self._folder.rglob(f"*.{self._kernel.__name__}-*.nbc"))
            self._left = 0 if kept else self._left - work
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
