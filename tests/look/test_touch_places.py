"""Places worth touching: where the imprint of the array recurs on the object."""

import numpy as np
import pytest
import trimesh

from haptic_glance.look.glance import samples_of_mesh
from haptic_glance.look.kernels import pressed
from haptic_glance.look.points import METHODS, detect, find_points
from haptic_glance.look.points.options import Options
from haptic_glance.look.points.touch import CELLS, DISC, WIDTH, imprints, recurrence, spread
from haptic_glance.mesh import normalise
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import Surface, press_at
from haptic_glance.touch.surface import sensor_axes


@pytest.fixture(scope="module")
def bumpy(raised):
    tops = np.array([[1, 0, 0], [-1, 0, 0.2], [0, 1, 0.5], [0, -1, -0.3], [0.3, 0.2, 1]])
    return normalise(raised(tops / np.linalg.norm(tops, axis=1, keepdims=True), [0.15] * 5, [0.2] * 5, 4))


def test_a_purpose_chooses_the_method(bumpy):
    assert (find_points(bumpy, 5, purpose="touch") == find_points(bumpy, "touch", 5)).all()
    assert (find_points(bumpy, 5, purpose="look") == find_points(bumpy, "glance", 5)).all()
    assert (find_points(bumpy, 5) == find_points(bumpy, "glance", 5)).all()
    with pytest.raises(ValueError, match="unknown purpose 'lick': choose one of look, touch$"):
        find_points(bumpy, 5, purpose="lick")
    with pytest.raises(ValueError, match="'touch' chooses the method: leave out method 'itti'"):
        detect(bumpy, "itti", 5, purpose="touch")


def test_the_order_and_the_number_of_faces_change_nothing(bumpy):
    places = bumpy.vertices[find_points(bumpy, 12, purpose="touch")]
    random = np.random.default_rng(0)
    for faces in (random.permutation(bumpy.faces), np.roll(bumpy.faces, 1, axis=1)):
        assert (places == bumpy.vertices[find_points(Mesh(bumpy.vertices, faces), 12, purpose="touch")]).all()
    vertices, faces = trimesh.remesh.subdivide(bumpy.vertices, bumpy.faces)[:2]
    fine = Mesh(np.asarray(vertices), np.asarray(faces))
    again = fine.vertices[find_points(fine, 12, purpose="touch")]
    edge = np.linalg.norm(bumpy.vertices[bumpy.faces[:, 0]] - bumpy.vertices[bumpy.faces[:, 1]], axis=1).max()
    assert np.linalg.norm(places - again, axis=1).max() < edge


@pytest.mark.parametrize("count", [1, 25, 400])
def test_as_many_places_as_asked_for(bumpy, count):
    found = detect(bumpy, count, purpose="touch")
    assert len(found.points) == len(set(found.points.tolist())) == count
    assert found.saliency is not None and found.saliency.max() == 1


def test_a_sphere_a_plane_and_one_face_have_places(sphere, grid):
    ball = sphere(3)
    found = detect(ball, 7, purpose="touch")
    assert len(found.points) == 7 and found.saliency is not None and found.saliency.min() > 0.5
    rows = grid(20, 30)
    assert len(find_points(Mesh(*rows), 7, purpose="touch")) == 7
    face = Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]]))
    assert sorted(find_points(face, 7, purpose="touch")) == [0, 1, 2]
    assert len(METHODS["touch"].find(Mesh(np.zeros((3, 3)), face.faces), None, Options(), 7).points) == 0


def test_small_arrays_feel_what_the_sensor_feels(bumpy):
    samples = samples_of_mesh(bumpy)
    at = spread(samples, 60)
    axes = sensor_axes(samples.normals[at])
    felt = imprints(pressed(samples.points, samples.normals, DISC * np.sqrt(samples.areas), axes, at, CELLS, WIDTH))
    meant = press_at(Surface(bumpy), samples.points[at], axes, (CELLS, CELLS), WIDTH / CELLS)
    assert np.abs(felt - meant.reshape(len(at), -1)).mean() < 0.02
    assert imprints(np.array([[[0.1, 0.3], [0.2, 0.3]]])) == pytest.approx(np.array([[0, 1, 0.5, 1]]))
    assert not imprints(0.1 + np.array([[[0, 5e-4], [0, 0]]])).any()  # rounding of a flat place is no relief


def test_places_are_spread_by_area_over_both_sides_of_a_sheet():
    sheet = trimesh.creation.box((0.8, 0.6, 0.001))
    samples = samples_of_mesh(Mesh(sheet.vertices, sheet.faces))
    normals = samples.normals[spread(samples, 400)]
    assert abs((normals[:, 2] > 0.9).mean() - 0.5) < 0.03 and (np.abs(normals[:, 2]) > 0.9).mean() > 0.95


def test_only_what_feels_alike_beyond_the_array_recurs():
    felt = np.array([[0.0, 1], [0, 1], [0.5, 0.5], [0.5, 0.5], [1, 0]])
    points = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 1, WIDTH / 2], [0, 0, 1]])
    found = recurrence(felt, points)
    assert found[0] == found[1] == 1  # alike and far apart
    assert found[2:4].max() < 0.01 and found[4] < 0.01  # alike within the array's width; like no other
