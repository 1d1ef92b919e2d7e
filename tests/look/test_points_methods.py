"""Methods by name and by purpose, and the places worth touching, where the imprint of the array recurs."""

import numpy as np
import pytest
import trimesh
from scipy.spatial import KDTree

from haptic_glance import load
from haptic_glance.gallery.demo import sample
from haptic_glance.look.channels.channels import CHANNELS, OTHERS
from haptic_glance.look.glance import samples_of_mesh
from haptic_glance.look.points import METHODS, detect, find_points
from haptic_glance.look.points.find import Looked, check_name
from haptic_glance.look.points.methods import MEANT
from haptic_glance.look.points.recurring_imprints import CELLS, DISC, WIDTH, imprints, pressed, recurrence, spread
from haptic_glance.mesh import normalise
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import Surface, press_at
from haptic_glance.touch.surface import sensor_axes
from tests.shapes import mesh_of, raised_ball


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("thesis", "did you mean thesis_ssim"),
        ("visual-attention", "did you mean itti"),
        ("glanse", "did you mean glance"),
        ("Lee", "did you mean mesh_saliency"),
        ("visatt", "did you mean VisAtt"),
        ("farthest", "it has no saliency"),
        ("svm", "learned in the pipeline"),
        ("qem", "no such method"),
    ],
)
def test_a_name_that_cannot_run_is_answered_with_ours_or_the_reason(name, message):
    with pytest.raises(ValueError, match=f"--method {name}: .*{message}"):
        check_name(name)


def test_names_that_run_pass_and_what_resembles_nothing_is_answered_with_the_list():
    for name in ("glance", "glance_any_pose", "itti", "thesis_ssim"):
        check_name(name)
    check_name("qem", ["qem"])
    check_name("farthest", points_alone=True)
    with pytest.raises(ValueError, match="no such method; choose one of qem, glance, "):
        check_name("xyzzy", ["qem"])
    assert set(MEANT.values()) <= set(METHODS) and not set(MEANT) & set(METHODS)
    assert all(set(method.channels) <= {*CHANNELS, *OTHERS} for method in METHODS.values())


@pytest.fixture(scope="module")
def bumpy():
    tops = np.array([[1, 0, 0], [-1, 0, 0.2], [0, 1, 0.5], [0, -1, -0.3], [0.3, 0.2, 1]])
    return normalise(raised_ball(tops / np.linalg.norm(tops, axis=1, keepdims=True), [0.15] * 5, [0.2] * 5))


@pytest.mark.slow
def test_a_purpose_chooses_the_method(bumpy):
    assert (find_points(bumpy, 5, purpose="touch") == find_points(bumpy, "touch", 5)).all()
    points = find_points(bumpy, "glance", 5)
    assert (find_points(bumpy, 5, purpose="look") == points).all() and (find_points(bumpy, 5) == points).all()
    with pytest.raises(ValueError, match="unknown purpose 'lick': choose one of look, touch$"):
        find_points(bumpy, 5, purpose="lick")
    with pytest.raises(ValueError, match="'touch' chooses the method: leave out method 'itti'"):
        detect(bumpy, "itti", 5, purpose="touch")


@pytest.mark.slow
def test_the_order_and_the_number_of_faces_change_no_place_to_touch(bumpy):
    places = bumpy.vertices[find_points(bumpy, 12, purpose="touch")]
    faces = np.roll(np.random.default_rng(0).permutation(bumpy.faces), 1, axis=1)
    assert (places == bumpy.vertices[find_points(Mesh(bumpy.vertices, faces), 12, purpose="touch")]).all()
    fine = Mesh(*trimesh.remesh.subdivide(bumpy.vertices, bumpy.faces))
    again = fine.vertices[find_points(fine, 12, purpose="touch")]
    edge = np.linalg.norm(bumpy.vertices[bumpy.faces[:, 0]] - bumpy.vertices[bumpy.faces[:, 1]], axis=1).max()
    assert np.linalg.norm(places - again, axis=1).max() < edge


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
    samples = samples_of_mesh(mesh_of(trimesh.creation.box((0.8, 0.6, 0.001))))
    normals = samples.normals[spread(samples, 400)]
    assert abs((normals[:, 2] > 0.9).mean() - 0.5) < 0.03 and (np.abs(normals[:, 2]) > 0.9).mean() > 0.95


def test_only_what_feels_alike_beyond_the_array_recurs():
    felt = np.array([[0.0, 1], [0, 1], [0.5, 0.5], [0.5, 0.5], [1, 0]])
    points = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 1, WIDTH / 2], [0, 0, 1]])
    shares = recurrence(felt, points)
    assert shares[0] == shares[1] == 1  # alike and far apart
    assert shares[2:4].max() < 0.01 and shares[4] < 0.01  # alike within the array's width; like no other


@pytest.mark.slow
def test_strong_points_are_the_peaks_more_than_a_deviation_above_the_mean():
    looked = Looked(load(sample()))
    values, areas, points = looked.view_maps.smooth, looked.view_maps.samples.areas, looked.view_maps.samples.points
    near = KDTree(points).query_ball_point(points, looked.options.radius)
    is_peak = np.array([values[k] >= values[ids].max() for k, ids in enumerate(near)])
    mean = np.average(values, weights=areas)
    is_high = values > mean + np.sqrt(np.average((values - mean) ** 2, weights=areas))
    assert looked.detect().strong == len(looked.detect().points) == (is_peak & is_high).sum() < is_peak.sum()
