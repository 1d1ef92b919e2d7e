"""Every mesh gets a result with the promised properties by the public functions, or a reason.

The meshes are closed and open ones, with the faults that scanned and modelled meshes have.
"""

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from haptic_glance import metro, normalise, press, saliency
from haptic_glance.mesh import clean
from haptic_glance.mesh.mesh import Mesh

CLOSED = {
    "ball": trimesh.creation.icosphere(subdivisions=2),
    "box": trimesh.creation.box().subdivide(),
    "torus": trimesh.creation.torus(1, 0.4, major_sections=16, minor_sections=8),
    "tetrahedron": trimesh.Trimesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
                                   [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]),
}  # fmt: skip
FAULTS = ("holes", "degenerate faces", "duplicate faces", "duplicate vertices", "fin", "stray vertex", "turned faces")


@st.composite
def meshes(draw, faults=FAULTS):
    """A Mesh of up to 330 faces, of any size and place, slightly dented, with up to three of the faults."""
    shape = CLOSED[draw(st.sampled_from(sorted(CLOSED)))]
    random = np.random.default_rng(draw(st.integers(0, 2**16)))
    stretch = [draw(st.floats(0.3, 3)) for _ in range(3)]
    vertices = (shape.vertices + 0.02 * random.standard_normal(shape.vertices.shape)) * stretch
    vertices = (vertices + draw(st.floats(-10, 10))) * 10.0 ** draw(st.integers(-3, 3))
    faces = shape.faces
    for fault in draw(st.lists(st.sampled_from(faults), max_size=3, unique=True)) if faults else []:
        vertices, faces = _damage(fault, vertices, faces, random)
    return Mesh(vertices, faces)


def _damage(fault, vertices, faces, random):
    some, last = random.choice(len(faces), max(len(faces) // 10, 1), replace=False), len(vertices)
    if fault == "holes":
        return vertices, np.delete(faces, some, axis=0)
    if fault == "degenerate faces":
        return vertices, np.r_[faces, faces[some][:, [0, 0, 1]]]
    if fault == "duplicate faces":
        return vertices, np.r_[faces, faces[some]]
    if fault == "duplicate vertices":  # of the faces that no longer share them
        faces = faces.copy()
        ids = faces[some].ravel()
        faces[some] = np.arange(last, last + len(ids)).reshape(-1, 3)
        return np.r_[vertices, vertices[ids]], faces
    if fault == "fin":  # an edge of three faces
        tip = vertices[faces[0, 0]] * 2 - vertices[faces].mean(axis=(0, 1))
        return np.r_[vertices, [tip]], np.r_[faces, [[*faces[0, :2], last]]]
    if fault == "stray vertex":
        return np.r_[vertices, vertices[:1] + 100 * np.ptp(vertices)], faces
    faces = faces.copy()
    faces[some] = faces[some][:, ::-1]
    return vertices, faces


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


@pytest.mark.slow
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
