"""Odd meshes and views: a zero map or a clear error, never NaN."""

import dataclasses

import numpy as np
import pytest
import trimesh

from haptic_glance.look.channels import conspicuity
from haptic_glance.look.views import View, Viewpoint, render
from haptic_glance.mesh.mesh import Mesh

SIZE = (180, 240)
BALL = trimesh.creation.icosphere(subdivisions=3, radius=0.4)
FLAT = trimesh.creation.annulus(0.1, 0.4, height=0.1)
ODD = {
    "one triangle": Mesh([[0, -0.4, -0.3], [0, 0.4, -0.3], [0, 0, 0.4]], [[0, 1, 2]]),
    "flat": Mesh(FLAT.vertices[:, [2, 0, 1]] - [0.05, 0, 0], FLAT.faces[(FLAT.face_normals[:, 2] > 0.9)]),
    "inward normals": Mesh(BALL.vertices, BALL.faces[:, ::-1]),
    "loose vertex": Mesh(np.r_[BALL.vertices, [[0.1, 0.2, 0.3]]], BALL.faces),
    "two pieces far apart": Mesh(
        np.r_[BALL.vertices * 0.1 - [0, 0.4, 0], BALL.vertices * 0.1 + [0, 0.4, 0]], np.r_[BALL.faces, BALL.faces + 642]
    ),
    "faces without area": Mesh(BALL.vertices, np.r_[BALL.faces, [[0, 0, 1], [2, 2, 2]]]),
    "no face": Mesh([[0, 0, 0.0]], np.zeros((0, 3))),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", ODD)
@pytest.mark.filterwarnings("error")
def test_odd_meshes_give_finite_maps(name):
    for viewpoint in (Viewpoint(0, 0), Viewpoint(40, 30)):
        view = render(ODD[name], viewpoint, SIZE, "raster")
        for channel, values in conspicuity(ODD[name], view).items():
            assert np.isfinite(values).all() and values.min() >= 0 and values.max() <= 1, channel
            if name in ("one triangle", "no face", "flat"):
                assert not values.any() or channel == "symmetry", channel


@pytest.mark.slow
def test_inward_normals_change_nothing():
    outward = Mesh(BALL.vertices, BALL.faces)
    for viewpoint in (Viewpoint(0, 0), Viewpoint(40, 30)):
        here = conspicuity(outward, render(outward, viewpoint, SIZE, "raster"))
        there = conspicuity(ODD["inward normals"], render(ODD["inward normals"], viewpoint, SIZE, "raster"))
        for channel in here:
            np.testing.assert_allclose(here[channel], there[channel], atol=0.03)


def test_tiny_views_work():
    mesh = Mesh(BALL.vertices, BALL.faces)
    for size in ((9, 12), (3, 5), (40, 50)):
        maps = conspicuity(mesh, render(mesh, Viewpoint(0, 0), size, "raster"))
        assert all(np.isfinite(values).all() for values in maps.values())


def test_a_view_of_another_mesh_is_refused():
    mesh = Mesh(BALL.vertices, BALL.faces)
    view = render(mesh, Viewpoint(0, 0), SIZE, "raster")
    with pytest.raises(ValueError, match="render this mesh again"):
        conspicuity(ODD["one triangle"], view, ["curvature"])


def test_unknown_channels_and_sizes_are_named():
    mesh = ODD["one triangle"]
    view = render(mesh, Viewpoint(0, 0), SIZE, "raster")
    with pytest.raises(ValueError, match="colour.*choose from color"):
        conspicuity(mesh, view, ["colour"])
    with pytest.raises(ValueError, match="size of the maps"):
        conspicuity(mesh, view, ["edge"], (0, 10))


def test_a_view_of_the_wrong_type_of_pixels_is_refused():
    view = render(ODD["one triangle"], Viewpoint(0, 0), SIZE, "raster")
    floats = dataclasses.replace(view, rgb=view.rgb / 255)
    assert isinstance(floats, View)
    with pytest.raises(ValueError, match="rgb"):
        conspicuity(ODD["one triangle"], floats)
