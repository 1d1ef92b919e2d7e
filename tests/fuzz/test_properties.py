"""What every mesh gets at the public doors: a result with the promised properties, or a reason."""

import numpy as np
import pytest
from hypothesis import given, settings

from haptic_glance import metro, normalise, press, saliency, simplify
from haptic_glance.lod.topology import faults
from haptic_glance.mesh import clean
from tests.fuzz.strategies import meshes


def examples(count):
    return settings(max_examples=count, deadline=None, derandomize=True, database=None)


def usable(mesh):
    """The cleaned and normalised mesh, or None where clean says why not."""
    try:
        return normalise(clean(mesh)[0])
    except ValueError as error:
        assert str(error)
        return None


@examples(20)
@given(mesh=meshes())
@pytest.mark.slow
def test_a_normalised_mesh_fills_its_bounding_sphere(mesh):
    used = normalise(mesh).vertices[np.unique(mesh.faces)]
    assert np.linalg.norm(used, axis=1).max() == pytest.approx(0.5)
    assert used.min(axis=0) == pytest.approx(-used.max(axis=0))


@examples(20)
@given(mesh=meshes())
def test_cleaning_keeps_vertices_and_leaves_no_degenerate_or_duplicate_face(mesh):
    cleaned, _ = clean(mesh)
    np.testing.assert_array_equal(cleaned.vertices, mesh.vertices)
    assert (np.diff(np.sort(cleaned.faces, axis=1), axis=1) > 0).all()
    assert len(np.unique(cleaned.faces, axis=0)) == len(cleaned.faces) <= len(mesh.faces)
    again, notes = clean(cleaned)
    np.testing.assert_array_equal(again.faces, cleaned.faces)
    assert not notes


@pytest.mark.slow
@examples(8)
@given(mesh=meshes())
def test_simplifying_gives_fewer_faces_and_no_new_fault(mesh):
    mesh = usable(mesh)
    target = max(len(mesh.faces) // 2, 1)
    try:
        simple = simplify(mesh, target)
    except ValueError as error:
        assert str(error)
        return
    assert 0 < len(simple.faces) <= target and np.isfinite(simple.vertices).all()
    assert not faults(simple).added(faults(mesh))


@pytest.mark.slow
@examples(4)
@given(mesh=meshes())
def test_saliency_and_imprints_are_in_0_to_1_and_the_distance_of_a_mesh_to_itself_is_zero(mesh):
    mesh = usable(mesh)
    values = saliency(mesh)
    assert values.shape == (len(mesh.vertices),) and np.isfinite(values).all()
    assert 0 <= values.min() <= values.max() <= 1
    assert max(metro(mesh, mesh).values()) < 1e-7
    try:
        image = press(mesh, int(mesh.faces[0, 0]))
    except ValueError as error:
        assert str(error)
        return
    assert image.shape == (16, 16) and np.isfinite(image).all() and image.min() >= 0 and image.max() <= 1
