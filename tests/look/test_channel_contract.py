"""Every channel: a map in 0..1 on the object, the same for the same surface, on odd meshes and views too."""

import dataclasses

import numpy as np
import pytest
import trimesh

from haptic_glance.look.channels import CHANNELS, conspicuity
from haptic_glance.look.channels.channels import OTHERS
from haptic_glance.look.views import Viewpoint, render
from haptic_glance.mesh.mesh import Mesh
from tests.shapes import lopsided, mesh_of

SIZE = (300, 400)
BALL = mesh_of(trimesh.creation.icosphere(subdivisions=3, radius=0.4))
BOX = mesh_of(trimesh.creation.box((0.6, 0.4, 0.3)))
FLAT = trimesh.creation.annulus(0.1, 0.4, height=0.1)
TRIANGLE = Mesh([[0, -0.4, -0.3], [0, 0.4, -0.3], [0, 0, 0.4]], [[0, 1, 2]])
ODD = {
    "one triangle": TRIANGLE,
    "flat": Mesh(FLAT.vertices[:, [2, 0, 1]] - [0.05, 0, 0], FLAT.faces[(FLAT.face_normals[:, 2] > 0.9)]),
    "loose vertex and faces without area": Mesh(
        np.r_[BALL.vertices, [[0.1, 0.2, 0.3]]], np.r_[BALL.faces, [[0, 0, 1], [2, 2, 2]]]
    ),
    "two pieces far apart": Mesh(
        np.r_[BALL.vertices * 0.1 - [0, 0.4, 0], BALL.vertices * 0.1 + [0, 0.4, 0]], np.r_[BALL.faces, BALL.faces + 642]
    ),
    "no face": Mesh([[0, 0, 0.0]], np.zeros((0, 3))),
}


@pytest.fixture(scope="module")
def bumpy_view():
    return render(lopsided(), Viewpoint(20, 10), SIZE, "raster")


@pytest.fixture(scope="module")
def bumpy_maps(bumpy_view):
    return conspicuity(lopsided(), bumpy_view)


@pytest.fixture(scope="module")
def box_view():
    return render(BOX, Viewpoint(30, 20), SIZE, "raster")


def test_maps_are_of_one_size_in_0_to_1_and_zero_off_the_object(bumpy_view, bumpy_maps):
    assert list(bumpy_maps) == list(CHANNELS) == sorted(CHANNELS)
    maps = bumpy_maps | conspicuity(lopsided(), bumpy_view, ["edge", *OTHERS], symmetry="strongest")
    assert list(maps) == [*CHANNELS, *OTHERS]
    off = ~bumpy_view.mask.reshape(75, 4, 100, 4).any(axis=(1, 3))
    for name, values in maps.items():
        assert values.shape == (75, 100) and values.dtype == np.float32
        assert np.isfinite(values).all() and values.min() >= 0 and values.max() <= 1 and not values[off].any()
        assert values.any() or name.startswith("symmetry") or name in ("color", "dkl")
    small = conspicuity(lopsided(), bumpy_view, ["fine_grained", "edge"], (30, 41))
    assert list(small) == ["fine_grained", "edge"] and {values.shape for values in small.values()} == {(30, 41)}


def test_maps_are_the_same_when_object_and_camera_turn_together_in_any_order_and_winding(bumpy_maps):
    mesh, rng = lopsided(), np.random.default_rng(5)
    turn = trimesh.transformations.euler_matrix(0, 0, np.radians(77))[:3, :3]
    order = rng.permutation(len(mesh.vertices))
    turned = Mesh((mesh.vertices @ turn.T)[order], rng.permutation(np.argsort(order)[mesh.faces])[:, ::-1])
    maps = conspicuity(turned, render(turned, Viewpoint(97, 10), SIZE, "raster"))
    for channel, values in bumpy_maps.items():
        assert np.abs(values - maps[channel]).max() < 0.03, channel


@pytest.mark.parametrize("name", ODD)
@pytest.mark.filterwarnings("error")
@pytest.mark.slow
def test_odd_meshes_give_finite_maps(name):
    view = render(ODD[name], Viewpoint(40, 30), (180, 240), "raster")
    for channel, values in conspicuity(ODD[name], view).items():
        assert np.isfinite(values).all() and values.min() >= 0 and values.max() <= 1, channel
        if name in ("one triangle", "no face", "flat"):
            assert not values.any() or channel == "symmetry", channel


@pytest.mark.parametrize("size", [(3, 5), (20, 31)])
def test_tiny_and_empty_views_give_finite_maps(size):
    view = render(BOX, Viewpoint(30, 20), size, "raster")
    assert all(np.isfinite(values).all() for values in conspicuity(BOX, view, [*CHANNELS, *OTHERS]).values())
    nothing = dataclasses.replace(view, face=np.full_like(view.face, -1), depth=np.full_like(view.depth, np.inf))
    for settings in ({}, {"filled": False, "formulas": "printed"}):
        assert not any(values.any() for values in conspicuity(BOX, nothing, [*CHANNELS, *OTHERS], **settings).values())


@pytest.mark.parametrize("name", ["spectral_residual", "fine_grained"])
def test_a_rival_sees_the_image_as_rendered_and_nothing_in_one_grey_value(name, box_view):
    white = dataclasses.replace(box_view, rgb=np.where(box_view.mask[..., None], box_view.rgb, np.uint8(255)))
    original, whitened = (conspicuity(BOX, view, [name])[name] for view in (box_view, white))
    assert np.abs(original - whitened).max() > 0.1
    np.testing.assert_array_equal(original, conspicuity(BOX, box_view, [name], filled=False)[name])
    flat = dataclasses.replace(box_view, rgb=np.full_like(box_view.rgb, 90))
    assert not conspicuity(BOX, flat, [name])[name].any()


@pytest.mark.parametrize("formulas", ["printed", "mended"])
def test_maps_of_the_printed_formulas_lie_in_0_to_1_on_the_object_alone(formulas):
    view = render(BALL, Viewpoint(30, 20), (225, 300), "raster")
    maps = conspicuity(BALL, view, [*CHANNELS, *OTHERS], filled=False, formulas=formulas)
    for name, values in maps.items():
        assert values.shape == (56, 75) and values.min() >= 0 and values.max() <= 1, name
    assert maps["intensity"].max() > 0.1 and not maps["contrast"][:1].any()


@pytest.mark.parametrize(
    ("mesh", "channels", "settings", "says"),
    [
        (TRIANGLE, ["curvature"], {}, "render this mesh again"),  # the view is of another mesh
        (BOX, ["colour"], {}, "unknown channel colour: choose from color"),
        (BOX, ["edge"], {"size": (0, 10)}, "size of the maps"),
        (BOX, ["edge"], {"symmetry": "all"}, "unknown symmetry 'all': choose one of perceived, strongest"),
        (BOX, ["edge"], {"formulas": "exact"}, "unknown formulas 'exact': choose one of ours, printed, mended"),
        (BOX, ["edge"], {"formulas": "printed"}, "filter whole pictures: keep the background"),
    ],
)
def test_bad_questions_are_named(box_view, mesh, channels, settings, says):
    with pytest.raises(ValueError, match=says):
        conspicuity(mesh, box_view, channels, **settings)
