"""Imprints in 0..1."""

from importlib import import_module

import numpy as np
import pytest

from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import indent, normalise, press, press_many


def test_plane_gives_flat_imprint(shapes):
    mesh, vertex = shapes.solid(lambda x, y: 0.1 * x + 0.2 * y)
    assert (press(mesh, vertex) == 0).all()


def test_plane_with_rounded_coordinates_is_still_flat(shapes):
    mesh, vertex = shapes.solid(lambda x, y: 0.1 * x + 0.2 * y)
    assert (press(Mesh(mesh.vertices.astype(np.float32), mesh.faces), vertex) == 0).all()


def test_sphere_is_zero_at_contact_and_one_farthest_away(shapes):
    mesh, vertex = shapes.solid(shapes.sphere)
    image = press(mesh, vertex, cells=(15, 15), pitch=0.01)
    x, y = shapes.cell_places((15, 15), 0.01)
    depth = 0.3 - shapes.sphere(x, y)
    assert image.dtype == np.float32 and image[7, 7] == 0 and image[0, 0] == 1
    assert np.allclose(image, depth / depth.max(), atol=1e-6)


def test_pit_is_zero_where_a_rigid_array_would_touch_first(shapes):
    mesh, vertex = shapes.solid(lambda x, y: 4 * (x * x + y * y))
    image = press(mesh, vertex, cells=(15, 15))
    assert image[7, 7] == 1 and image[0, 0] < 1e-12


def test_array_larger_than_the_object_gives_a_defined_image(shapes):
    mesh, vertex = shapes.solid(shapes.sphere)
    assert (press(mesh, vertex, pitch=10.0) == 0).all()  # every cell misses
    assert set(np.unique(press(mesh, vertex, cells=(3, 3), pitch=10.0))) == {0.0, 1.0}  # only the middle one touches


def test_many_equal_one_by_one_across_batches(shapes):
    mesh, _ = shapes.solid(shapes.sphere)
    vertices = np.random.default_rng(0).choice(len(mesh.vertices), 70)
    many = press_many(mesh, vertices, (32, 32), 0.004)
    assert many.shape == (70, 32, 32)
    for vertex, image in zip(vertices[[0, 33, 69]], many[[0, 33, 69]], strict=True):
        assert np.array_equal(press(mesh, vertex, (32, 32), 0.004), image)


def test_normalise_wants_a_stack():
    with pytest.raises(ValueError, match="shape"):
        normalise(np.zeros((4, 4)), 0.01)


@pytest.mark.parametrize("wrong", [np.nan, np.inf, -np.inf])
def test_distances_that_are_no_numbers_make_no_imprint(wrong):
    raw = np.zeros((3, 2, 2))
    raw[1, 0, 1] = wrong
    with pytest.raises(ValueError, match="distances must be finite"):
        normalise(raw, 0.01)
    with pytest.raises(ValueError, match="distances must be finite"):
        indent(raw, 0.01)


def test_blocks_change_no_imprint(monkeypatch):
    raw = np.random.default_rng(0).normal(size=(9, 4, 4))
    whole = normalise(raw, 0.01)
    monkeypatch.setattr(import_module("haptic_glance.touch.press"), "BLOCK", 30)
    assert np.array_equal(normalise(raw, 0.01), whole)


def test_press_takes_one_vertex(shapes):
    mesh, vertex = shapes.solid(shapes.sphere)
    with pytest.raises(ValueError, match="vertices must have shape"):
        press(mesh, [vertex, vertex + 1])
