"""Large packages are imported with their first use, so that no process waits for one that it does not need."""

import pickle
import signal
import subprocess
import sys

import pytest

from haptic_glance.base.lazy import pandas, trimesh


@pytest.mark.slow
def test_a_stage_starts_without_packages_that_only_its_end_needs():
    code = "import sys, stages.lod.__main__ as s; print({'pandas', 'trimesh', 'scipy.stats', 'cv2'} & set(sys.modules))"
    process = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert process.stdout == "set()\n"


def test_the_library_and_its_commands_wait_for_no_package_that_arrays_do_not_need():
    code = """
import sys
from haptic_glance import as_mesh, budget, find_points, press, saliency, simplify
import haptic_glance.cli.points, haptic_glance.cli.simplify, haptic_glance.cli.touch
assert len(as_mesh(([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])).faces) == 1
print({"pandas", "trimesh", "cv2", "matplotlib", "scipy.interpolate", "scipy.optimize"} & set(sys.modules))
"""
    process = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert process.stdout == "set()\n"


def test_a_package_that_was_used_goes_to_a_worker_and_comes_back():
    assert trimesh.Trimesh.__module__ == "trimesh.base"
    assert pickle.loads(pickle.dumps(trimesh)).visual.material.PBRMaterial is trimesh.visual.material.PBRMaterial
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        _ = pandas.nothing


SWALLOWED = """
import os, signal
from contextlib import suppress
from haptic_glance.base.errors import errors_in_one_line, interrupts_wait
errors_in_one_line("look")
signal.signal(signal.SIGINT, signal.default_int_handler)  # a process in the background may ignore it
from haptic_glance.base.progress import no_silence
with no_silence(), interrupts_wait():  # whose thread does not take the signal
    with suppress(BaseException):  # as trimesh does round each optional package
        os.kill(os.getpid(), signal.SIGINT)
        print("imported", flush=True)
print("went on")
"""


def test_an_import_that_swallows_every_exception_does_not_swallow_an_interrupt():
    process = subprocess.run([sys.executable, "-c", SWALLOWED], capture_output=True, text=True)
    assert (process.returncode, process.stdout, process.stderr) == (-signal.SIGINT, "imported\n", "look: stopped\n")
