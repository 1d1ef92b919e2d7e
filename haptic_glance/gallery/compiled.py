"""Kernels compiled beside other work, on a machine that has none yet."""

import subprocess
import sys
from collections.abc import Callable

import numpy as np
import trimesh

from haptic_glance.lod import simplify
from haptic_glance.lod.attributes import closest
from haptic_glance.lod.kernels.jit import FOLDER
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch.warm_up import warm_up as warm_up_touch


def compile_beside(report: Callable[[str], None]) -> Callable[[], object]:
    """Compiles in two other processes what simplifies and touches, while a mesh is looked at; call it to wait.

    Each machine does this once. On two cores it takes half a minute, one after the other nearly a whole one.
    """
    if any(FOLDER.rglob("*.nbc")):
        return lambda: None
    report("the first run on a machine compiles what simplifies and touches, for up to a minute")
    quiet = subprocess.DEVNULL
    code = "from haptic_glance.gallery.compiled import {0}; {0}()"
    commands = ([sys.executable, "-c", code.format(work.__name__)] for work in (compile_search, compile_rest))
    started = [subprocess.Popen(command, stdin=quiet, stdout=quiet, stderr=quiet) for command in commands]
    return lambda: [process.wait() for process in started]


def compile_search() -> None:
    """Compiles the search for the nearest point of a surface, a third of all."""
    mesh = ball()
    closest(mesh, mesh.vertices)


def compile_rest() -> None:
    """Compiles simplification and touch."""
    mesh = ball()
    warm_up_touch()
    simplify(mesh, len(mesh.faces) // 6, weights=np.linspace(0, 1, len(mesh.vertices)))


def ball() -> Mesh:
    """A ball of 1,280 faces: enough that every step runs."""
    found = trimesh.creation.icosphere(subdivisions=3, radius=0.5)
    return Mesh(found.vertices, found.faces)
