"""The maps beside the nine: symmetry of one kind alone, and OpenCV's two static saliency models."""

import dataclasses

import numpy as np
import pytest
import trimesh

from haptic_glance.look.channels import CHANNELS, conspicuity
from haptic_glance.look.channels.channels import OTHERS, check_channels, resize_map
from haptic_glance.look.channels.symmetry import symmetric_points
from haptic_glance.look.views import Viewpoint, render
from haptic_glance.mesh.mesh import Mesh

SIZE = (300, 400)
RIVALS = ("spectral_residual", "fine_grained")


def kit_mesh(source):
    return Mesh(source.vertices, source.faces)


BOX = kit_mesh(trimesh.creation.box((0.6, 0.4, 0.3)))
CONE = kit_mesh(trimesh.creation.revolve([[0, -0.4], [0.3, -0.4], [0.15, 0], [0, 0.4]], sections=48))


def test_the_nine_stay_the_nine_and_the_others_are_known_beside_them():
    assert len(CHANNELS) == 9 and not set(CHANNELS) & set(OTHERS)
    assert list(OTHERS) == ["symmetry_lateral", "symmetry_radial", "spectral_residual", "fine_grained"]
    assert check_channels(["edge", *OTHERS]) == ["edge", *OTHERS]
    view = render(BOX, Viewpoint(30, 20), SIZE, "raster")
    assert list(conspicuity(BOX, view, ["fine_grained", "edge"])) == ["fine_grained", "edge"]
    assert list(conspicuity(BOX, view)) == list(CHANNELS)


@pytest.mark.parametrize("name", OTHERS)
def test_maps_are_finite_in_0_to_1_of_the_size_asked_for_and_zero_off_the_object(name):
    view = render(CONE, Viewpoint(30, 60), SIZE, "raster")
    for size in ((75, 100), (30, 41)):
        found = conspicuity(CONE, view, [name], size)[name]
        assert found.shape == size and found.dtype == np.float32 and np.isfinite(found).all()
        assert found.min() >= 0 and 0 < found.max() <= 1
    off = ~view.mask.reshape(75, 4, 100, 4).any(axis=(1, 3))
    assert not conspicuity(CONE, view, [name])[name][off].any()


@pytest.mark.parametrize("name", OTHERS)
@pytest.mark.parametrize("size", [(3, 5), (9, 12), (20, 31), (33, 44)])
def test_tiny_and_empty_views_give_finite_maps(name, size):
    view = render(BOX, Viewpoint(30, 20), size, "raster")
    assert np.isfinite(conspicuity(BOX, view, [name])[name]).all()
    nothing = dataclasses.replace(view, face=np.full_like(view.face, -1), depth=np.full_like(view.depth, np.inf))
    assert not conspicuity(BOX, nothing, [name])[name].any()


@pytest.mark.parametrize("name", RIVALS)
def test_one_grey_value_gives_nothing_and_floats_are_refused(name):
    view = render(BOX, Viewpoint(30, 20), SIZE, "raster")
    assert not conspicuity(BOX, dataclasses.replace(view, rgb=np.full_like(view.rgb, 90)), [name])[name].any()
    with pytest.raises(ValueError, match="uint8"):
        conspicuity(BOX, dataclasses.replace(view, rgb=view.rgb / 255), [name])


@pytest.mark.parametrize("name", RIVALS)
def test_a_rival_sees_the_image_as_rendered(name):
    view = render(BOX, Viewpoint(30, 20), SIZE, "raster")
    black, white = view, dataclasses.replace(view, rgb=np.where(view.mask[..., None], view.rgb, np.uint8(255)))
    here, there = (conspicuity(BOX, each, [name])[name] for each in (black, white))
    assert np.abs(here - there).max() > 0.1
    np.testing.assert_array_equal(here, conspicuity(BOX, view, [name], filled=False)[name])


def test_a_mirror_plane_is_lateral_and_an_axis_radial():
    tip, flank = np.array([[0, 0, 0.4]]), np.array([[0.0, 0.15, 0.0]])
    across, along = np.array([1.0, 0, 0]), np.array([0, 0, 1.0])
    assert symmetric_points(CONE, tip, along, ("radial",))[0] > 0.9
    assert symmetric_points(CONE, tip, along, ("lateral",))[0] < 1e-4  # seen along its axis, no plane is special
    assert symmetric_points(CONE, np.array([[0.15, 0, 0]]), across, ("lateral",))[0] > 0.9
    assert symmetric_points(CONE, flank, across, ("lateral",))[0] < 0.1
    assert symmetric_points(CONE, tip, across, ("radial",))[0] < 1e-6


@pytest.mark.parametrize("mesh", [BOX, CONE], ids=["box", "cone"])
def test_both_kinds_together_are_the_stronger_of_the_two(mesh):
    back = Viewpoint(25, 35).axes[2]
    each = [symmetric_points(mesh, mesh.vertices, back, (kind,)) for kind in ("lateral", "radial")]
    np.testing.assert_array_equal(symmetric_points(mesh, mesh.vertices, back), np.maximum(*each))


def test_the_lateral_map_shows_the_plane_and_the_radial_map_the_pole():
    view = render(CONE, Viewpoint(0, 60), SIZE, "raster")
    found = conspicuity(CONE, view, ["symmetry_lateral", "symmetry_radial"])
    lateral, radial = found.values()
    assert (
        np.abs(np.argmax(lateral, axis=1)[lateral.max(axis=1) > 0.3 * lateral.max()] - 49.5).max() < 3
    )  # down the middle column
    rows, columns = np.nonzero(radial > 0.5 * radial.max())
    assert np.ptp(rows) < 15 and np.ptp(columns) < 15 and (lateral > 0.5 * lateral.max()).sum() > 2 * len(rows)


def test_a_shape_without_an_axis_has_no_radial_map():
    view = render(BOX, Viewpoint(30, 20), SIZE, "raster")
    found = conspicuity(BOX, view, ["symmetry", "symmetry_lateral", "symmetry_radial"])
    assert found["symmetry_lateral"].any() and not found["symmetry_radial"].any()
    np.testing.assert_array_equal(found["symmetry"], found["symmetry_lateral"])


@pytest.mark.parametrize("shape", [(17, 23), (20, 31), (33, 44), (97, 130), (900, 1200)])
@pytest.mark.parametrize("scale", [2, 4])
def test_fit_knows_the_scale_of_a_map_by_its_size(shape, scale):
    sides = [-(-side // 2**scale) for side in shape]
    found = resize_map(np.ones(sides, dtype=np.float32), shape, (12, 16))
    np.testing.assert_allclose(found, 1, rtol=1e-5)
    slope = resize_map(np.arange(sides[1], dtype=np.float32)[None].repeat(sides[0], axis=0), shape, (12, 16))[6]
    expected = ((np.arange(16) + 0.5) * shape[1] / 16 - 0.5) / 2**scale
    inner = (expected > 1) & (expected < sides[1] - 2)
    np.testing.assert_allclose(slope[inner], expected[inner], atol=0.15)
