"""Ground truth saliency maps: round regions at the visible points, nothing off the object."""

import numpy as np
import pytest
import trimesh

from haptic_glance.look.camera import Viewpoint, project
from haptic_glance.mesh.mesh import Mesh
from stages.weights.ground_truth import gts_map, visible_points

WHOLE = np.ones((900, 1200), dtype=bool)
BALL = trimesh.creation.icosphere(3, radius=0.5)
MESH = Mesh(BALL.vertices, BALL.faces)


def test_a_point_is_a_round_region_of_the_kernels_size():
    values = gts_map([450], [600], WHOLE)
    assert values[450, 600] == values.max() == 1
    reach = np.array(np.nonzero(values * 255 >= 1)) - [[450], [600]]
    assert np.abs(reach).max() == 24  # visible in 8 bits just up to the edge of the 50 by 50 kernel
    assert np.linalg.norm(reach, axis=0).max() < 25  # and a disc, not the kernel's square
    assert values[450, 600 + 25] > 0 and values[450, 600 + 26] == 0
    np.testing.assert_allclose(values[450 - 24 : 475, 600 - 24 : 625], values[450 - 24 : 475, 600 - 24 : 625].T)


def test_a_smaller_map_has_the_same_regions():
    large, small = gts_map([449.5], [599.5], WHOLE), gts_map([112.0], [149.5], np.ones((225, 300), dtype=bool))
    assert small.sum() * 16 == pytest.approx(large.sum(), rel=0.02)


def test_neighbours_keep_their_full_height_and_never_add_up():
    values = gts_map([450, 450], [600, 606], WHOLE)
    assert values[450, 600] == values[450, 606] == values.max() == 1
    np.testing.assert_array_equal(values, np.maximum(gts_map([450], [600], WHOLE), gts_map([450], [606], WHOLE)))


def test_nothing_lies_off_the_object():
    mask = np.zeros((90, 120), dtype=bool)
    mask[:45] = True
    values = gts_map([45, 44.6], [60, 80], mask)
    assert (values[45:] == 0).all() and values[44, 60] > 0


def test_points_beside_the_image_and_no_points_at_all_are_no_error():
    assert gts_map([-500, 2000], [0, 5000], WHOLE).max() == 0
    assert gts_map([-3], [600], WHOLE).max() > 0.9
    assert gts_map([], [], WHOLE).max() == 0


@pytest.mark.parametrize(
    ("rows", "columns", "mask", "reason"),
    [([1, 2], [1], WHOLE, "rows, columns"), ([1], [np.nan], WHOLE, "NaN"), ([1], [1], WHOLE[0], "rows, columns")],
)
def test_bad_points_are_named(rows, columns, mask, reason):
    with pytest.raises(ValueError, match=reason):
        gts_map(rows, columns, mask)


@pytest.mark.parametrize("viewpoint", [Viewpoint(0, 0), Viewpoint(37, 21), Viewpoint(0, 90), Viewpoint(200, -45, 30)])
def test_a_convex_body_shows_the_vertices_of_the_faces_turned_to_the_camera(viewpoint):
    rows, columns, which = visible_points(MESH, np.arange(len(MESH.vertices)), viewpoint, (900, 1200))
    facing = MESH.face_normals @ viewpoint.axes[2]
    turned, edgewise = (set(MESH.faces[chosen].ravel()) for chosen in (facing > 1e-6, facing > -1e-6))
    assert turned <= set(which) <= edgewise
    expected = project(MESH.vertices[which], viewpoint, (900, 1200))
    np.testing.assert_array_equal((rows, columns), expected[:2])


def test_which_indexes_what_was_asked_in_its_order():
    near, far = int(MESH.vertices[:, 0].argmax()), int(MESH.vertices[:, 0].argmin())
    rows, columns, which = visible_points(MESH, [far, near, far, near], Viewpoint(0, 0), (900, 1200))
    assert which.tolist() == [1, 3] and len(rows) == len(columns) == 2


def test_a_wall_just_before_a_point_hides_it():
    wall = np.array([(0.1, -0.3, -0.3), (0.1, 0.3, -0.3), (0.1, 0.0, 0.4)])
    both = Mesh(np.r_[wall, wall - (1e-4, 0, 0), [(0.05, 0, 0)]], [(0, 1, 2), (3, 4, 5)])
    behind = [6]  # a vertex in no face
    assert len(visible_points(both, behind, Viewpoint(0, 0), (900, 1200))[2]) == 0
    assert len(visible_points(both, behind, Viewpoint(180, 0), (900, 1200))[2]) == 1
    assert visible_points(both, [0, 1, 2], Viewpoint(0, 0), (900, 1200))[2].tolist() == [0, 1, 2]
    inward = Mesh(both.vertices, both.faces[:, ::-1])
    assert visible_points(inward, [0, 1, 2, 6], Viewpoint(0, 0), (900, 1200))[2].tolist() == [0, 1, 2]


def test_vertices_that_the_mesh_lacks_are_named():
    with pytest.raises(ValueError, match=r"0\.\.641"):
        visible_points(MESH, [642], Viewpoint(0, 0), (900, 1200))
