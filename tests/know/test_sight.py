"""What a small picture says: its features, what is hidden, and pictures that cannot be used."""

from dataclasses import replace

import numpy as np
import pytest

from haptic_glance import Viewpoint, render
from haptic_glance.know import learn, primitives
from haptic_glance.know.sight import SIDE, blocks, prepared, similarity, sketch


@pytest.fixture(scope="module")
def pictures():
    shapes = primitives()
    views = [render(shapes[name], Viewpoint(20, 35), size=(SIDE, SIDE)) for name in ("cone", "torus", "box")]
    return np.stack([view.rgb.mean(axis=2) for view in views]) / 255


def similar(picture, views, seen=None):
    seen = np.ones((SIDE, SIDE)) if seen is None else seen
    return similarity(sketch(picture[None]), sketch(views), seen)


def test_a_picture_is_most_similar_to_itself(pictures):
    scores = similar(pictures[0], pictures)
    assert scores[:, 0] == pytest.approx(1, abs=1e-4) and (scores[:, 1:] < 0.95).all()


def test_light_changes_neither_direction_nor_order(pictures):
    assert similar(0.4 * pictures[0] + 0.1, pictures)[1, 0] == pytest.approx(1, abs=1e-3)


def test_what_is_hidden_has_no_influence(pictures):
    seen = np.ones((SIDE, SIDE))
    seen[:, 48:] = 0
    changed = pictures[0].copy()
    changed[:, 49:] = np.random.default_rng(0).random((SIDE, 47))  # the gradient of a cell sees one pixel beside it
    assert similar(changed, pictures, seen) == pytest.approx(similar(pictures[0], pictures, seen), abs=1e-6)
    assert abs(similar(changed, pictures) - similar(pictures[0], pictures)).max() > 0.05


def test_gradients_are_counted_by_direction():
    ramp = np.tile(np.linspace(0, 1, SIDE), (SIDE, 1))  # brighter to the right
    gradients = sketch(np.stack([ramp, ramp.T])).gradients
    assert ((gradients > 0).sum(axis=2) == 1).all()
    first, second = gradients.argmax(axis=2)[:, 0]
    assert abs(int(first) - int(second)) == 2  # a quarter of eight directions


def test_blocks_are_means():
    picture = np.arange(SIDE * SIDE, dtype=float).reshape(1, SIDE, SIDE)
    assert blocks(picture, 2)[0] == pytest.approx(
        [picture[0, :48, :48].mean(), picture[0, :48, 48:].mean(), picture[0, 48:, :48].mean(),
         picture[0, 48:, 48:].mean()]
    )  # fmt: skip


def test_a_picture_of_any_size_is_its_middle_square(pictures):
    bytes_ = np.rint(255 * pictures[0]).astype(np.uint8)
    same, seen = prepared(bytes_, None)
    assert same == pytest.approx(bytes_ / 255, abs=1e-6) and seen.all()
    double = bytes_.repeat(2, axis=0).repeat(2, axis=1)
    wide = np.pad(double, ((0, 0), (40, 40)))
    assert prepared(wide, None)[0] == pytest.approx(same, abs=1e-6)
    narrow, covered = prepared(double[:, 40:-40], None)
    assert narrow[:, 20:-20] == pytest.approx(same[:, 20:-20], abs=1e-6)
    assert not covered[:, :19].any() and covered[:, 21:75].all()  # beyond the sides nothing is seen
    colours = np.stack([double] * 3, axis=2)
    assert prepared(colours, np.zeros(double.shape, dtype=bool))[0] == pytest.approx(same, abs=1e-6)
    assert np.abs(prepared(bytes_[::4, ::4], None)[0] - same).mean() < 0.05


BLACK, GREY = np.zeros((SIDE, SIDE), dtype=np.uint8), np.eye(SIDE, dtype=np.uint8) * 200


@pytest.mark.parametrize(
    ("picture", "hidden", "words"),
    [
        (BLACK, None, "shows nothing"), (BLACK[0], None, "shape"), (GREY / 255, None, "bytes"),
        (np.full((9, 9), np.nan), None, "NaN"), (np.zeros((4, 4, 2), np.uint8), None, "shape"),
        (GREY, np.ones((SIDE, SIDE), bool), "all of the picture is hidden"), (GREY, np.ones((3, 3), bool), "mask"),
        (GREY, np.full((SIDE, SIDE), 7), "True and False"), (np.zeros((0, 4), np.uint8), None, "shape"),
    ],
)  # fmt: skip
def test_a_picture_that_tells_nothing_is_named(picture, hidden, words):
    with pytest.raises(ValueError, match=words):
        prepared(picture, hidden)


@pytest.mark.filterwarnings("ignore:grey and painted are the same shape")
def test_two_objects_of_one_shape_are_told_apart_by_their_colours():
    box = primitives()["box"]
    colours = np.where(box.vertices[:, :1] > 0, 255, 20).astype(np.uint8).repeat(3, axis=1)
    shapes, camera = {"grey": box, "painted": replace(box, colors=colours)}, Viewpoint(0, 35)
    library = learn(shapes)
    for name, mesh in shapes.items():
        belief = library.look(render(mesh, camera, size=(SIDE, SIDE)).rgb, camera)
        assert belief.probabilities[name] > 0.9
