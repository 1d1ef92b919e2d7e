"""Pictures of meshes: light, colours and hidden points."""

import numpy as np

from haptic_glance.look.camera import Viewpoint
from haptic_glance.mesh.mesh import Mesh
from stages.charts.drawing import VIEWPOINT, colours, picture, visible, vivid
from stages.lod.error_figures import METHODS


def test_a_mesh_drawn_again_looks_as_if_drawn_alone_and_no_ray_at_its_rim_is_left_out(small):
    ball = small.ball()
    mesh, values = Mesh(0.3 * ball.vertices, ball.faces), np.random.default_rng(0).random(len(ball.vertices))
    wide = Mesh(np.vstack([mesh.vertices, [[0.4] * 3, [-0.4] * 3]]), mesh.faces)  # rays all round
    for options in ({}, {"values": values}, {"wires": True}, {"viewpoint": Viewpoint(20, 50)}, {"smoothing": 1}, {}):
        pixels = picture(mesh, rows=60, **options)
        for other in (wide, Mesh(mesh.vertices, mesh.faces)):
            assert np.array_equal(pixels, picture(other, rows=60, **options)), options


def test_picture_is_white_off_the_object_only(small):
    image = picture(small.ball(), rows=60)
    off = np.hypot(*(np.mgrid[:60, :60] - 29.5)) > 30
    assert (image[off] == 1).all()
    assert (image[30, 30] < 1).all()


def test_points_behind_the_object_are_hidden(small):
    mesh = small.ball()
    towards = mesh.vertices @ VIEWPOINT.axes[2]
    down, across = visible(mesh, np.array([towards.argmax(), towards.argmin()]), rows=60)
    assert len(down) == len(across) == 1
    assert abs(down[0] - 29.5) < 6


def test_colours_keep_the_order_and_are_not_spoilt_by_one_peak():
    values = np.r_[np.linspace(0, 0.1, 999), 1.0]
    shown = vivid(values)
    assert (np.diff(shown) >= 0).all() and shown.max() == 1
    assert np.median(shown) > 0.4
    assert vivid(np.zeros(5)).tolist() == [0] * 5
    assert vivid(np.r_[np.zeros(999), 0.5])[-1] == 1
    tints = colours(METHODS)  # of the chart of simplification
    assert len(set(tints.values())) == len(tints) == 8
