"""From pixels to the surface."""

import numpy as np
import pytest
import trimesh

from stages.conspicuity.project import project_pixels
from stages.kit import Mesh, RayScene, Viewpoint, camera

SIZE = (225, 300)


@pytest.fixture(scope="module")
def ball():
    mesh = trimesh.creation.icosphere(subdivisions=4, radius=0.5)
    return RayScene(Mesh(mesh.vertices, mesh.faces))


@pytest.mark.parametrize("viewpoint", [Viewpoint(0, 0), Viewpoint(120, -45), Viewpoint(0, 90), Viewpoint(40, 20, 30)])
def test_a_pixel_projects_to_the_analytic_point_of_the_sphere(ball, viewpoint):
    rows, columns = np.array([112, 60, 150]), np.array([149.5, 130, 200])
    vertices, positions = project_pixels(ball, rows, columns, viewpoint, SIZE)
    right, up, back = viewpoint.axes
    x = (columns - 149.5) / camera.pixels_per_unit(SIZE[0])
    y = (112 - rows) / camera.pixels_per_unit(SIZE[0])
    true = x[:, None] * right + y[:, None] * up + np.sqrt(0.25 - x**2 - y**2)[:, None] * back
    assert np.linalg.norm(positions - true, axis=1).max() < 0.002  # the facets' sagitta
    assert np.linalg.norm(ball.mesh.vertices[vertices] - true, axis=1).max() < 0.03  # within an edge length


def test_pixels_of_a_reduced_map_mean_the_same_places(ball):
    view = Viewpoint(30, 10)
    small = project_pixels(ball, [50], [120], view, SIZE)[1]
    full = project_pixels(ball, [50 * 4 + 1.5], [120 * 4 + 1.5], view, (900, 1200))[1]
    assert np.allclose(small, full, atol=1e-9)


def test_a_pixel_off_the_object_is_an_error(ball):
    with pytest.raises(ValueError, match="row 0, column 5.*az0_el0 is off the object"):
        project_pixels(ball, [112, 0], [150, 5], Viewpoint(0, 0), SIZE)


def test_a_pixel_takes_the_corner_nearest_to_where_it_hits():
    sliver = Mesh([[0, -0.4, 0], [0, 0.4, 0], [0, 0.4, 0.01]], [[0, 1, 2]])
    column = 149.5 - 0.39 * camera.pixels_per_unit(SIZE[0])
    vertices, _ = project_pixels(RayScene(sliver), [112 - 0.02], [column], Viewpoint(0, 0), SIZE)
    assert vertices.tolist() == [0]  # the centroid's nearest corner would be 1 or 2, 0.8 units away
