"""What the thesis remarks on in passing, each put so that it can turn out wrong."""

import dataclasses

import numpy as np
import pytest
import trimesh
from scipy.stats import rankdata, spearmanr

from haptic_glance.look.camera import Viewpoint
from haptic_glance.look.channels import conspicuity
from haptic_glance.look.channels.channels import mask_at_size
from haptic_glance.look.channels.texture import local_entropy
from haptic_glance.look.views import render
from haptic_glance.look.weights.svm import fit_svm, information_gains
from haptic_glance.mesh.mesh import Mesh
from stages.conspicuity.measure import silhouette_share
from tests.shapes import raised_ball

SIZE, MAP = (450, 600), (112, 150)
VIEWPOINTS = (Viewpoint(-32, 17), Viewpoint(60, 20))
BALL = trimesh.creation.icosphere(subdivisions=5)
FROM_THE_PICTURE = ["contrast", "edge", "entropy", "intensity", "orientation"]


def stretched(*radii):
    """An ellipsoid with these radii along x, y and z."""
    return Mesh(BALL.vertices * radii, BALL.faces)


def bumpy():
    """A smooth ball with three unlike bumps."""
    tops = trimesh.util.unitize(np.array([[1.0, 0.2, 0.1], [-0.3, 1, 0.4], [0.1, -0.6, -1]]))
    mesh = raised_ball(tops, [0.25, 0.3, 0.35], [0.3, 0.25, 0.35], subdivisions=5)
    return Mesh(0.45 * mesh.vertices / np.linalg.norm(mesh.vertices, axis=1).max(), mesh.faces)


SMOOTH = {"ball": stretched(0.45, 0.45, 0.45), "ellipsoid": stretched(0.45, 0.3, 0.2), "bumpy": bumpy()}


def textured(view, depth=0.4):
    """The view with a fine grain printed on the object: blocks of 3 x 3 pixels, each darker by up to `depth`."""
    blocks = np.random.default_rng(0).random((SIZE[0] // 3, SIZE[1] // 3))
    grain = 1 - depth * np.kron(blocks, np.ones((3, 3)))
    return dataclasses.replace(view, rgb=np.rint(view.rgb * grain[..., None]).astype(np.uint8))


def agreement(mesh, view):
    """Rank correlation of the entropy map with the contrast map, over the object."""
    maps, inside = conspicuity(mesh, view, ["entropy", "contrast"], MAP), mask_at_size(view.mask, MAP)
    return spearmanr(maps["entropy"][inside], maps["contrast"][inside])[0]


@pytest.mark.slow
def test_entropy_adds_nothing_without_texture():
    """T3.1.5. On a smooth grey shape it repeats what contrast says already; on the same shape with a grain it does not.

    Without texture both measure the slope of the shading.
    """
    mesh = SMOOTH["bumpy"]
    view = render(mesh, VIEWPOINTS[0], SIZE, "raster")
    assert agreement(mesh, view) > 0.85
    assert agreement(mesh, textured(view)) < 0.6


@pytest.mark.slow
def test_entropy_measures_texture():
    """T3.1.5. The grain adds more than a bit where the shading is even, facing the light."""
    view = render(SMOOTH["ellipsoid"], VIEWPOINTS[0], SIZE, "raster")
    rows, columns = (ids[::7] for ids in np.nonzero(view.mask & (view.rgb[..., 0] > 170)))
    bits = [local_entropy(v.rgb[..., 0], view.mask, rows, columns).mean() for v in (view, textured(view))]
    assert bits[1] > bits[0] + 1


@pytest.mark.slow
def test_symmetry_says_something_on_a_long_shape_alone():
    """T3.2.3: where the extremes deviate little from the centre, the feature's information gain is zero."""
    gains, maps = symmetry_at_the_ends(stretched(0.45, 0.44, 0.43))
    assert not any(values.any() for values in maps)
    assert gains == pytest.approx([0] * len(gains), abs=1e-12)
    gains, maps = symmetry_at_the_ends(stretched(0.45, 0.25, 0.12))
    assert any(values.any() for values in maps)
    assert np.mean(gains) > 0.02


def symmetry_at_the_ends(mesh):
    """Of each view the information gain of the symmetry map about the tips along x, and the map."""
    gains, maps = [], []
    for viewpoint in VIEWPOINTS:
        view = render(mesh, viewpoint, SIZE, "raster")
        inside = mask_at_size(view.mask, MAP)
        tip = np.abs(mesh.vertices[mesh.faces[np.maximum(view.face, 0), 0], 0]) > 0.36
        symmetry = conspicuity(mesh, view, ["symmetry"], MAP)["symmetry"]
        gains.append(information_gains(symmetry[inside][:, None], mask_at_size(view.mask & tip, MAP)[inside])[0])
        maps.append(symmetry)
    return gains, maps


@pytest.mark.slow
def test_a_black_background_left_in_draws_the_maps_to_the_contour_least():
    """T3.1.5 chose black before grey and white by the error of the simplified meshes; here by the maps themselves."""
    shares = {background: contour_share(SMOOTH["bumpy"], background) for background in ("black", "grey", "white")}
    assert shares["black"] < shares["grey"] < shares["white"]
    assert shares["white"] > 1.3 * shares["black"]


def contour_share(mesh, background):
    shares = []
    for viewpoint in VIEWPOINTS:
        view = render(mesh, viewpoint, SIZE, "raster", background)
        maps = conspicuity(mesh, view, FROM_THE_PICTURE, MAP, filled=False)
        shares += [silhouette_share(values, view.mask) for values in maps.values()]
    return np.nanmean(shares)


def lessons(rules, count=600):
    """For each rule an object's rows (features (count, 3), labels), the labels a little noisy."""
    samples = []
    for seed, rule in enumerate(rules):
        generator = np.random.default_rng(seed)
        features = generator.random((count, 3))
        samples.append((features, rule(features) ^ (generator.random(count) < 0.05)))
    return samples


def auc(scores, labels):
    ranks = rankdata(scores)[labels]
    return (ranks.sum() - len(ranks) * (len(ranks) + 1) / 2) / (len(ranks) * (~labels).sum())


def advantage(rules):
    """How much more AUC the SVM of each object has than one for all, on rows of the object that neither saw."""
    seen, fresh = lessons(rules), lessons(rules, 1200)
    fresh = [(features[600:], labels[600:]) for features, labels in fresh]
    common = fit_svm(*(np.concatenate(part) for part in zip(*seen, strict=True)), seed=0)
    svms = [fit_svm(*lesson, seed=0) for lesson in seen]
    return np.mean(
        [auc(svm.predict(x), y) - auc(common.predict(x), y) for svm, (x, y) in zip(svms, fresh, strict=True)]
    )


def high(k):
    """Salient where channel k is high."""
    return lambda features: features[:, k] > 0.5


def low(k):
    """Salient where channel k is low."""
    return lambda features: features[:, k] < 0.5


def test_an_svm_an_object_is_better_on_its_object_only_where_the_channels_mean_other_things():
    """T3.2.3: the weight of a channel (symmetry there) changes a lot from object to object."""
    assert advantage([high(0), low(0), high(1), low(1)]) > 0.2
    assert abs(advantage([high(0), high(0), high(0), high(0)])) < 0.03
