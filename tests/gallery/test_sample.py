"""The sample mesh: what README.md says of it, and that the script makes it."""

import runpy

import numpy as np
import pytest

from haptic_glance.gallery.demo import sample
from haptic_glance.lod import metro
from haptic_glance.mesh import clean, load


def test_the_sample_is_small_whole_and_upright():
    mesh = load(sample())
    assert sample().stat().st_size < 300_000 and clean(mesh)[1] == []
    assert mesh.watertight and len(mesh.faces) == 9000 and mesh.up == "y" and mesh.colors is not None
    x, y, z = np.ptp(mesh.vertices, axis=0)
    assert y == pytest.approx(2, abs=0.05) and x < y < z


def test_its_head_is_in_front():
    mesh = load(sample())
    high = mesh.vertices[:, 1] > 1.75
    assert mesh.vertices[high, 2].min() > 0.9  # along +z, where glTF has the front


@pytest.mark.slow
def test_the_script_makes_it():
    pytest.importorskip("skimage")
    make = runpy.run_path(str(sample().with_name("make.py")))["dromedary"]
    make.__globals__["CELL"] *= 2  # an eighth of the cells: the surface moves by a third of what is allowed
    assert metro(make(), load(sample()), samples=2000)["mean"] < 5e-4
