"""The maps of a network on the surface: where they land, what they do not depend on, and what is said without torch."""

import sys

import numpy as np
import pytest
import trimesh

from haptic_glance.deep.network import build
from haptic_glance.look.glance import samples_of_mesh, standardised
from haptic_glance.look.points import METHODS, glance, saliency
from haptic_glance.look.points.glance import deep_features
from haptic_glance.look.weights import fixation_density
from haptic_glance.look.weights.weights import DEEP, GLANCES, MAPS
from haptic_glance.mesh import normalise
from haptic_glance.mesh.mesh import Mesh

pytestmark = pytest.mark.slow

torch = pytest.importorskip("torch")


@pytest.fixture
def brightness(monkeypatch):
    """In place of the network: one map for each of MAPS, all of them the brightness of 16 x 16 pixels."""

    def trunk(images):
        grey = torch.nn.functional.avg_pool2d(images.mean(dim=1, keepdim=True), 16)
        return grey.expand(-1, len(MAPS), -1, -1)

    monkeypatch.setattr(glance, "_trunk", lambda: trunk)


def body():
    """A box with a ball at one end, normalised."""
    head = trimesh.creation.icosphere(4, radius=0.15).apply_translation([0.3, 0.1, 0.3])
    shape = trimesh.util.concatenate([trimesh.creation.box((0.7, 0.3, 0.4)).subdivide_to_size(0.05), head])
    return normalise(Mesh(shape.vertices, shape.faces))


def first_map(mesh):
    """(samples, (s,) the first map on them)."""
    samples = samples_of_mesh(mesh)
    return samples, glance.maps_on_surface(mesh, samples)[:, 0]


def at(samples, values, places):
    return values[samples.tree.query(places)[1]]


def test_what_faces_the_views_is_bright_and_what_they_do_not_see_has_the_mean(brightness):
    cylinder = trimesh.creation.cylinder(0.35, 0.6, sections=64)
    samples, values = first_map(normalise(Mesh(cylinder.vertices, cylinder.faces)))
    side, middle = np.abs(samples.normals[:, 2]) < 0.1, np.abs(samples.points[:, 2]) < 0.15
    ends = np.abs(samples.normals[:, 2]) > 0.9
    inner = ends & (np.linalg.norm(samples.points[:, :2], axis=1) < 0.25)
    assert np.ptp(values[inner]) < 1e-9  # no view from the side sees them
    mean = np.average(values[side], weights=samples.areas[side])
    assert values[inner][0] == pytest.approx(mean, abs=0.02)
    assert values[side & middle].std() < 0.15 * values[side & middle].mean()


def test_a_map_that_hardly_varies_is_not_scaled_up(monkeypatch):
    ball = trimesh.creation.icosphere(4, radius=0.5)
    mesh = Mesh(ball.vertices, ball.faces)
    samples = samples_of_mesh(mesh)
    faint = np.linspace(0, 0.01, len(samples.points))[:, None] + np.zeros(len(MAPS))
    monkeypatch.setattr(glance, "maps_on_surface", lambda mesh, samples: faint)
    maps = glance.standardised_maps(mesh, samples)
    assert list(maps) == list(MAPS)
    for name, deviation in zip(MAPS, glance.DEVIATIONS, strict=True):
        assert np.ptp(maps[name]) == pytest.approx(0.02 / deviation)
    assert samples.shares @ maps[MAPS[0]] == pytest.approx(0, abs=1e-12)


def test_the_method_is_the_density_of_both_kinds_of_features(brightness):
    mesh = body()
    samples = samples_of_mesh(mesh)
    features = deep_features(mesh, samples)
    assert set(features) == set(DEEP["glance_deep"]) == {*GLANCES["glance"], *MAPS}
    assert all((features[name] == values).all() for name, values in standardised(samples).items())
    density = fixation_density(features, DEEP["glance_deep"])
    values = saliency(mesh, "glance_deep")
    near, shares = samples.interpolation(mesh.vertices, mesh.vertex_normals)
    assert np.corrcoef(values, (density[near] * shares).sum(axis=1))[0, 1] > 0.9999
    assert np.corrcoef(values, saliency(mesh, "glance"))[0, 1] < 0.999
    point = Mesh(np.zeros((3, 3)), np.array([[0, 1, 2]]))  # an object without area has no saliency
    assert not METHODS["glance_deep"].saliency(point, None, None).any()


def test_a_picture_and_its_mirror_image_are_laid_over_each_other():
    picture = torch.zeros(32, 32, 3, dtype=torch.uint8)
    picture[:, :8] = 255
    maps = glance._maps(lambda images: images.mean(dim=1, keepdim=True), picture)[0, 0]
    assert maps[:, :8].min() > maps[:, 8:].max()


def test_the_trunk_gives_the_last_maps_of_a_sixteenth_of_the_side_and_160_of_half_that_size():
    images = torch.rand(1, 3, 64, 96, generator=torch.Generator().manual_seed(0))
    with torch.no_grad():
        maps, blocks = glance._trunk()(images), build("mobilenet_v2", 2, "imagenet", 0).convolutions
        fine, coarse = blocks[:14](images), blocks[:17](images)
        assert maps.shape == (1, len(MAPS), 4, 6) and blocks[14](fine).shape == coarse.shape == (1, 160, 2, 3)
        assert torch.allclose(maps[:, :96], fine, atol=1e-4)
        # The mean of four interpolated pixels in the middle of a 2 x 3 map, and the nearest pixel in a corner.
        assert torch.allclose(maps[:, 96:, 0, 0], coarse[:, :, 0, 0], atol=1e-4)
        middle = coarse[:, :, :, 1].mean(dim=2)
        neighbours = coarse[:, :, :, [0, 2]].mean(dim=(2, 3))
        assert torch.allclose(maps[:, 96:, 1:3, 2:4].mean(dim=(2, 3)), 0.75 * middle + 0.25 * neighbours, atol=1e-4)


def test_without_torch_the_method_names_the_extra(monkeypatch):
    monkeypatch.setitem(sys.modules, "torch", None)
    message = r"^glance_deep needs torch, which is not installed: pip install '.*\[deep\]'$"
    with pytest.raises(ModuleNotFoundError, match=message):
        saliency(body(), "glance_deep")
