"""Pressure images and grasps as images for networks."""

from pathlib import Path

import numpy as np
import pytest

from stages.classification.recorded import Grasps, read_grasps, read_pressure_images
from stages.transfer.recorded import COLUMNS, ROWS, electrode_images, grasp_images, pressure_images

DATA = Path(__file__).parents[2] / "../shared/data"


def some_grasps(count=40):
    random = np.random.default_rng(1)
    electrodes = random.normal(2800, 100, (count, 72)) + random.normal(0, 300, 72)
    objects = np.array([f"object{k % 4}" for k in range(count)])
    palms = np.array([("45", "down", "side")[k % 3] for k in range(count)])
    return Grasps(electrodes, objects, palms, np.arange(count) % 2 == 0, objects == "object3")


def test_an_electrode_shows_where_it_lies_in_the_colour_of_its_finger():
    for finger in range(3):
        for electrode in (0, 9, 15, 23):
            values = np.zeros((1, 72))
            values[0, 24 * finger + electrode] = 1
            image = electrode_images(values)[0]
            assert image[ROWS[electrode], COLUMNS[electrode], finger] == 255
            assert (np.delete(image, finger, axis=2) == 128).all()
            assert image[..., finger].min() >= 128


def test_the_electrodes_lie_apart_and_mirrored():
    places = set(zip(ROWS, COLUMNS, strict=True))
    assert len(places) == 24 and {(row, 10 - column) for row, column in places} == places


def test_equal_readings_of_a_finger_fill_it_evenly():
    values = np.repeat([0.5, -0.5, 0.25], 24)[None]
    image = electrode_images(values)[0]
    assert (image == np.round(128 + 127 * np.array([0.5, -0.5, 0.25]))).all()


def test_grey_values_come_from_the_objects_that_are_not_kept_for_testing():
    grasps = some_grasps()
    plain = grasp_images(grasps).images
    moved = Grasps(**vars(grasps) | {"electrodes": grasps.electrodes + 1000 * grasps.test[:, None]})
    others = grasp_images(grasps).groups != "object3"
    assert np.array_equal(plain[others], grasp_images(moved).images[others])
    assert abs(plain[others].mean() - 128) < 2


def test_both_targets_have_the_same_images_in_the_same_order():
    grasps = some_grasps()
    objects, slips = grasp_images(grasps), grasp_images(grasps, "slipped")
    assert np.array_equal(objects.images, slips.images) and np.array_equal(objects.groups, slips.groups)
    assert [objects.classes[label] for label in objects.labels] == objects.groups.tolist()
    assert slips.classes == ["slipped", "stable"] and np.bincount(slips.labels).tolist() == [20, 20]
    slipped = {name: grasps.slipped[grasps.objects == name].sum() for name in objects.classes}
    assert {name: (slips.labels[slips.groups == name] == 0).sum() for name in slipped} == slipped


def test_an_unknown_target_is_named():
    with pytest.raises(ValueError, match="unknown target 'weight', known: objects, slipped"):
        grasp_images(some_grasps(), "weight")


def test_a_dead_electrode_is_grey():
    grasps = some_grasps()
    grasps.electrodes[:, 0] = 7
    assert (grasp_images(grasps).images[:, ROWS[0], COLUMNS[0], 0] == 128).all()


def test_pressure_keeps_its_order_and_its_grey_values():
    touches = {"ball": np.linspace(0, 1, 3 * 8).reshape(3, 2, 4), "can": np.zeros((2, 2, 4))}
    found = pressure_images(touches)
    assert found.images.shape == (5, 2, 4) and found.labels.tolist() == [0, 0, 0, 1, 1]
    assert found.images[0, 0, 0] == 0 and found.images[2, 1, 3] == 255 and found.groups is None


@pytest.mark.skipif(not (DATA / "biotac_grasps.zip").exists(), reason="../shared/data/biotac_grasps.zip is not there")
def test_the_real_grasps_fill_the_grey_values():
    found = grasp_images(read_grasps(DATA / "biotac_grasps.zip"))
    assert found.images.shape == (5831, 12, 11, 3) and len(found.classes) == 51
    assert np.isin(found.images, (1, 255)).mean() < 0.01  # clipped
    assert found.images.std() > 15


@pytest.mark.skipif(not (DATA / "pressure_images.zip").exists(), reason="../shared/data/pressure_images.zip is absent")
def test_the_real_pressure_images_have_22_classes():
    found = pressure_images(read_pressure_images(DATA / "pressure_images.zip"))
    assert found.images.shape == (1100, 28, 50) and np.bincount(found.labels).tolist() == [50] * 22
