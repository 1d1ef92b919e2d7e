"""Recorded touches as images for networks: the readers on small files in the published layouts, and electrodes."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from stages.classification.touch_readers import Grasps, read_grasps
from stages.transfer.recorded_images import (
    COLUMNS,
    GRID,
    ROWS,
    Recorded,
    colour_image,
    electrode_grid,
    electrode_images,
    grasp_images,
    pressure_images,
    read_bigs,
    read_picture,
    read_vitac,
    read_vt60,
    strongest_instant,
)

DATA = Path(__file__).parents[2] / "../shared/data"


def picture(path, grey=100):
    path.parent.mkdir(parents=True, exist_ok=True)
    Image.new("RGB", (6, 4), (grey, 0, 255 - grey)).save(path)


@pytest.fixture
def vt60(tmp_path):
    for number in range(1, 11):
        for instance in range(1, 7):
            folder = f"{number:02d}_class{number}/0{instance}"
            for touch in (2, 10):
                file = f"touch_{instance}_img_{touch}_name_class{number}_red_at_37383_-9361_23890.jpg"
                picture(tmp_path / "touch" / folder / file, grey=10 * touch)
            picture(tmp_path / "vision" / folder / f"IMG_inst_{instance}_img_27_validframeID_204.jpg")
    return tmp_path


def test_vt60_has_sixty_objects_of_ten_classes_and_touches_by_number(vt60):
    touches = read_vt60(vt60, size=8)
    assert touches.images.shape == (120, 8, 8, 3) and touches.images.dtype == np.uint8
    assert touches.classes == [f"class{number}" for number in range(1, 11)]
    assert np.bincount(touches.labels).tolist() == [12] * 10
    assert len(set(touches.groups)) == 60 and touches.groups[0] == "class1/01"
    assert touches.images[:2, 0, 0, 0] == pytest.approx([20, 100], abs=5)  # img_2 before img_10


def test_sixteen_bits_of_grey_keep_their_range(tmp_path):
    grey = np.linspace(0, 65535, 64).astype(np.uint16).reshape(8, 8)
    Image.fromarray(grey).save(tmp_path / "deep.png")
    assert np.array_equal(read_picture(tmp_path / "deep.png", 8), np.repeat(grey[..., None] // 256, 3, axis=2))


def test_vitac_reads_the_twelve_cloths_by_number(tmp_path):
    for number in (11, 22, 100):
        for recording in (121, 122):
            for part in (1, 2):
                picture(tmp_path / f"{number}t" / f"{recording}_{part}.jpg")
        picture(tmp_path / f"{number}v" / "IMG_2460_123.jpg")
    picture(tmp_path / "11t_test" / "131_1.jpg")
    touched = read_vitac(tmp_path, size=8)
    assert touched.classes == ["11", "22", "100"] and np.bincount(touched.labels).tolist() == [5, 4, 4]
    assert sorted(set(touched.groups[touched.labels == 0])) == ["11/121", "11/122", "11/131"]


def test_vitac_reads_the_hundred_cloths_and_only_what_was_pressed(tmp_path):
    for number in (11, 22, 100):
        for movement in ("press", "slide"):
            picture(tmp_path / f"CD{number:04d}" / f"{movement}_01" / "frame_1.png")
        picture(tmp_path / f"vis{number:04d}" / "photo_1.jpg")
    touched = read_vitac(tmp_path, size=8)
    assert touched.classes == ["11", "22", "100"] and touched.groups.tolist()[0] == "11/press_01/frame"
    assert len(touched.images) == 3


@pytest.fixture
def bigs(tmp_path):
    """Three objects of two grasps that held and one that failed; two electrodes are pressed in turn."""
    series = np.full((705, 19), 2000)
    series[400:402, 6] = 2100, 2300  # electrode 7 is the middle cell at the tip
    series[650, 0] = 2200
    table = "\n".join(",".join(map(str, line)) for line in series)
    for grasp in ("success/grasp_0", "success/grasp_1", "failure/grasp_0"):
        for name in ("ball", "box", "cylinder"):
            for finger in ("left", "middle", "right"):
                path = tmp_path / name / grasp / f"{finger}.csv"
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(table)
    return tmp_path


def test_bigs_has_an_image_a_finger_of_each_successful_grasp_of_all_readings_or_the_strongest(bigs):
    whole, instant = read_bigs(bigs), read_bigs(bigs, instant=True)
    assert whole.images.shape == (18, 70, 70, 3) and instant.images.shape == (18, 7, 3)
    assert whole.classes == ["ball", "box", "cylinder"]
    assert whole.labels.tolist() == instant.labels.tolist() == [0] * 6 + [1] * 6 + [2] * 6
    assert sorted(set(whole.groups)) == [f"{name}/grasp_{k}" for name in whole.classes for k in (0, 1)]
    assert whole.groups.tolist() == instant.groups.tolist()
    assert (whole.images[:, :7, 0, 0] == 128).all()  # the first sample is what the others are compared with
    assert np.argwhere(instant.images[0] != 128).tolist() == [[0, 1]] and instant.images[0, 0, 1] > 128


def test_the_strongest_instant_may_be_a_release():
    series = np.full((2, 2, 5), 128, np.uint8)
    series[..., 1], series[..., 3] = 140, 100
    assert (strongest_instant(series) == 100).all()


def test_reshape_is_matlabs():
    cells = np.arange(7 * 3 * 700).reshape(7, 3, 700)
    image = colour_image(cells)
    for row, column, sample in ((0, 0, 0), (6, 2, 699), (3, 1, 233), (5, 2, 400)):
        place = row + 7 * column + 21 * sample
        assert image[place % 70, place // 70 % 70, place // 4900] == cells[row, column, sample]
    assert sorted(image.ravel()) == list(range(14700))


def test_each_electrode_has_one_cell_and_the_gaps_their_neighbours_mean():
    assert sorted(np.ravel(GRID)) == [0, 0, *range(1, 20)]
    image = electrode_grid(np.arange(1, 20)[None].astype(float))[0]
    assert image[0].tolist() == [9, 7, 8] and image[6].tolist() == [16, 19, 6]
    assert image[3].tolist() == [13, 8, 3] and image[4].tolist() == [14, 9, 4]


@pytest.mark.parametrize(
    ("images", "labels", "classes", "reason"),
    [
        (np.zeros((2, 4, 4)), [0, 1], ["a", "b"], "must be u1"),
        (np.zeros((2, 4, 4, 2), np.uint8), [0, 1], ["a", "b"], "must be u1"),
        (np.zeros((2, 4, 4), np.uint8), [0], ["a", "b"], "as many labels"),
        (np.zeros((2, 4, 4), np.uint8), [0, 0], ["a", "b"], "without any: b"),
        (np.zeros((2, 4, 4), np.uint8), [0, 0], ["a"], "two classes"),
        (np.zeros((2, 4, 4), np.uint8), [0, 2], ["a", "b"], "two classes"),
    ],
)
def test_parts_that_do_not_fit_are_refused(images, labels, classes, reason):
    with pytest.raises(ValueError, match=reason):
        Recorded(images, np.array(labels), classes, None)


@pytest.fixture
def grasps():
    random, number = np.random.default_rng(1), np.arange(40)
    electrodes = random.normal(2800, 100, (40, 72)) + random.normal(0, 300, 72)
    electrodes[:, 0] = 7  # is dead
    objects = np.array([f"object{k % 4}" for k in number])
    return Grasps(electrodes, objects, np.array(["45", "down", "side"])[number % 3], number % 2 == 0, number % 4 == 3)


def test_an_electrode_shows_where_it_lies_in_the_colour_of_its_finger():
    places = set(zip(ROWS, COLUMNS, strict=True))
    assert len(places) == 24 and {(row, 10 - column) for row, column in places} == places  # apart and mirrored
    for finger in range(3):
        for electrode in (0, 9, 15, 23):
            values = np.zeros((1, 72))
            values[0, 24 * finger + electrode] = 1
            image = electrode_images(values)[0]
            assert image[ROWS[electrode], COLUMNS[electrode], finger] == 255
            assert (np.delete(image, finger, axis=2) == 128).all() and image.min() >= 128
    fingers = np.array([0.5, -0.5, 0.25])  # equal readings of a finger fill it evenly
    assert (electrode_images(np.repeat(fingers, 24)[None]) == np.round(128 + 127 * fingers)).all()
    assert (electrode_images(np.repeat([1.5, -1.5, 0.0], 24)[None]) == [255, 1, 128]).all()  # readings beyond the range


def test_grey_values_come_from_the_objects_that_are_not_kept_for_testing(grasps):
    plain = grasp_images(grasps)
    moved = Grasps(**vars(grasps) | {"electrodes": grasps.electrodes + 1000 * grasps.test[:, None]})
    others = plain.groups != "object3"
    assert np.array_equal(plain.images[others], grasp_images(moved).images[others])
    assert abs(plain.images[others].mean() - 128) < 2
    assert (plain.images[:, ROWS[0], COLUMNS[0], 0] == 128).all()  # the dead electrode


def test_both_targets_have_the_same_images_in_the_same_order(grasps):
    objects, slips = grasp_images(grasps), grasp_images(grasps, "slipped")
    assert np.array_equal(objects.images, slips.images) and np.array_equal(objects.groups, slips.groups)
    assert [objects.classes[label] for label in objects.labels] == objects.groups.tolist()
    assert slips.classes == ["slipped", "stable"] and np.bincount(slips.labels).tolist() == [20, 20]
    slipped = {name: grasps.slipped[grasps.objects == name].sum() for name in objects.classes}
    assert {name: (slips.labels[slips.groups == name] == 0).sum() for name in slipped} == slipped
    with pytest.raises(ValueError, match="unknown target 'weight', known: objects, slipped"):
        grasp_images(grasps, "weight")


def test_pressure_keeps_its_order_and_its_grey_values():
    touches = {"ball": np.linspace(0, 1, 3 * 8).reshape(3, 2, 4), "can": np.zeros((2, 2, 4))}
    recorded = pressure_images(touches)
    assert recorded.images.shape == (5, 2, 4) and recorded.labels.tolist() == [0, 0, 0, 1, 1]
    assert recorded.images[0, 0, 0] == 0 and recorded.images[2, 1, 3] == 255 and recorded.groups is None


@pytest.mark.skipif(not (DATA / "biotac_grasps.zip").exists(), reason="../shared/data/biotac_grasps.zip is not there")
def test_the_published_grasps_fill_the_grey_values():
    recorded = grasp_images(read_grasps(DATA / "biotac_grasps.zip"))
    assert recorded.images.shape == (5831, 12, 11, 3) and len(recorded.classes) == 51
    assert np.isin(recorded.images, (1, 255)).mean() < 0.01  # clipped
    assert recorded.images.std() > 15
