"""Recordings to test on: bars at places of their own, and grasps whose first electrodes tell whether they slip."""

from types import SimpleNamespace

import numpy as np
import pytest
from PIL import Image

from stages.classification.touch_readers import ELECTRODES, PALMS, Grasps


def touches(classes=7, count=12, noise=0.2, seed=0):
    """{class: (count, 16, 16)}: a bar at a place of its own, with noise."""
    random, images = np.random.default_rng(seed), {}
    for k in range(classes):
        bar = np.zeros((16, 16))
        bar[2 * k : 2 * k + 2] = 1
        images["abcdefghij"[k]] = np.clip(bar + noise * random.random((count, 16, 16)), 0, 1)
    return images


def grasps(shift=0.0):
    """Twelve objects of which the last four are tests; the first electrodes tell whether it slips."""
    random, names = np.random.default_rng(0), np.repeat([f"o{k:02}" for k in range(12)], 30)
    slipped = random.random(len(names)) < 0.5
    electrodes = random.normal(size=(len(names), len(ELECTRODES)))
    electrodes[:, :20] += 3 * slipped[:, None]
    test = names >= "o08"
    electrodes[test] += shift
    return Grasps(electrodes, names, np.tile(PALMS, len(names) // 3), slipped, test)


def write_archive(folder, images):
    """Writes touches as the publisher's archive of pressure images does: Images/CLASS/CLASSk.jpg."""
    for name, pictures in images.items():
        (folder / "Images" / name).mkdir(parents=True)
        for k, picture in enumerate(pictures):
            Image.fromarray(np.round(255 * picture).astype(np.uint8)).save(folder / f"Images/{name}/{name}{k}.jpg")


@pytest.fixture
def recordings():
    """The functions touches, grasps and write_archive."""
    return SimpleNamespace(touches=touches, grasps=grasps, write_archive=write_archive)
