"""Places on the surface, arrays there, and what makes none."""

import numpy as np
import pytest

from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import (
    Surface,
    distances,
    distances_at,
    press_at,
    press_many,
    sensor_axes,
    sensor_normals,
    snap_to_surface,
)
from tests.shapes import ball_mesh


def dome():
    """The part of a ball above z = 0, an open mesh."""
    mesh = ball_mesh(2, 0.5)
    return Mesh(mesh.vertices, mesh.faces[mesh.vertices[mesh.faces][..., 2].min(axis=1) > 0])


def test_a_place_in_a_face_has_its_normal():
    mesh = ball_mesh(2, 0.5)
    middles = mesh.vertices[mesh.faces].mean(axis=1)
    positions, normals = snap_to_surface(Surface(mesh), middles + 0.002 * mesh.face_normals)
    assert np.allclose(positions, middles, atol=1e-12) and np.allclose(normals, mesh.face_normals, atol=1e-12)


def test_a_place_on_an_edge_has_the_average_of_both_faces():
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 9.0]])
    mesh = Mesh(corners, [[0, 1, 2], [0, 2, 3]])  # normals +z and +x meet along the y axis
    _, normals = snap_to_surface(mesh, [[0, 0.3, 0]])
    assert np.allclose(normals, np.sqrt([[0.5, 0, 0.5]]))


def test_a_place_at_a_vertex_is_touched_as_the_vertex_is():
    mesh = ball_mesh(2, 0.5)
    positions, normals = snap_to_surface(mesh, mesh.vertices[:7] * 1.001)
    assert np.allclose(positions, mesh.vertices[:7], atol=1e-14)
    assert np.allclose(normals, sensor_normals(mesh, np.arange(7)), atol=1e-14)
    assert np.allclose(press_at(mesh, positions, sensor_axes(normals)), press_many(mesh, np.arange(7)), atol=1e-6)


def snapped(*points, **options):
    return snap_to_surface(ball_mesh(2, 0.5), points, **options)


def measured(**changes):
    return distances_at(ball_mesh(2, 0.5), **{"centres": [[0, 0, 0.5]], "axes": np.eye(3)[None], **changes})


def test_a_place_off_the_surface_is_taken_within_the_tolerance():
    assert np.allclose(snapped([0, 0, 0.6], tolerance=0.2)[0], [[0, 0, 0.5]])
    assert snap_to_surface(ball_mesh(2, 0.5), np.zeros((0, 3)))[0].shape == (0, 3)


TWICE = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2], [2, 1, 0]])


@pytest.mark.parametrize(
    "work, words",
    [
        (lambda: snapped([0, 0, 0.6]), r"point \[0.0, 0.0, 0.6\] is off the mesh: its surface is 0.1 away"),
        (lambda: snapped([0.0, np.nan, 0]), "finite"),
        (lambda: snapped(0.0, 0, 0.5), "shape"),
        (lambda: snapped([0, 0, 0.6], tolerance=np.nan), "tolerance must be"),
        (lambda: snapped([0, 0, 0.6], tolerance=-1.0), "tolerance must be"),
        (lambda: snap_to_surface(TWICE, [[0.5, 0, 0]]), "cancel out"),
        (lambda: measured(centres=[[0.0, 0]]), "centres must be"),
        (lambda: measured(centres=[[0.0, 0, np.inf]]), "centres must be"),
        (lambda: measured(pitch=[0.1, 0.2]), "pitch must be a number or have shape"),
        (lambda: measured(pitch=[-0.1]), "pitch must be a positive"),
        (lambda: measured(max_distance=[0.0]), "max_distance must be a positive"),
        (lambda: measured(axes=np.zeros((2, 3, 3))), "axes must have shape"),
    ],
)
def test_what_is_no_place_or_array_is_named(work, words):
    with pytest.raises(ValueError, match=words):
        work()


def test_an_array_has_its_own_pitch_and_max_distance():
    mesh = ball_mesh(2, 0.5)
    centres, axes = mesh.vertices[:3], sensor_axes(sensor_normals(mesh, [0, 1, 2]))
    pitches, max_distances = np.array([0.01, 0.02, 0.05]), np.array([0.1, 0.2, 0.03])
    together = distances_at(Surface(mesh), centres, axes, (9, 7), pitches, max_distances)
    for k in range(3):
        alone = distances_at(mesh, centres[k : k + 1], axes[k : k + 1], (9, 7), pitches[k], max_distances[k])
        assert np.array_equal(together[k], alone[0])
    assert together[2].max() == 0.03
    images = press_at(mesh, centres, axes, (9, 7), pitches, max_distances)
    assert images.min() == 0 and images.max() == 1


def test_an_array_larger_than_the_object_feels_what_is_there():
    lengths = distances_at(ball_mesh(2, 0.5), [[0, 0, 0.5]], np.eye(3)[None], (8, 8), 3.0)
    assert (lengths == 24).all()
    lengths = distances_at(ball_mesh(2, 0.5), [[0, 0, 0.5]], np.eye(3)[None], (7, 7), 3.0)[0]
    assert lengths[3, 3] == pytest.approx(0) and (np.delete(lengths.ravel(), 24) == 21).all()


def test_a_closed_object_touched_from_its_inside_is_inside_in_every_cell():
    inwards = np.diag([1.0, -1, -1])[None]  # looks up at the inner side of the top, 0.2 away; the way out is 0.8 down
    lengths = distances_at(ball_mesh(2, 0.5), [[0, 0, 0.3]], inwards, (8, 8), 0.02, max_distance=0.4)
    assert (lengths == -0.4).all()


def test_an_open_object_touched_from_its_inside_is_felt_as_far_as_it_is_there():
    mesh, inwards = dome(), np.diag([1.0, -1, -1])[None]
    tangent = distances_at(mesh, [[0, 0, 0.5]], inwards, (8, 8), 0.02, max_distance=0.3)
    assert (tangent == 0.3).all()  # a hollow bends away over the plane: nothing is below it
    rigid = distances_at(mesh, [[0, 0, 0.5]], inwards, (8, 8), 0.02, max_distance=0.3, contact="rigid")[0]
    assert rigid[0, 0] == 0 and rigid[4, 4] == rigid.max() > 0  # a rigid array rests on the hollow with its corners
    rim = distances_at(mesh, [[0.45, 0, 0.0]], np.eye(3)[None], (1, 1), 0.02, max_distance=0.3)
    assert rim == pytest.approx(-np.sqrt(0.5**2 - 0.45**2), abs=0.02)  # below the rim is nothing, above it the dome


def test_a_mesh_without_faces_or_area_is_nowhere_felt():
    for mesh in (Mesh(np.zeros((3, 3)), np.zeros((0, 3), int)), Mesh([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 1, 2]])):
        assert (distances_at(mesh, [[0.0, 0, 0]], np.eye(3)[None], (4, 4), 0.1) == 0.4).all()
        with pytest.raises(ValueError, match="no normal"):
            distances(mesh, [0])
