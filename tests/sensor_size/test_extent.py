"""Where the touches of one sample lie, on a sphere with two salient caps."""

import numpy as np
import pytest
import trimesh

from haptic_glance.mesh.mesh import Mesh
from stages.sensor_size.protocol import EXTENTS, disc, salient_region, sample_vertices

SOLID = trimesh.creation.icosphere(subdivisions=4, radius=0.5)
BALL = Mesh(SOLID.vertices, SOLID.faces)
HEIGHT = BALL.vertices[:, 2]
SALIENCY = np.abs(HEIGHT) / 0.5  # 1 at both poles, 0 at the equator
TOP, BOTTOM = int(HEIGHT.argmax()), int(HEIGHT.argmin())


def test_a_region_is_connected_and_above_the_share():
    region = salient_region(BALL, SALIENCY, TOP)
    assert TOP in region and (HEIGHT[region] >= 0.4 - 1e-9).all()
    assert set(region) == set(np.flatnonzero(HEIGHT >= 0.4 - 1e-9))


def test_a_disc_has_the_area_of_the_region():
    region = salient_region(BALL, SALIENCY, TOP)
    area = BALL.vertex_areas[region].sum()
    found = disc(BALL, BOTTOM, area)
    assert BALL.vertex_areas[found].sum() == pytest.approx(area, rel=0.02) and HEIGHT[found].max() < -0.35


def test_a_region_of_one_vertex_takes_its_neighbours():
    lonely = np.zeros(len(HEIGHT))
    lonely[TOP] = 1
    found = salient_region(BALL, lonely, TOP)
    assert len(found) == 5 and TOP in found and (HEIGHT[found] > 0.45).all()


@pytest.mark.parametrize("extent", EXTENTS)
def test_every_extent_touches_as_often_and_begins_with_the_strongest_points(extent):
    points = np.r_[TOP, BOTTOM, np.random.default_rng(0).permutation(len(HEIGHT))[:9]]
    found = sample_vertices(BALL, SALIENCY, points, extent, np.random.default_rng(1))
    assert found.shape == (10,) and found[[0, 5]].tolist() == [TOP, BOTTOM]
    assert len(set(found)) == 10


def test_separate_points_are_each_touched_once():
    points = np.arange(11)
    found = sample_vertices(BALL, SALIENCY, points, "points", np.random.default_rng(1))
    assert sorted(found) == list(range(10))
