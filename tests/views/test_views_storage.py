"""A stored view comes back as it was, from a small file that is always the same."""

import numpy as np
import pytest

from haptic_glance.look.camera import Viewpoint
from haptic_glance.look.views import TWELVE, View, render
from haptic_glance.look.views.view import DEPTH_STEP
from haptic_glance.mesh.mesh import Mesh
from stages.views.storage import read_view, write_view


def assert_equal(first, second):
    for name in ("rgb", "depth", "face"):
        left, right = getattr(first, name), getattr(second, name)
        assert left.dtype == right.dtype
        assert np.array_equal(left, right), name
    assert first.viewpoint == second.viewpoint


@pytest.mark.parametrize(("name", "background"), [("bowl", "white"), ("coloured", "black"), ("nothing", "grey")])
def test_round_trip_is_exact_and_equal_views_give_equal_bytes(shapes, name, background, tmp_path):
    mesh = (shapes | {"nothing": Mesh(np.zeros((0, 3)), np.zeros((0, 3)))})[name]
    for file in ("view.npz", "again.npz"):
        view = render(mesh, Viewpoint(120, 45, 10), (225, 300), "raster", background)
        write_view(tmp_path / file, view)
    assert_equal(read_view(tmp_path / "view.npz"), view)
    assert (tmp_path / "view.npz").read_bytes() == (tmp_path / "again.npz").read_bytes()
    assert (tmp_path / "view.npz").stat().st_size < 60_000  # raw arrays have 740,000 bytes


def test_view_without_background_comes_back(tmp_path):
    rng = np.random.default_rng(0)
    depth = (10 + rng.integers(-99, 99, (7, 9)) * DEPTH_STEP).astype(np.float32)
    face = rng.integers(0, 2**31 - 1, (7, 9), dtype=np.int32)
    view = View(rng.integers(0, 256, (7, 9, 3), dtype=np.uint8), depth, face, TWELVE[5])
    write_view(tmp_path / "view.npz", view)
    assert_equal(read_view(tmp_path / "view.npz"), view)
