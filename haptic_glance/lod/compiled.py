"""The kernels of simplification, compiled beside other work, on a machine that has none yet."""

import subprocess
import sys
from collections.abc import Callable

import numpy as np
import trimesh

from haptic_glance.mesh.mesh import Mesh

from .attributes import closest
from .kernels.jit import FOLDER
from .simplify import simplify


def compile_beside(report: Callable[[str], None]) -> Callable[[], object]:
    """Compiles in two other processes what simplifies, while a mesh is looked at; call the result to wait.

    Each machine does this once. report: receives a line of text if there is something to compile.
    """
    if any(FOLDER.rglob("*.nbc")):
        return lambda: None
    report("the first run on a machine compiles its kernels, for about ten seconds")
    quiet = subprocess.DEVNULL
    code = f"from {__name__} import {{0}}; {{0}}()"
    commands = ([sys.executable, "-c", code.format(work.__name__)] for work in (compile_search, compile_collapse))
    started = [subprocess.Popen(command, stdin=quiet, stdout=quiet, stderr=quiet) for command in commands]
    return lambda: [process.wait() for process in started]


def compile_search() -> None:
    """Compiles the search for the nearest point of a surface."""
    mesh = ball()
    closest(mesh, mesh.vertices)


def compile_collapse() -> None:
    """Compiles simplification."""
    mesh = ball()
    simplify(mesh, len(mesh.faces) // 6, weights=np.linspace(0, 1, len(mesh.vertices)))


def ball() -> Mesh:
    """A ball of 1,280 faces: enough that every step runs."""
    sphere = trimesh.creation.icosphere(subdivisions=3, radius=0.5)
    return Mesh(sphere.vertices, sphere.faces)
