"""The pictures show the object from all round, alike on every machine, and grey; touches find a look of their own."""

import numpy as np
import pytest
import trimesh

from haptic_glance.deep.hybrid import present
from haptic_glance.deep.rendered_views import ELEVATIONS, imprint_images, picture_images, take_pictures, viewpoints
from haptic_glance.disturb.picture import PICTURES, damage, damage_pictures
from haptic_glance.mesh.mesh import Mesh
from stages.transfer.hybrid_data import pair_pictures

pytestmark = pytest.mark.slow

SEVERITIES = [(0.05, 0.3), (0.02, 0.1), (0.3, 0.9), (0.05, 0.5)]


def random(seed=0):
    return np.random.default_rng(seed)


@pytest.fixture(scope="module")
def pole():
    """A thin upright pole, red on one side."""
    box = trimesh.creation.box(extents=(0.1, 0.1, 0.9))
    colors = np.where(box.vertices[:, :1] > 0, [[200, 0, 0]], [[0, 0, 200]])
    return Mesh(box.vertices, box.faces, colors=colors.astype(np.uint8))


@pytest.fixture(scope="module")
def pictures(pole):
    return take_pictures(pole, viewpoints(4, random()), 40)


def test_viewpoints_go_all_round_and_not_below_the_table():
    views = viewpoints(36, random())
    azimuths = np.sort([view.azimuth for view in views])
    assert np.allclose(np.diff(azimuths), 10)
    assert all(ELEVATIONS[0] <= view.elevation <= ELEVATIONS[1] for view in views)
    assert np.ptp([view.elevation for view in views]) > 30
    with pytest.raises(ValueError, match="must be 1 or more"):
        viewpoints(0, random())


def test_pictures_show_the_object_upright_on_white_and_grey_unless_colour_is_asked_for(pole, pictures):
    assert pictures.shape == (4, 40, 40, 3) and pictures.dtype == np.uint8
    assert (pictures[:, 0, 0] == 255).all()
    dark = pictures[..., 0] < 250
    assert (dark.any(axis=2).sum(axis=1) > 2 * dark.any(axis=1).sum(axis=1)).all()  # higher than wide
    coloured = take_pictures(pole, viewpoints(4, random()), 40, colour=True)
    assert (pictures == pictures[..., :1]).all() and not (coloured == coloured[..., :1]).all()


def test_same_seed_same_pictures(pole, pictures):
    again, other = (take_pictures(pole, viewpoints(4, random(seed)), 40) for seed in (0, 2))
    assert np.array_equal(pictures, again) and not np.array_equal(pictures, other)


def test_picture_images_are_in_0_to_1_with_channels_first():
    noise = random().integers(0, 256, (2, 8, 8, 3)).astype(np.uint8)
    assert np.allclose(picture_images(noise, 8)[1, 2].numpy() * 255, noise[1, :, :, 2])
    assert picture_images(noise, 5).shape == (2, 3, 5, 5)
    for bad in (noise[0], noise[..., :2], np.full((1, 4, 4, 3), np.nan), np.full((1, 4, 4, 3), 7.0)):
        with pytest.raises(ValueError, match="pictures must"):
            picture_images(bad, 8)
    with pytest.raises(ValueError, match="several sizes"):
        picture_images([noise[0], noise[0, :4]], 8)


def test_a_flat_contact_is_a_touch_and_feeling_nothing_is_none():
    images = imprint_images(np.stack([np.zeros((8, 8)), np.ones((8, 8)), np.eye(8)]), 8)
    assert present(images).tolist() == [True, False, True]
    assert float(images[0].max()) == pytest.approx(1 / 255)


def test_resizing_makes_no_touch_of_nothing_and_a_light_contact_stays_in_range():
    flat = np.ones((2, 28, 50), dtype=np.float32) * [[[1]], [[0.999]]]
    images = imprint_images(flat, 32)  # resizing alone leaves differences of 1e-7
    assert present(images).tolist() == [False, True] and images.max() <= 1


def test_every_touch_is_paired_with_its_own_object():
    seen, felt = np.repeat([0, 1, 2], 3), np.array([2, 0, 0, 0, 0, 1])
    pairs = pair_pictures(seen, felt, random())
    assert np.array_equal(seen[pairs], felt)
    assert set(pairs[1:5]) == {0, 1, 2}  # all looks are used before one is used twice
    with pytest.raises(ValueError, match="object 7 has touches"):
        pair_pictures(seen, np.array([7]), random())


@pytest.mark.parametrize(("name", "severities"), zip(PICTURES, SEVERITIES, strict=True))
def test_more_severe_is_further_from_the_picture(pictures, name, severities):
    mild, harsh = (damage_pictures(pictures, name, severity, random()) for severity in severities)
    assert 0 < np.abs(mild - pictures / 255).mean() < np.abs(harsh - pictures / 255).mean()
    assert harsh.dtype == np.float32 and harsh.min() >= 0 and harsh.max() <= 1


def test_a_missing_sense_is_none_and_imprints_are_damaged_as_elsewhere():
    imprints = np.full((2, 16, 16), 128, dtype=np.uint8)
    assert damage(imprints, "imprint_missing", 1.0, random()) is None
    damaged = damage(imprints, "imprint_dead_cells", 0.5, random())
    assert damaged.shape == imprints.shape and damaged.std() > 0
