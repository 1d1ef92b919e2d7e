"""Grad-CAM from cached maps is Grad-CAM by backpropagation; fusion of maps; maps on the surface."""

import numpy as np
import pytest
import torch

from stages.conspicuity import facing
from stages.fixation import entropy, fuse, grad_cam, highest_level, mean_over_views, project_to_vertices
from stages.fixation.attention import MODELS, project_maps
from stages.fixation.backbone import folded_network, last_maps, state_path, write_state
from stages.fixation.cam import resize_cams
from stages.fixation.heads import fit_head, scores
from stages.fixation.options import method_named
from stages.fixation.pictures import network_inputs
from stages.fixation.viewpoints import viewpoint_sphere
from stages.kit import Viewpoint
from stages.kit.camera import project
from stages.kit.files import sha256
from stages.networks import build, recalibrate

pytestmark = pytest.mark.slow

SIZE = 96


@pytest.fixture(scope="module")
def network():
    """An untrained MobileNetV2 with a head of five classes that are not all alike."""
    found = build("mobilenet_v2", 5, "random", 0)
    images = torch.rand(8, 3, SIZE, SIZE, generator=torch.Generator().manual_seed(0))
    recalibrate(found, lambda ids: images[ids], np.arange(8))
    torch.manual_seed(0)
    torch.nn.init.normal_(found.head[1].weight)
    return found


@pytest.fixture(scope="module")
def pictures():
    return np.random.default_rng(0).integers(0, 256, (4, SIZE, SIZE)).astype(np.uint8)


def by_backpropagation(network, pictures, classes):
    """(b, i, j): T eq. 3.18 and 3.19 as they stand, the gradient by torch."""
    maps = network.convolutions(network_inputs(pictures)).detach().requires_grad_(True)
    found = network.head(network.pool(maps).flatten(1))
    found[torch.arange(len(found)), torch.as_tensor(classes)].sum().backward()
    alpha = maps.grad.mean(dim=(2, 3), keepdim=True)
    return torch.relu((alpha * maps).sum(dim=1)).detach().numpy()


@pytest.mark.parametrize("shift", [0, 1, 3])
def test_grad_cam_from_maps_equals_the_one_by_backpropagation(network, pictures, shift):
    maps = last_maps(network, pictures)
    weights, bias = (x.detach().numpy() for x in (network.head[1].weight, network.head[1].bias))
    classes = (scores(maps.mean(axis=(2, 3)), weights, bias).argmax(axis=1) + shift) % 5
    expected = by_backpropagation(network, pictures, classes)
    assert expected.max() > 0.01
    assert np.abs(grad_cam(maps, weights, classes) - expected).max() < 1e-5 * expected.max()


@pytest.mark.parametrize("name", ["mobilenet_v2", "efficientnet_lite0"])
def test_folded_normalisations_leave_the_maps_as_they_were_and_follow_the_stored_weights(name, tmp_path):
    method, pictures = method_named(f"{name}-random"), np.random.default_rng(0).integers(0, 256, (2, 64, 64))
    found = []
    for seed in (0, 1):
        plain = build(name, 2, "random", seed)
        for layer in plain.modules():
            if isinstance(layer, torch.nn.BatchNorm2d):
                layer.running_mean.normal_(0, 0.1)
                layer.running_var.uniform_(0.5, 2)
        write_state(tmp_path, method.name, plain)
        folded = folded_network(tmp_path, method, "package", 0, sha256(state_path(tmp_path, method.name)))
        assert not any(isinstance(layer, torch.nn.BatchNorm2d) for layer in folded.convolutions.modules())
        expected, maps = (last_maps(network, pictures.astype(np.uint8)) for network in (plain, folded))
        assert np.abs(maps - expected).max() < 1e-5 * np.abs(expected).max()
        found.append(maps)
    assert np.abs(found[0] - found[1]).max() > 0.1 * np.abs(found[0]).max()


def test_vgg_is_looked_at_before_its_last_pooling():
    pictures = np.zeros((1, 32, 32), dtype=np.uint8)
    assert last_maps(build("vgg16", 2, "random", 0), pictures).shape == (1, 512, 2, 2)


def test_maps_that_do_not_fit_are_refused():
    with pytest.raises(ValueError, match="do not fit"):
        grad_cam(np.zeros((2, 3, 4, 4)), np.zeros((5, 4)), [0, 1])


def test_a_head_names_what_can_be_told_apart_and_survives_dead_channels():
    draw = np.random.default_rng(0)
    labels = np.repeat([0, 1, 2], 30)
    features = draw.normal(size=(90, 12)) * 10.0 ** draw.integers(-3, 3, 12) + 5
    features[:, 4] = 7.0
    features[:, 0] += 50 * features[:, 0].std() * labels
    for classes in (labels, labels.clip(max=1)):
        weights, bias = fit_head(features, classes, 0.1)
        assert weights.shape == (classes.max() + 1, 12) and np.isfinite(weights).all() and not weights[:, 4].any()
        assert (scores(features, weights, bias).argmax(axis=1) == classes).mean() > 0.95


def test_entropy_of_known_pictures():
    assert entropy(np.full((8, 8), 0.3)) == 0 and not np.signbit(entropy(np.zeros((8, 8))))
    halves = np.repeat([[0.0, 1.0]], 8, axis=0)
    assert entropy(halves) == pytest.approx(1)
    assert entropy(np.arange(256).reshape(16, 16) / 255) == pytest.approx(8)


def test_fusion_weighs_by_entropy():
    halves, steps = np.repeat([[0.0, 0, 1, 1]], 4, axis=0), np.repeat([[0.0, 1 / 3, 2 / 3, 1]], 4, axis=0)
    assert np.allclose(fuse(np.stack([halves, steps])), (1 * halves + 2 * steps) / 3)


def test_a_constant_map_has_no_say_and_constant_maps_alone_say_nothing():
    steps, even = np.repeat([[0.0, 1 / 3, 2 / 3, 1]], 4, axis=0), np.full((4, 4), 0.9)
    assert np.allclose(fuse(np.stack([steps, even])), steps)
    for value in (0.0, 0.5, 1.0):
        assert not fuse(np.full((3, 4, 4), value)).any()
        assert not fuse(highest_level(np.full((3, 4, 4), value))).any()


def test_narrowing_keeps_the_highest_of_four_levels():
    levels = np.repeat([0.1, 0.4, 0.7, 1.0], 16).reshape(8, 8)
    kept = highest_level(levels[None])[0]
    assert (kept[levels == 1.0] == 1.0).all() and not kept[levels < 1.0].any()


@pytest.mark.parametrize("bad", [np.full((1, 4, 4), 1.2), np.full((1, 4, 4), np.nan), np.zeros((4, 4))])
def test_maps_outside_0_to_1_are_refused(bad):
    with pytest.raises(ValueError, match="pictures must"):
        fuse(bad)


def test_a_map_keeps_its_place_when_it_is_enlarged():
    cam = np.zeros((2, 7, 7), dtype=np.float32)
    cam[0, 2, 5] = 3
    large = resize_cams(cam, 224, "mobilenet_v2")
    row, column = np.unravel_index(large[0].argmax(), (224, 224))
    assert (row, column) == (2 * 32, 5 * 32) and large[0].max() == 1
    assert not large[1].any()


def test_a_picture_of_positions_comes_back_as_positions(shapes):
    ball, viewpoint = shapes["ball"], Viewpoint(40, 25)
    seen = facing(ball, [viewpoint])[0] > 0
    rows, columns = np.mgrid[:64, :64].astype(float)
    found = project_to_vertices(np.stack([rows, columns]), ball, viewpoint, seen)
    expected = project(ball.vertices, viewpoint, (64, 64))
    assert 0.4 < seen.mean() < 0.6 and not found[:, ~seen].any()
    assert np.allclose(found[:, seen], np.array(expected[:2])[:, seen], atol=1e-9)


def test_views_are_averaged_over_those_that_see():
    seen = np.array([[True, True, False], [True, False, False]])
    values = np.array([[[2.0, 4.0, 0.0]], [[4.0, 0.0, 0.0]]])
    assert mean_over_views(values, seen).tolist() == [[3.0, 4.0, 0.0]]


def test_what_every_task_sees_at_one_place_lies_there_on_the_surface(shapes):
    ball, views = shapes["ball"], viewpoint_sphere(1, 6)
    place = np.array([0.0, 0.0, 0.5])
    tasks = ("curvature", "eccentricity", "level_1", "level_2", "convexity")
    cams = []
    for viewpoint in views:
        row, column, _ = (float(x[0]) for x in project(place[None], viewpoint, (14, 14)))
        r, c = np.mgrid[:14, :14]
        cams.append(np.exp(-((r - row) ** 2 + (c - column) ** 2) / 4))
    seen = facing(ball, views) > 0
    values, bits = project_maps(dict.fromkeys(tasks, np.stack(cams)), ball, views, seen, 224, "vgg16")
    whole = mean_over_views(values, seen)
    assert (
        values.shape == (8, len(tasks) + len(MODELS), len(ball.vertices))
        and set(bits) == set(tasks)
        and all(b > 1 for b in bits.values())
    )
    for one in whole:
        assert np.linalg.norm(ball.vertices[one.argmax()] - place) < 0.1
    assert (whole[6] > 0).mean() < (whole[5] > 0).mean()  # four levels leave less
