"""Units that share objects: how much drawn sets of classes and random scenes have in common."""

from itertools import combinations

import numpy as np
import pytest

from stages.engine.settings import check_section, conf_folder, load_params
from stages.report.recorded.claims import RECORDED_CLASSES, shared_classes
from stages.report.scene.scene import COMMON
from stages.scene import Params, online


def test_drawn_sets_of_classes_are_as_much_alike_as_their_number_says():
    drawn = [set(np.random.default_rng(k).permutation(RECORDED_CLASSES)[:6].tolist()) for k in range(200)]
    common = np.mean([len(first & second) / 6 for first, second in combinations(drawn, 2)])
    assert shared_classes("six_drawn") == pytest.approx(common / (1 - common), rel=0.02)


def test_random_scenes_share_objects_as_is_said():
    params = load_params(conf_folder() / "data/household_scenes.yaml")
    names = params["meshes"]["objects"]
    shared, random = (load_params(conf_folder() / path)["scene"] for path in ("config.yaml", "scene/random.yaml"))
    scene = check_section(Params, shared | random)
    boxes, sizes = {name: (-np.ones(3), np.ones(3)) for name in names}, dict.fromkeys(names, 0.2)
    scenes = [{item.name for item in online.draw_scene(scene, k, boxes, sizes, 0).objects} for k in range(30)]
    shares = [len(first & second) / np.sqrt(len(first) * len(second)) for first, second in combinations(scenes, 2)]
    assert np.mean(shares) == pytest.approx(COMMON, abs=5e-4)
