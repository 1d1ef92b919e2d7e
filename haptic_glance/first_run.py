"""The first run on a machine, which compiles kernels: in two processes at once, or more.

The command compiles a kernel at its first use. Other processes compile the longest kernels first and then the same list
from its end. While one process compiles a kernel, the others skip it or wait: see `haptic_glance.base.jit`.
"""

import atexit
import gc
import os
import subprocess
import sys
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType
from typing import Any

from .base.kept import beside, cache_folder, claim, fcntl, is_kept, kept_in, marker

MOST = 3  # helpers: more of them would wait for the longest kernel
PACKAGE = Path(__file__).parent
SURFACE = "HalfEdgeMesh"
# Kernels in the order in which the demo comes to them: file, name, types of the arguments as numba spells them.
LOOK = [
    ("look/glance/cells", "_cut", "f8[:,:,::1], i8, f8[:,::1], i8, f8[:,:,::1], i8[::1], i8[::1]"),
    (
        "look/glance/cells", "_seen",
        "f8[:,::1], f8[:,::1], f8[:,:,::1], i8[::1], f8[:,::1], f8[:,::1], i8[:,::1], f8[::1]",
    ),
    (
        "look/glance/samples", "_average",
        "f8[:,::1], f8[:,::1], i8[::1], i8[:,::1], i8[:,::1], f8[:,::1], f8[:,::1], f8[::1], i4[::1], f8, f8, f8, f8,"
        "i8, i4[::1], i4[::1], f8[::1]",
    ),
    ("look/views/kernels", "rasterise", "f8[::1,:], i8[:,::1], i8, i8, i4[:,:], f8[:,::1]"),
    ("mesh/components", "_join", "i8[::1], i8[::1], i8[::1], i4[::1]"),
    (
        "look/views/kernels", "shade_pixels",
        "f8[::1,:], i8[:,::1], f8[:,::1], i8[:,::1], f8[:,::1], u1[:,::1], f8, f8[::1], f8[::1], i8, i8, i4[:,:],"
        "u1[:,:,:]",
    ),
]  # fmt: skip
LEVELS = [
    ("lod/kernels/mesh", "_fill_fans", "i4[::1], i4[::1], i4[::1], i4[::1], i4[::1], b1[::1]"),
    ("lod/kernels/quadrics", "_add_planes", "f8[:,::1], i4[::1], f8[::1], f8[:,::1]"),
    (
        "lod/kernels/collapse", "_decimate",
        f"{SURFACE}, none, i4[::1], i4[::1], i8[::1], i4[::1], i8[::1], i8, f8, f8, f8",
    ),
    ("mesh/kernels/nearest", "_fill_planes", "f8[:,::1], i8[:,::1], f8[::1], f8[:,::1], f8[::1]"),
    ("mesh/kernels/nearest", "_fill_boxes", "f8[:,::1], i8[:,::1], f8[::1], f8, i8[::1], i4[:,::1]"),
    ("mesh/kernels/nearest", "_sort_into_cells", "i4[:,::1], i8[::1], i4[::1], i4[::1]"),
    (
        "mesh/kernels/nearest", "_search",
        "f8[:,::1], f8[:,::1], i8[:,::1], i4[::1], i4[::1], f8[::1], f8, i8[::1], f8[:,::1], f8, f8[::1], i8[::1]",
    ),
    ("lod/kernels/refit", "_refit", f"{SURFACE}, f8[:,::1], i4[::1], f8[::1], i8, f8, f8[:,::1], i4[::1]"),
]  # fmt: skip
ERRORS = [  # of simplify alone
    ("mesh/sampling", "_faces_at", "f8[::1], f8[::1]"),
    ("mesh/sampling", "_points", "f8[:,::1], i8[:,::1], i8[::1], f8[:,::1]"),
    (
        "mesh/kernels/nearest", "_farthest",
        "f8[:,::1], i8[:,::1], f8[:,::1], i8[:,::1], i4[::1], i4[::1], f8[::1], f8, i8[::1], f8[:,::1], f8, f8,"
        "b1[::1], i8[::1]",
    ),
]  # fmt: skip
LIGHT = [  # interpreted meanwhile, so these come last: see `haptic_glance.base.jit.UntilCompiledBeside`
    ("lod/kernels/mesh", "_closed", "i4[::1], i4[::1], i4[::1], i4[::1], i4[::1]"),
    ("lod/kernels/mesh", "_fill_split_fans", "i4[::1], i4[::1], i4[::1]"),
    ("lod/kernels/mesh", "_fill_components", "i4[::1], i4[::1], i4[::1]"),
    ("lod/kernels/mesh", "_name_corners", "i4[::1], b1[::1], i4[::1], i8, i8[::1], i8[::1], i8[::1]"),
    ("lod/kernels/mesh", "_count", "f8[:,::1], i4[::1], i4[::1], f8, f8, f8[:,::1]"),
    ("lod/kernels/mesh", "_add_volumes", "f8[:,::1], i4[::1], i4[::1], i4[::1], i4[::1], f8[::1], b1[::1]"),
    ("mesh/kernels/planes", "_weigh", "f8[:,::1], i8[::1], f8[:,::1], i8[:,::1], f8[:,::1]"),
]  # fmt: skip
LONGEST = "_decimate"  # to compile
DEMO = LIGHT + LOOK + LEVELS


def _is_installed(name: str) -> bool:
    """Whether a package could be imported; a finder that blocks the package may raise instead of finding nothing."""
    try:
        return find_spec(name) is not None
    except ModuleNotFoundError:
        return False


PICTURES = LOOK if _is_installed("matplotlib") else []  # of imprints; without them `touch` compiles too little to share
COMMANDS = {"demo": DEMO, "gallery": DEMO, "simplify": DEMO + ERRORS, "touch": PICTURES}


def start(command: str) -> None:
    """Starts what compiles the kernels of a command beside it, before it imports anything; says so on stderr."""
    kernels = COMMANDS[command]
    missing = sum(not is_kept(PACKAGE / f"{file}.py", name) for file, name, _ in kernels)
    if not missing:
        return
    try:
        (cache_folder() / "kernels").mkdir(parents=True, exist_ok=True)
        writable = os.access(cache_folder() / "kernels", os.W_OK)
    except OSError:
        writable = False
    if not writable:
        remedy = "set HAPTIC_GLANCE_CACHE to a folder that can be written to, or the next run may compile them again"
        print(f"{command}: compiled kernels cannot be kept in {cache_folder()}: {remedy}", file=sys.stderr, flush=True)
        return
    print(f"{command}: compiling {missing} of {len(kernels)} kernels, once", file=sys.stderr, flush=True)
    path = os.pathsep.join(filter(None, [str(PACKAGE.parent), os.environ.get("PYTHONPATH")]))
    # Without colours, here and in the helpers: numba words the errors of each overload that it tries, and colours them.
    os.environ["NUMBA_DISABLE_ERROR_MESSAGE_HIGHLIGHTING"] = "1"
    environment = os.environ | {"PYTHONPATH": path}
    quiet = subprocess.DEVNULL
    line = [sys.executable, "-P", "-c", f"from {__name__} import compile_all; compile_all({command!r})"]
    for _ in range(min(_cores() - 1, MOST) if fcntl else 0):  # without locks they would compile everything twice
        helper = subprocess.Popen(line, stdin=quiet, stdout=quiet, stderr=quiet, env=environment)
        atexit.register(helper.wait)
        atexit.register(helper.kill)  # before it is waited for
        beside.set()


def _cores() -> int:
    """How many cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def compile_all(command: str) -> None:
    """Compiles the longest kernel of a command, then the others from the last one to the first.

    Leaves out those that another process compiles or has kept.
    """
    import numba
    from numba.core.registry import cpu_target

    target: Any = cpu_target
    gc.disable()  # this process ends soon: to free what numba leaves behind takes a tenth of the time
    # numba would look for BLAS there, which no kernel needs, and the import takes as long as a kernel.
    sys.modules["scipy.linalg"] = None  # pyright: ignore[reportArgumentType]
    target.target_context.refresh()
    del sys.modules["scipy.linalg"]  # the file of a kernel may import it, through scipy.spatial
    kernels = COMMANDS[command]
    for package in {str(Path(file).parent) for file, _, _ in kernels}:
        _without_imports(package)
    for file, name, types in sorted(reversed(kernels), key=lambda kernel: kernel[1] != LONGEST):
        path = PACKAGE / f"{file}.py"
        free = None if is_kept(path, name) else claim(marker(path, name, kept_in(path)), patience=0)
        if free is not None:
            free.close()
            kernel = getattr(import_module(f"{__package__}.{file.replace('/', '.')}"), name)
            namespace = vars(numba.types) | ({SURFACE: _surface()} if SURFACE in types else {})
            kernel.compile(eval(f"({types})", namespace))


def _surface():
    """numba's type of a HalfEdgeMesh."""
    from numba import types as t

    from .lod.kernels.mesh import HalfEdgeMesh

    ints, bools, floats = t.int32[::1], t.boolean[::1], t.float64[:, ::1]
    return t.NamedTuple((ints, ints, ints, bools, bools, floats, floats, ints), HalfEdgeMesh)


def _without_imports(package: str) -> None:
    """Puts an empty package in the place of each on a path: what they import takes as long as two kernels."""
    names = package.split("/")
    for k in range(1, len(names) + 1):
        module = ModuleType(".".join([str(__package__), *names[:k]]))
        module.__path__ = [str(PACKAGE.joinpath(*names[:k]))]
        sys.modules.setdefault(module.__name__, module)
