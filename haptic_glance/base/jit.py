"""Kernels compiled by numba, cached on disk between runs."""

import functools
import gc
import inspect
import types
import uuid
from collections.abc import Callable
from pathlib import Path
from typing import IO, Any

import numba
import numpy as np
from numba.core import event
from numba.core.caching import FunctionCache, IndexDataCacheFile, UserProvidedCacheLocator

from .kept import beside, claim, is_kept, kept_in, marker
from .passes import FewerPasses

# Where a kernel is kept: by what its folder holds, or, if that is not writable, where numba itself would.
LOCATORS = f"{__name__}.ByContent,InTreeCacheLocator,UserWideCacheLocator"
# error_model: divides as numpy does, with no branch on zero. no_cfunc_wrapper: no entry for callers in C, which would
# take a twentieth of the time to compile.
OPTIONS: dict[str, Any] = {"nogil": True, "error_model": "numpy", "no_cfunc_wrapper": True}
# For what kernels alone call, and what makes no array: inlined as late as machine code, so that it is typed once for
# all its callers, without an entry for callers in Python, and without counts of references (_nrt). It is not kept, as
# the kernels that call it are.
HELPER: dict[str, Any] = {
    "forceinline": True, "error_model": "numpy", "no_cpython_wrapper": True, "no_cfunc_wrapper": True, "_nrt": False,
    "pipeline_class": FewerPasses,
}  # fmt: skip
helper = numba.njit(**HELPER)


@helper
def lesser(a: Any, b: Any) -> Any:
    """min(a, b), which numba would compile with wrappers, anew for each pair of types and each literal."""
    return b if b < a else a


@helper
def greater(a: Any, b: Any) -> Any:
    """max(a, b), compiled in less time than numba's."""
    return b if b > a else a


call_type_of_numba = numba.types.Function.get_call_type
signatures: dict[tuple, Any] = {}  # (operator, context, types of its arguments) -> signature


def remembered_call_type(self: Any, context: Any, args: Any, kws: Any) -> Any:
    """numba's `Function.get_call_type`, which keeps the signature that it has found for an operator and its types.

    numba asks dozens of templates anew for each `a + b` and `a[i]`, a fifth of the time to compile. Signatures of
    functions that numba itself compiles depend on more, such as fastmath, and are not kept.
    """
    key = self, context, tuple(args)
    if kws or key not in signatures:
        signature = call_type_of_numba(self, context, args, kws)
        if kws or signature is None or self.get_impl_key(signature) != self.typing_key:
            return signature
        signatures[key] = signature
    return signatures[key]


class FasterCompilation(event.Listener):
    """While numba compiles a kernel of this package: no garbage collection, and remembered signatures.

    The collector would go through the growing graphs again and again, a tenth of the time. Kernels of other packages
    are compiled as numba does; numba's lock lets one thread compile at a time.
    """

    def __init__(self) -> None:
        self._before: list[tuple[bool, Any]] = []  # of each compilation under way: a kernel's holds those that it calls

    def on_start(self, event: event.Event) -> None:
        """Stops the collector and changes how operators are looked up, for a kernel of this package."""
        self._before.append((gc.isenabled(), numba.types.Function.get_call_type))
        data: Any = event.data
        kernel = data["dispatcher"].py_func
        if kernel.__module__.partition(".")[0] == __name__.partition(".")[0]:
            gc.disable()
            numba.types.Function.get_call_type = remembered_call_type

    def on_end(self, event: event.Event) -> None:
        """Puts both back."""
        enabled, numba.types.Function.get_call_type = self._before.pop()
        if enabled:
            if beside.is_set():  # a first run of a command: to free the graphs would take as long as a kernel
                gc.freeze()
            gc.enable()


event.register("numba:compile", FasterCompilation())


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
    if not options.get("_nrt", True):
        options["pipeline_class"] = FewerPasses

    def kernel(function: Callable[..., Any]) -> Any:
        config: Any = getattr(numba, "config")  # noqa: B009  # numba does not declare it
        before = config.CACHE_DIR, config.CACHE_LOCATOR_CLASSES
        config.CACHE_DIR, config.CACHE_LOCATOR_CLASSES = folder, LOCATORS
        try:
            compiled: Any = numba.njit(**OPTIONS, **options)(function)
            if compiled is not function:  # it is where NUMBA_DISABLE_JIT is set
                compiled._cache = Shared(function)  # what enable_caching() does with a cache of numba's own
            return compiled
        finally:
            config.CACHE_DIR, config.CACHE_LOCATOR_CLASSES = before

    return kernel


class Files(IndexDataCacheFile):
    """The files of a kernel, whose machine code for each choice of types gets one of its own, whoever writes it.

    numba numbers these files: two processes that compile a kernel at once for different types take one number, and the
    index may then name the code of the one for the types of the other.
    """

    def _data_name(self, number: int) -> str:
        return super()._data_name(number).replace(f".{number}.nbc", f".{uuid.uuid4().hex}.nbc")

    def _load_index(self) -> dict[Any, str]:
        """The names of the files of machine code, by key; none where the index is damaged: it is then written anew."""
        return _undamaged(super()._load_index) or {}

    def _load_data(self, name: str) -> Any:
        """The content of a file of machine code, or None where it is damaged: the kernel is then compiled anew."""
        return _undamaged(super()._load_data, name)


def _undamaged(load: Callable[..., Any], *arguments: Any) -> Any:
    """The result of load(*arguments), or None where the file is cut off or holds something else."""
    try:
        return load(*arguments)
    except OSError:  # no damage: numba knows what to do about it
        raise
    except Exception:  # damaged pickles raise errors of many kinds
        return None


class Shared(FunctionCache):
    """A kernel's place on disk: of processes that need the kernel, one compiles it, and the others wait and load it."""

    def __init__(self, function: Callable[..., Any]) -> None:
        super().__init__(function)
        impl = self._impl
        self._cache_file = Files(self.cache_path, impl.filename_base, impl.locator.get_source_stamp())
        self._marker = marker(inspect.getfile(function), function.__qualname__, Path(self.cache_path))
        self._claimed: IO[bytes] | None = None

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """The kernel for such types, or None, and then this process is the one to compile it."""
        kernel = super().load_overload(sig, target_context)
        if kernel is None and self._claimed is None:
            self._claimed = claim(self._marker)
            kernel = super().load_overload(sig, target_context)
        if kernel is not None:
            self._release()
        return kernel

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keeps a compiled kernel."""
        super().save_overload(sig, data)
        self._release()

    def _release(self) -> None:
        if self._claimed is not None:
            self._claimed.close()
            self._claimed = None


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
            cached = any(self._folder.rglob(f"*.{self._kernel.__name__}-*.nbc"))
            self._left = 0 if cached else self._left - work
        return self._kernel if self._left <= 0 else interpreted(self._kernel)


class UntilCompiledBeside:
    """A kernel that is interpreted while another process compiles it for this one, see `haptic_glance.first_run`.

    This pays where the interpretation of a small mesh takes less time than the compilation. most: the number of
    elements of the first argument up to which the kernel is interpreted. Both give the same numbers, bit for bit.
    """

    def __init__(self, kernel: Any, most: int) -> None:
        self.kernel, self._most, self._waits = kernel, most, True

    def __call__(self, *arguments: Any) -> Any:
        if self._waits:
            file = inspect.getfile(getattr(self.kernel, "py_func", self.kernel))
            self._waits = beside.is_set() and not is_kept(file, self.kernel.__name__)
        small = self._waits and len(arguments[0]) <= self._most
        return (interpreted(self.kernel) if small else self.kernel)(*arguments)

    def compile(self, types: Any) -> None:
        """Compiles it, for such types."""
        self.kernel.compile(types)


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
