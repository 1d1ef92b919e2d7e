"""Scenes drawn at random: reproducible, on the ground, apart from each other, and seen."""

import numpy as np
import pytest

from haptic_glance.lod.scene.camera import Scene
from stages.scene import Params
from stages.scene.measure import scene_of
from stages.scene.online import LOWEST, draw_scene

NAMES = [f"thing {number}" for number in range(20)]
BOXES = {name: (np.array([-0.5, -0.1 - 0.02 * k, -0.2]), np.array([0.5, 0.1, 0.3])) for k, name in enumerate(NAMES)}
SIZES = {name: 0.1 + 0.01 * k for k, name in enumerate(NAMES)}
SETTINGS = Params("random", [], [], 12, [90, 160], 40.0, 1.0, "pixels", 0, 3, "glance-soft", [], 30, True)


def draw(number=0, seed=0, boxes=BOXES):
    return draw_scene(SETTINGS, number, boxes, SIZES, seed)


def circles(settings):
    """(middles (o, 2), radii (o,)) of the circles round the feet of the turned boxes."""
    spans = np.array([np.ptp(np.array(BOXES[item.name]), axis=0) for item in settings.objects])
    sizes = np.array([item.size for item in settings.objects])
    radii = np.hypot(spans[:, 0], spans[:, 1]) / 2 * sizes / spans.max(axis=1)
    return np.array([item.position[:2] for item in settings.objects]), radii


def test_an_equal_seed_draws_an_equal_scene_and_another_seed_or_number_another():
    assert draw() == draw() == draw(boxes=dict(reversed(BOXES.items())))
    others = [draw(number=1), draw(seed=1)]
    assert all(other.objects != draw().objects and other.camera != draw().camera for other in others)
    assert [scene.name for scene in (draw(), draw(number=7))] == ["random_00", "random_07"]


@pytest.mark.parametrize("number", range(8))
def test_objects_stand_on_the_ground_apart_and_are_seen(number):
    settings = draw(number)
    names = [item.name for item in settings.objects]
    assert 6 <= len(names) == len(set(names)) <= 12
    assert all(0.8 <= item.size / SIZES[item.name] <= 1.25 and item.position[2] == 0 for item in settings.objects)
    middles, radii = circles(settings)
    apart = np.linalg.norm(middles[:, None] - middles, axis=2) - radii[:, None] - radii
    assert apart[~np.eye(len(radii), dtype=bool)].min() > 0
    scene, missing = scene_of(settings, NAMES)
    assert isinstance(scene, Scene) and not missing
    for camera in scene.cameras:
        rows, columns, depth = camera.project(np.column_stack([middles, np.zeros(len(middles))]))
        h, w = camera.size
        assert ((depth > 0) & (rows > 0) & (rows < h) & (columns > 0) & (columns < w)).any()
        assert camera.eye[2] >= LOWEST - 1e-9


def test_fewer_objects_than_a_scene_has_stand_there_all():
    few = {name: BOXES[name] for name in NAMES[:3]}
    assert sorted(item.name for item in draw(boxes=few).objects) == NAMES[:3]


def test_objects_that_do_not_fit_the_ground_make_it_grow():
    wide = dict.fromkeys(SIZES, 3.0)
    settings = draw_scene(SETTINGS, 0, BOXES, wide, 0)
    middles, radii = circles(settings)
    apart = np.linalg.norm(middles[:, None] - middles, axis=2) - radii[:, None] - radii
    assert apart[~np.eye(len(radii), dtype=bool)].min() > 0
