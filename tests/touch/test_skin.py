"""Imprints in 0..1, and the model of the skin that feels them: each step does what it says and no more."""

import numpy as np
import pytest

from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import Skin, distances, indent, normalise, press, press_many
from haptic_glance.touch.skin import dead_cells


@pytest.mark.parametrize("precision", [np.float64, np.float32])
def test_plane_gives_flat_imprint(shapes, precision):
    mesh, vertex = shapes.solid(lambda x, y: 0.1 * x + 0.2 * y)
    assert (press(Mesh(mesh.vertices.astype(precision), mesh.faces), vertex) == 0).all()


def test_sphere_is_zero_at_contact_and_one_farthest_away(shapes):
    mesh, vertex = shapes.solid(shapes.sphere)
    image = press(mesh, vertex, cells=(15, 15), pitch=0.01)
    x, y = shapes.cell_places((15, 15), 0.01)
    depth = 0.3 - shapes.sphere(x, y)
    assert image.dtype == np.float32 and image[7, 7] == 0 and image[0, 0] == 1
    assert np.allclose(image, depth / depth.max(), atol=1e-6)


def test_pit_is_zero_where_a_rigid_array_would_touch_first(shapes):
    mesh, vertex = shapes.solid(lambda x, y: 4 * (x * x + y * y))
    image = press(mesh, vertex, cells=(15, 15))
    assert image[7, 7] == 1 and image[0, 0] < 1e-12


def test_many_equal_one_by_one_across_batches(shapes):
    mesh, _ = shapes.solid(shapes.sphere)
    vertices = np.random.default_rng(0).choice(len(mesh.vertices), 70)
    many = press_many(mesh, vertices, (32, 32), 0.004)
    assert many.shape == (70, 32, 32)
    for vertex, image in zip(vertices[[0, 33, 69]], many[[0, 33, 69]], strict=True):
        assert np.array_equal(press(mesh, vertex, (32, 32), 0.004), image)


IMAGES = np.random.default_rng(0).random((6, 12, 10)).astype(np.float32)
FULL = Skin(blur=0.7, gain=1.2, saturation=0.9, hysteresis=0.05, noise=0.1, dead=0.1, seed=3)


def load(skin, images=IMAGES, **where):
    """What the sensels read: the imprints upside down."""
    return 1 - skin(images, **where).astype(np.float64)


def test_defaults_change_nothing_and_separate_touches_have_no_history():
    assert np.array_equal(Skin()(IMAGES), IMAGES) and Skin()(IMAGES).dtype == np.float32
    assert np.array_equal(Skin(seed=5)(IMAGES[None])[0], IMAGES)
    skin = Skin(hysteresis=0.2)
    assert np.array_equal(skin(IMAGES[::-1]), skin(IMAGES)[::-1])
    assert not np.allclose(skin(IMAGES[None])[0, 1:], skin(IMAGES)[1:])


@pytest.mark.parametrize("blur", [0.3, 40.0])
def test_blur_keeps_the_sum_and_flattens(blur):
    felt = load(Skin(blur=blur))
    assert np.allclose(felt.sum(axis=(1, 2)), (1 - IMAGES).sum(axis=(1, 2)), rtol=1e-6)
    assert (felt.std(axis=(1, 2)) < (1 - IMAGES).std(axis=(1, 2))).all()


def test_blur_spreads_a_point_by_its_width_alike_both_ways():
    point = np.ones((1, 41, 41))
    point[0, 20, 20] = 0
    felt = load(Skin(blur=2.0), point)[0]
    around = np.arange(41) - 20.0
    assert (felt.sum(axis=0) * around**2).sum() == pytest.approx(4, rel=0.01)
    assert np.allclose(felt, felt.T) and np.allclose(felt, felt[::-1])


def test_blur_stays_within_the_imprint_and_its_frame():
    images = np.ones((2, 3, 5, 5))
    images[0, 1] = 0
    felt = load(Skin(blur=1.0), images)
    assert np.allclose(felt[0, 1], 1) and np.allclose(np.delete(felt[0], 1, axis=0), 0) and np.allclose(felt[1], 0)


def test_gain_is_a_factor_and_saturation_a_ceiling():
    assert np.allclose(load(Skin(gain=0.5)), 0.5 * (1 - IMAGES), atol=1e-7)
    assert np.allclose(load(Skin(gain=3, saturation=0.7)), np.minimum(3 * (1 - IMAGES.astype(float)), 0.7), atol=1e-7)


def test_hysteresis_of_a_falling_load_lags_the_other_way_and_holds_in_between():
    path = np.array([0, 1, 0.9, 0.8, 0.5, 0.6, 0.0])
    felt = load(Skin(hysteresis=0.1), 1 - path.reshape(1, -1, 1, 1)).ravel()
    assert np.allclose(felt, [0, 0.9, 0.9, 0.9, 0.6, 0.6, 0.1], atol=1e-6)


def test_hysteresis_is_each_sensels_own_and_each_sequences():
    path = np.array([[0.5, 1.0, 0.2], [0.5, 0.1, 0.2]])
    frames = 1 - path.T.reshape(1, 3, 1, 2)
    felt = load(Skin(hysteresis=0.1), np.concatenate([frames, frames[..., ::-1]]))
    assert np.allclose(felt[0, 2, 0], [0.3, 0.2], atol=1e-6) and np.allclose(felt[1], felt[0][..., ::-1])


def test_noise_has_its_size_and_no_bias():
    felt = load(Skin(noise=0.05), np.full((200, 16, 16), 0.5))
    assert felt.mean() == pytest.approx(0.5, abs=1e-3) and felt.std() == pytest.approx(0.05, rel=0.02)


def test_noise_differs_between_imprints_names_and_seeds():
    same = np.full((2, 8, 8), 0.5)
    skin = Skin(noise=0.05)
    assert not np.allclose(skin(same)[0], skin(same)[1])
    assert not np.allclose(skin(same, "cup"), skin(same, "duck"))
    assert not np.allclose(skin(same), Skin(noise=0.05, seed=1)(same))
    assert np.array_equal(skin(same, "cup"), skin(same, "cup"))


def test_dead_cells_are_the_same_in_every_imprint_and_frame():
    skin = Skin(dead=0.25, noise=0.1)
    felt = load(skin, np.zeros((5, 3, 8, 8)))
    dead = dead_cells((8, 8), 0.25)
    assert not dead.flags.writeable  # all sensors of this kind share it
    assert dead.sum() == 16 and (felt[..., dead] == 0).all() and (felt[..., ~dead] > 0).all()


def test_more_dead_cells_hold_the_fewer_and_other_sensors_have_others():
    few, many = dead_cells((16, 16), 0.1), dead_cells((16, 16), 0.3)
    assert (many | ~few).all() and not np.array_equal(few, dead_cells((16, 16), 0.1, seed=1))
    assert dead_cells((4, 4), 1.0).all() and not dead_cells((4, 4), 0.0).any()


def test_results_do_not_depend_on_the_batch():
    whole = FULL(IMAGES, "cup")
    parts = [FULL(IMAGES[:1], "cup"), FULL(IMAGES[1:4], "cup", first=1), FULL(IMAGES[4:], "cup", first=4)]
    assert np.array_equal(whole, np.concatenate(parts))
    assert whole.min() >= 0 and whole.max() <= 1


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: Skin(blur=-1), "blur must be 0 or more"),
        (lambda: Skin(blur=1e9), "blur must be 0 or more and at most 1000"),
        (lambda: Skin(gain=0), "gain must be above 0"),
        (lambda: Skin(saturation=1.2), "saturation must be above 0 and at most 1"),
        (lambda: Skin(hysteresis=np.nan), "hysteresis"),
        (lambda: Skin(noise=np.inf), "noise"),
        (lambda: Skin(dead=1.5), "dead must be 0 or more and at most 1"),
        (lambda: Skin(dead="many"), "dead"),
        (lambda: Skin(seed=-1), "seed"),
        (lambda: Skin(seed=3.0), "seed must be an integer"),
        (lambda: normalise(np.zeros((4, 4)), 0.01), "shape"),
        (lambda: normalise(np.full((3, 2, 2), np.nan), 0.01), "distances must be finite"),
        (lambda: indent(np.full((3, 2, 2), -np.inf), 0.01), "distances must be finite"),
        (lambda: indent(np.zeros((1, 2, 2)), 0), "depth must be"),
        (lambda: indent(np.zeros((1, 2, 2)), np.nan), "depth must be"),
        (lambda: press(Mesh(np.eye(3), [[0, 1, 2]]), [0, 1]), "vertices must have shape"),
        (lambda: Skin()(np.zeros((4, 4))), "imprints must"),
        (lambda: Skin()(np.full((1, 2, 2), 1.5)), "imprints must"),
        (lambda: Skin()(np.full((1, 2, 2), np.nan)), "imprints must"),
    ],
)
def test_wrong_arguments_are_named_with_what_is_right(call, words):
    with pytest.raises(ValueError, match=words):
        call()


def test_indent_feels_a_sphere_where_it_is_higher_than_the_depth(shapes):
    mesh, vertex = shapes.solid(shapes.sphere)
    x, y = shapes.cell_places((15, 15), 0.01)
    depth = 0.005
    felt = 1 - indent(distances(mesh, [vertex], (15, 15), 0.01), depth)[0]
    assert np.allclose(felt, np.maximum(0, 1 - (0.3 - shapes.sphere(x, y)) / depth), atol=1e-5)
    assert 0 < (felt > 0).sum() < 225
