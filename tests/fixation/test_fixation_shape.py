"""Curvature, eccentricity and viewpoints of known shapes, and whether the most salient place is one from all sides."""

import numpy as np
import pytest

from haptic_glance.mesh.mesh import Mesh
from stages.fixation.places import curvature_shares, eccentricity, gaussian_curvature, nearer
from stages.fixation.tasks import evaluated_views, viewpoint_sphere


def test_curvature_of_known_shapes_and_its_total_by_gauss_and_bonnet(shapes):
    assert np.allclose(gaussian_curvature(shapes["ball"]), 4, rtol=0.1)  # 7 % off where five faces meet, not six
    assert curvature_shares(shapes["ball"]) == (1, 0, 0)
    for name in ("tube", "flat"):  # what unrolls has none
        assert np.abs(gaussian_curvature(shapes[name])).max() < 1e-6
        assert curvature_shares(shapes[name]) == (0, 0, 1)
    for name, turns in (("ball", 2), ("egg", 2), ("torus", 0)):
        total = gaussian_curvature(shapes[name]) @ shapes[name].vertex_areas
        assert total == pytest.approx(2 * np.pi * turns, abs=1e-6)
    positive, negative, zero = curvature_shares(shapes["torus"])
    assert positive == pytest.approx(0.5, abs=0.05) and negative == pytest.approx(0.5, abs=0.05) and zero < 0.1


def test_measures_ignore_size_turn_order_and_seams(shapes):
    egg = shapes["egg"]
    turn = np.linalg.qr(np.random.default_rng(0).normal(size=(3, 3)))[0]
    order = np.random.default_rng(1).permutation(len(egg.vertices))
    moved = Mesh((7 * egg.vertices @ turn + 3)[np.argsort(order)], order[egg.faces])
    assert eccentricity(moved) == pytest.approx(eccentricity(egg))
    assert curvature_shares(moved) == pytest.approx(curvature_shares(egg))
    apart = Mesh(egg.vertices[egg.faces].reshape(-1, 3), np.arange(3 * len(egg.faces)).reshape(-1, 3))
    assert np.allclose(gaussian_curvature(apart), gaussian_curvature(egg)[egg.faces.ravel()])


def test_a_mesh_without_area_is_refused_and_a_vertex_in_no_face_counts_for_nothing(shapes):
    for measure in (curvature_shares, eccentricity):
        with pytest.raises(ValueError, match="no face with an area"):
            measure(Mesh(np.zeros((3, 3)), np.array([[0, 1, 2]])))
    ball = shapes["ball"]
    loose = Mesh(np.r_[ball.vertices, [[9, 9, 9]]], ball.faces)
    assert eccentricity(loose) == pytest.approx(eccentricity(ball)) and curvature_shares(loose) == (1, 0, 0)
    assert np.isfinite(gaussian_curvature(loose)).all()


def test_the_thesis_has_218_viewpoints():
    views = viewpoint_sphere(9, 24)
    assert len(views) == len(set(views)) == 218
    three = [views[k] for k in evaluated_views(9, 24)]
    assert [(v.azimuth, v.elevation) for v in three] == [(0, 0), (120, 0), (240, 0)]


VIEWS = viewpoint_sphere(1, 3)[:3]
AXES = np.array([view.axes[2] for view in VIEWS])


def looked_at(mesh, peak=None, blind=()):
    """The gains of a map that is highest towards `peak` in all views, or at each picture's middle for None."""
    seen = (mesh.vertices @ AXES.T > -0.05).T
    seen[list(blind)] = False
    values = np.stack([mesh.vertices @ (axis if peak is None else np.asarray(peak, float)) for axis in AXES])
    return nearer(mesh, VIEWS, seen, values.astype(np.float16) + 0.5)


def test_one_place_seen_from_all_sides_is_told_from_chance_and_from_the_middle_of_each_picture(ball):
    pole = looked_at(ball, (0, 0, 1))
    assert min(pole.values()) > 0.4 and len(pole) == 2  # all views look at it
    middle = looked_at(ball)  # no place of the object
    assert middle["nearer_than_chance"] < -0.05
    assert middle["nearer_than_middle"] == pytest.approx(0, abs=0.01)
    assert looked_at(ball, (0, 0, 1), blind=[1, 2]) == {}  # a view that sees nothing has no place
    assert len(looked_at(ball, (0, 0, 1), blind=[2])) == 2
