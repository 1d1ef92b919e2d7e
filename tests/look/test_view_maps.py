"""Maps on the surface."""

import numpy as np
import pytest
import trimesh

from haptic_glance.look.camera import Viewpoint
from haptic_glance.look.channels import ViewMaps
from haptic_glance.look.channels.surface import smoother
from haptic_glance.look.views import TWELVE
from haptic_glance.mesh.mesh import Mesh

SIZE = (75, 100)


def constant(mesh, viewpoints=TWELVE):
    return ViewMaps(mesh, viewpoints, {"edge": np.full((len(viewpoints), *SIZE), 0.5)})


def test_saliency_on_the_vertices_follows_the_maps(sight, ball, spot):
    values = sight.vertex_saliency(sight.maps["edge"], smoothing=0.005)
    true = np.exp(-((ball.vertices - spot) ** 2).sum(axis=1) / (2 * 0.15**2))
    assert np.abs(values - true / true.max()).max() < 0.05


def test_a_gap_in_what_is_seen_takes_its_neighbours_values(ball):
    mask = np.ones((1, *SIZE), dtype=bool)
    mask[0, 33:42, 45:54] = False  # 0.12 units wide, in the middle
    sight = ViewMaps(ball, TWELVE[:1], {"edge": np.full((1, *SIZE), 0.5)}, mask)
    values = sight.vertex_saliency(sight.maps["edge"])
    assert values[ball.vertices[:, 0] > 0.2].min() > 0.9


def test_saliency_fades_with_the_distance_from_what_is_seen(ball):
    sight = constant(ball, TWELVE[:1])  # from +x
    values = sight.vertex_saliency(sight.maps["edge"])
    x = ball.vertices[:, 0]
    assert values[(x < 0) & (x > -0.03)].min() > 0.5
    assert values[x < -0.4].max() < 0.15


def test_a_piece_that_nobody_sees_is_not_salient(ball):
    inner = trimesh.creation.icosphere(subdivisions=1, radius=0.1)
    n = len(ball.vertices)
    pair = Mesh(np.r_[ball.vertices, inner.vertices], np.r_[ball.faces, inner.faces + n])
    sight = constant(pair)
    values = sight.vertex_saliency(sight.maps["edge"])
    assert values[:n].min() > 0.98
    assert not values[n:].any()
    assert not sight.vertex_saliency(0 * sight.maps["edge"]).any()


def test_a_piece_that_is_seen_along_its_surface_alone_is_smoothed(ball):
    far = ball.vertices + 3
    pair = Mesh(np.r_[ball.vertices, far], np.r_[ball.faces, ball.faces + len(far)])
    confidence = np.repeat([1.0, 1e-20], len(far))
    smooth = smoother(pair, confidence)(np.ones(2 * len(far)))
    np.testing.assert_allclose(smooth[: len(far)], 1)
    np.testing.assert_allclose(smooth[len(far) :], 0, atol=1e-9)


def test_a_hidden_front_does_not_lend_its_value_to_the_back():
    wall = np.array([[0.45, -0.3, -0.3], [0.45, 0.3, -0.3], [0.45, 0.3, 0.3], [0.45, -0.3, 0.3]]) - [0.9, 0, 0]
    front = wall + [0.9, 0, 0]
    mesh = Mesh(np.r_[front, wall], [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]])
    maps = np.zeros((2, *SIZE))
    maps[0] = 1.0  # the view from +x, which sees the front alone
    sight = ViewMaps(mesh, [Viewpoint(0, 0), Viewpoint(180, 0)], {"edge": maps})
    values = sight.vertex_saliency(sight.maps["edge"])
    assert (values[:4] > 0.99).all()
    assert (values[4:] < 0.01).all()


def test_pixels_that_miss_the_object_or_lie_off_the_mask_do_not_count(ball):
    maps = {"edge": np.ones((1, *SIZE))}
    sight = ViewMaps(ball, TWELVE[:1], maps)
    disc = np.pi * (0.5 * sight.pixels_per_unit) ** 2
    assert abs(len(sight.vertices) / disc - 1) < 0.02  # the bounding box has 1.27 times as many
    mask = np.zeros((1, *SIZE), dtype=bool)
    mask[0, 30:40, 40:60] = True
    assert len(ViewMaps(ball, TWELVE[:1], maps, mask).vertices) == 200


@pytest.mark.parametrize(
    ("maps", "message"),
    [
        ({}, "no conspicuity maps"),
        ({"edge": np.zeros((11, 5, 5))}, "edge.*12 views"),
        ({"edge": np.zeros((12, 0, 5))}, "edge.*must have shape"),
        ({"edge": np.full((12, 5, 5), np.nan)}, "edge.*finite"),
        ({"edge": np.full((12, 5, 5), -1)}, "edge.*not negative"),
        ({"edge": np.zeros((12, 5, 5)), "color": np.zeros((12, 5, 6))}, "one shape"),
    ],
)
def test_bad_maps_are_errors(ball, maps, message):
    with pytest.raises(ValueError, match=message):
        ViewMaps(ball, TWELVE, maps)


def test_a_mesh_out_of_sight_is_an_error(ball):
    with pytest.raises(ValueError, match="normalise"):
        ViewMaps(Mesh(ball.vertices + [0, 50, 50], ball.faces), TWELVE[:1], {"edge": np.zeros((1, *SIZE))})
