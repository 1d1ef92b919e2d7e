"""Kernels compiled beside other work, on a machine that has none yet."""

import subprocess
import sys
from collections.abc import Callable

from stages.imprints import kernels
from stages.kit.jit import kept_in

WARM_UP = "from stages.imprints.warm_up import warm_up; warm_up()"


def compile_beside(report: Callable[[str], None]) -> Callable[[], object]:
    """Compiles what touches in a process of its own, while meshes are looked at and simplified; call it to wait.

    Each machine does this once, so that the first page takes half a minute instead of a whole one.
    """
    if any(kept_in(kernels.__file__ or "").rglob("*.nbc")):
        return lambda: None
    report("the first run on a machine compiles what measures, for up to a minute")
    quiet = subprocess.DEVNULL
    return subprocess.Popen([sys.executable, "-c", WARM_UP], stdin=quiet, stdout=quiet, stderr=quiet).wait
