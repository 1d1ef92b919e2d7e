"""Grad-CAM from cached maps is Grad-CAM by backpropagation; fusion of maps; maps on the surface."""

from functools import partial

import numpy as np
import pytest
import torch

from haptic_glance.base.files import sha256
from haptic_glance.deep.cam import grad_cam
from haptic_glance.deep.network import Network, build
from haptic_glance.deep.resize import resize_cams
from haptic_glance.look.camera import Viewpoint, project
from haptic_glance.look.channels import facing
from stages.fixation.attention import MODELS, linear_scores, project_maps, to_surface
from stages.fixation.backbone import folded_network, last_maps, method_named, state_path, write_state
from stages.fixation.finetune import fit_head, scores
from stages.fixation.fusion import entropy, fuse, highest_level
from stages.fixation.places import mean_over_views, project_to_vertices
from stages.fixation.tasks import viewpoint_sphere

pytestmark = pytest.mark.slow


def by_backpropagation(network, images, classes):
    """((b, i, j), (b, C, i, j)): T eq. 3.18 and 3.19 as they stand, image by image, and the gradients by torch."""
    kept, maps, gradients = [], [], []
    hook = network.convolutions.register_forward_hook(lambda *made: kept.append(made[-1]) or made[-1].retain_grad())
    for image, number in zip(images, classes, strict=True):
        network(image[None])[0, int(number)].backward()
        features = kept[-1].detach()[0]
        alpha = [kept[-1].grad[0, k].sum() / features[0].numel() for k in range(len(features))]
        maps.append(torch.relu(sum(weight * features[k] for k, weight in enumerate(alpha))).numpy())
        gradients.append(kept[-1].grad[0].numpy())
    hook.remove()
    return np.stack(maps), np.stack(gradients)


def small_network(hidden):
    """(a Network of one convolution whose classes are not all alike, its images (6, 3, 32, 32))."""
    torch.manual_seed(0)
    convolutions = torch.nn.Sequential(torch.nn.Conv2d(3, 4, 3, padding=1), torch.nn.ReLU())
    layers = torch.nn.Sequential(torch.nn.Linear(4 * 7 * 7, 6), torch.nn.ReLU()) if hidden else None
    network = Network(convolutions, 6 if hidden else 4, 3, 0.5, layers).eval()
    torch.nn.init.normal_(network.head[-1].weight)
    return network, torch.rand(6, 3, 32, 32)


@pytest.mark.parametrize("hidden", [False, True])
def test_grad_cam_from_maps_is_the_one_by_backpropagation_of_each_class(hidden):
    network, images = small_network(hidden)
    maps = network.convolutions(images).detach()
    predicted = grad_cam(maps, network.classify)[1]
    assert (predicted == network(images).argmax(dim=1).numpy()).all()
    for classes in (predicted, (predicted + 1) % 3, (predicted + 2) % 3):
        expected, gradients = by_backpropagation(network, images, classes)
        varies = gradients.std(axis=(2, 3)).max(axis=1) > 1e-6 * np.abs(gradients).max()
        assert varies.all() if hidden else not varies.any()
        assert np.abs(grad_cam(maps, network.classify, classes)[0] - expected).max() < 1e-5 * np.abs(expected).max()
    if not hidden:  # a head on the mean of each map weighs the maps by it
        weights, classes = network.head[-1].weight.detach(), np.arange(6) % 3
        head = partial(linear_scores, weights=weights, bias=network.head[-1].bias.detach())
        expected = torch.relu(torch.einsum("bc,bcij->bij", weights[classes] / 32**2, maps)).numpy()
        cams, explained = grad_cam(maps, head, classes)
        assert expected.max() > 0 and np.allclose(cams, expected, rtol=1e-5, atol=1e-8)
        assert explained.tolist() == classes.tolist()


@pytest.mark.parametrize(("name", "seeds"), [("mobilenet_v2", (0, 1)), ("efficientnet_lite0", (0,))])
def test_folded_normalisations_leave_the_maps_as_they_were_and_follow_the_stored_weights(name, seeds, tmp_path):
    method, pictures = method_named(f"{name}-random"), np.random.default_rng(0).integers(0, 256, (2, 64, 64))
    per_seed = []
    for seed in seeds:
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
        per_seed.append(maps)
    if len(seeds) > 1:
        assert np.abs(per_seed[0] - per_seed[1]).max() > 0.1 * np.abs(per_seed[0]).max()


def test_vgg_is_looked_at_before_its_last_pooling():
    pictures = np.zeros((1, 32, 32), dtype=np.uint8)
    assert last_maps(build("vgg16", 2, "random", 0), pictures).shape == (1, 512, 2, 2)


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


def test_fusion_weighs_by_entropy_and_a_constant_map_has_no_say():
    assert entropy(np.full((8, 8), 0.3)) == 0 and not np.signbit(entropy(np.zeros((8, 8))))
    assert entropy(np.arange(256).reshape(16, 16) / 255) == pytest.approx(8)
    halves, steps = np.repeat([[0.0, 0, 1, 1]], 4, axis=0), np.repeat([[0.0, 1 / 3, 2 / 3, 1]], 4, axis=0)
    assert np.allclose(fuse(np.stack([halves, steps])), (1 * halves + 2 * steps) / 3)
    assert np.allclose(fuse(np.stack([steps, np.full((4, 4), 0.9)])), steps)
    for value in (0.0, 0.5, 1.0):
        assert not fuse(np.full((3, 4, 4), value)).any()
        assert not fuse(highest_level(np.full((3, 4, 4), value))).any()


def test_narrowing_keeps_the_highest_of_four_levels():
    levels = np.repeat([0.1, 0.4, 0.7, 1.0], 16).reshape(8, 8)
    kept = highest_level(levels[None])[0]
    assert (kept[levels == 1.0] == 1.0).all() and not kept[levels < 1.0].any()
    cams = np.zeros((4, 7, 7))
    cams[0, 3, 3], cams[1] = 1, 0.5


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
    positions = project_to_vertices(np.stack([rows, columns]), ball, viewpoint, seen)
    expected = project(ball.vertices, viewpoint, (64, 64))
    assert 0.4 < seen.mean() < 0.6 and not positions[:, ~seen].any()
    assert np.allclose(positions[:, seen], np.array(expected[:2])[:, seen], atol=1e-9)


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
    place_on = partial(to_surface, mesh=ball, viewpoints=views, seen=seen, renders=None)
    values, bits = project_maps(dict.fromkeys(tasks, np.stack(cams)), place_on, 224, "vgg16")
    whole = mean_over_views(values, seen)
    few = np.array([[[2.0, 4.0, 0.0]], [[4.0, 0.0, 0.0]]])  # averaged over the views that see
    assert mean_over_views(few, np.array([[True, True, False], [True, False, False]])).tolist() == [[3.0, 4.0, 0.0]]
    assert (
        values.shape == (8, len(tasks) + len(MODELS), len(ball.vertices))
        and set(bits) == set(tasks)
        and all(b > 1 for b in bits.values())
    )
    for saliency in whole:
        assert np.linalg.norm(ball.vertices[saliency.argmax()] - place) < 0.1
    assert (whole[6] > 0).mean() < (whole[5] > 0).mean()  # four levels leave less
