"""The silhouette is kept out: measured on analytic maps and on rendered shapes."""

from pathlib import Path

import numpy as np
import pytest
import trimesh

from haptic_glance.base.files import read_mesh
from haptic_glance.look.channels import CHANNELS, conspicuity
from haptic_glance.look.views import Viewpoint, render
from haptic_glance.mesh.mesh import Mesh
from stages.conspicuity.measure import background_rows, measured_maps, silhouette_share

MESHES = Path(__file__).parents[2] / "data/household/meshes"


def disc(radius=140):
    y, x = np.mgrid[:450, :600]
    return np.hypot(y - 225, x - 300), np.hypot(y - 225, x - 300) < radius


def test_an_even_map_has_share_one():
    _, mask = disc()
    assert silhouette_share(mask.astype(np.float32), mask) == pytest.approx(1, abs=0.01)


def test_a_lit_ring_has_a_high_share_and_an_empty_map_none():
    distance, mask = disc()
    assert silhouette_share((mask & (distance > 136)).astype(np.float32), mask) > 10
    assert silhouette_share((distance < 50).astype(np.float32), mask) == 0
    assert np.isnan(silhouette_share(np.zeros((450, 600), np.float32), mask))


def test_a_view_without_a_pixel_in_the_band_has_no_share():
    mask = np.zeros((60, 80), dtype=bool)
    mask[20:40, 30:50] = True
    assert np.isnan(silhouette_share(np.ones((15, 20), np.float32), mask))


def test_filling_keeps_a_box_from_being_outlined():
    box = trimesh.creation.box((0.5, 0.5, 0.3))
    mesh = Mesh(box.vertices, box.faces)
    view = render(mesh, Viewpoint(30, 20), (450, 600), "raster")
    _, filled = measured_maps(mesh, view, ["contrast", "edge", "orientation"], (112, 150))
    raw = background_rows(mesh, view, ["contrast", "edge", "orientation"], (112, 150))
    for with_fill, without in zip(filled, raw, strict=True):
        assert with_fill["value"] < 1.2 and with_fill["value"] < without["value"] and with_fill["seconds"] > 0


@pytest.mark.parametrize("name", ["elephant", "teapot", "airplane"])
def test_no_channel_lights_the_silhouette_of_a_real_object(name):
    if not (MESHES / f"{name}.npz").exists():
        pytest.skip("data/household/meshes is not here: `dvc repro meshes@household` makes it")
    mesh = read_mesh(MESHES / f"{name}.npz")
    shares = {channel: [] for channel in CHANNELS}
    for viewpoint in (Viewpoint(30, 20), Viewpoint(200, -30)):
        view = render(mesh, viewpoint, (450, 600), "raster")
        for channel, values in conspicuity(mesh, view).items():
            shares[channel].append(silhouette_share(values, view.mask))
    for channel, found in shares.items():
        most = 2.5 if channel == "curvature" else 2  # the sharp edges of a thin wing do lie along its silhouette
        assert np.isnan(found).all() or np.nanmean(found) < most, channel
