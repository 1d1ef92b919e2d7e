"""The readers of recorded touches, on small files in the published layouts."""

import re

import numpy as np
import pytest
from PIL import Image
from scipy.io import savemat

from stages.transfer.recorded import (
    GRID,
    Recorded,
    colour_image,
    electrode_grid,
    read_bigs,
    read_schunk,
    read_vitac,
    read_vt60,
    strongest_instant,
)

CLOTHS = (11, 22, 100)


def picture(path, grey=100, size=(6, 4)):
    path.parent.mkdir(parents=True, exist_ok=True)
    Image.new("RGB", size, (grey, 0, 255 - grey)).save(path)


@pytest.fixture
def vt60(tmp_path):
    for number in range(1, 11):
        for instance in range(1, 7):
            name = f"class{number}"
            for touch in (2, 10):
                file = f"touch_{instance}_img_{touch}_name_{name}_red_at_37383_-9361_23890.jpg"
                picture(tmp_path / "touch" / f"{number:02d}_{name}" / f"0{instance}" / file, grey=10 * touch)
            file = f"IMG_inst_{instance}_img_27_validframeID_204.jpg"
            picture(tmp_path / "vision" / f"{number:02d}_{name}" / f"0{instance}" / file)
    return tmp_path


def test_vt60_has_sixty_objects_of_ten_classes(vt60):
    found = read_vt60(vt60, size=8)
    assert found.images.shape == (120, 8, 8, 3) and found.images.dtype == np.uint8
    assert found.classes == [f"class{number}" for number in range(1, 11)]
    assert np.bincount(found.labels).tolist() == [12] * 10
    assert len(set(found.groups)) == 60 and found.groups[0] == "class1/01"
    assert len(read_vt60(vt60, "camera", size=8).images) == 60


def test_touches_of_an_object_come_in_the_order_of_their_numbers(vt60):
    first, second = read_vt60(vt60, size=8).images[:2, 0, 0, 0].astype(int)
    assert abs(first - 20) < 5 and abs(second - 100) < 5  # img_2 before img_10


@pytest.mark.parametrize("gone", ["touch", "touch/04_class4", "touch/04_class4/03"])
def test_vt60_names_the_folder_that_is_missing(vt60, gone):
    (vt60 / gone).rename(vt60 / "elsewhere")
    with pytest.raises(ValueError, match=f"{'04_' if gone.endswith('class4') else gone}.*VT-60: touch/NN_CLASS"):
        read_vt60(vt60)


def test_vt60_names_a_picture_that_is_none_and_an_empty_folder(vt60):
    here = vt60 / "touch/01_class1/01"
    bad = sorted(here.iterdir())[0]
    bad.write_text("no picture")
    with pytest.raises(ValueError, match=re.escape(bad.name)):
        read_vt60(vt60)
    for file in list(here.iterdir()):
        file.unlink()
    with pytest.raises(ValueError, match="01_class1/01 holds no picture"):
        read_vt60(vt60)


def test_vitac_reads_the_twelve_cloths_by_number(tmp_path):
    for number in CLOTHS:
        for recording in (121, 122):
            for part in (1, 2):
                picture(tmp_path / f"{number}t" / f"{recording}_{part}.jpg")
        picture(tmp_path / f"{number}v" / "IMG_2460_123.jpg")
    picture(tmp_path / "11t_test" / "131_1.jpg")
    touched, seen = read_vitac(tmp_path, size=8), read_vitac(tmp_path, "camera", size=8)
    assert touched.classes == seen.classes == ["11", "22", "100"]
    assert np.bincount(touched.labels).tolist() == [5, 4, 4] and len(seen.labels) == 3
    assert sorted(set(touched.groups[touched.labels == 0])) == ["11/121", "11/122", "11/131"]
    assert seen.groups[0] == "11/IMG_2460"


def test_vitac_reads_the_hundred_cloths_and_only_what_was_pressed(tmp_path):
    for number in CLOTHS:
        picture(tmp_path / f"CD{number:04d}" / "press_01" / "frame_1.png")
        picture(tmp_path / f"CD{number:04d}" / "slide_01" / "frame_1.png")
        picture(tmp_path / f"vis{number:04d}" / "photo_1.jpg")
    found = read_vitac(tmp_path, size=8)
    assert found.classes == ["11", "22", "100"] and found.groups.tolist()[0] == "11/press_01/frame"
    assert len(found.images) == 3 == len(read_vitac(tmp_path, "camera", size=8).images)


def test_vitac_says_what_is_wanted(tmp_path):
    with pytest.raises(ValueError, match="nowhere is not a folder: give the unpacked ViTac"):
        read_vitac(tmp_path / "nowhere")
    picture(tmp_path / "11t" / "1_1.jpg")
    with pytest.raises(ValueError, match="holds 1 folders of cloths by touch; expected is ViTac"):
        read_vitac(tmp_path)
    (tmp_path / "22t").mkdir()
    with pytest.raises(ValueError, match="22t holds no picture"):
        read_vitac(tmp_path)
    with pytest.raises(ValueError, match="unknown sense 'smell', known: touch, camera"):
        read_vitac(tmp_path, "smell")


@pytest.fixture
def bigs(tmp_path):
    for seed, name in enumerate(("ball", "box", "cylinder")):
        series = np.random.default_rng(seed).integers(2000, 3000, (705, 19))
        table = "\n".join(",".join(map(str, line)) for line in series)
        for outcome, grasps in (("success", 2), ("failure", 3)):
            for grasp in range(grasps):
                for finger in ("left", "middle", "right"):
                    path = tmp_path / name / outcome / f"grasp_{grasp}" / f"{finger}.csv"
                    path.parent.mkdir(parents=True, exist_ok=True)
                    path.write_text(table)
    return tmp_path


def test_bigs_has_an_image_a_finger_of_each_successful_grasp(bigs):
    found = read_bigs(bigs)
    assert found.images.shape == (18, 70, 70, 3) and found.classes == ["ball", "box", "cylinder"]
    assert np.bincount(found.labels).tolist() == [6, 6, 6]
    assert sorted(set(found.groups)) == [f"{name}/grasp_{k}" for name in found.classes for k in (0, 1)]
    assert (found.images[:, :7, 0, 0] == 128).all()  # the first sample is what the others are compared with


def test_bigs_of_one_instant_is_the_reading_that_differs_most_from_the_first(bigs):
    for finger in ("left", "middle", "right"):
        series = np.full((705, 19), 2000.0)
        series[400:402, 6] = 2100, 2300  # electrode 7 is the middle cell at the tip
        series[650, 0] = 2200
        np.savetxt(bigs / "ball/success/grasp_0" / f"{finger}.csv", series, delimiter=",")
    found = read_bigs(bigs, instant=True)
    assert found.images.shape == (18, 7, 3) and np.bincount(found.labels).tolist() == [6, 6, 6]
    assert found.groups.tolist() == read_bigs(bigs).groups.tolist()
    cells = {tuple(cell) for cell in np.argwhere(found.images[0] != 128)}
    assert cells == {(0, 1)} and found.images[0, 0, 1] > 128


def test_the_strongest_instant_may_be_a_release():
    series = np.full((2, 2, 5), 128, np.uint8)
    series[..., 1], series[..., 3] = 140, 100
    assert (strongest_instant(series) == 100).all()


@pytest.fixture
def schunk(tmp_path):
    """Two objects, two grasps each: the distal array of each finger is pressed in its first row, from sample 10 on."""
    for name in ("ball", "duck"):
        for grasp in range(2):
            arrays = np.empty((1, 6), object)
            for finger in range(3):
                arrays[0, 2 * finger] = np.full((14, 6, 300), 5.0)
                arrays[0, 2 * finger + 1] = np.full((13, 6, 300), 7.0)
                arrays[0, 2 * finger + 1][0, :, 10:] += 10 * (finger + 1)
            (tmp_path / name).mkdir(exist_ok=True)
            savemat(tmp_path / name / f"grasp-{grasp}.mat", {"TS": arrays})
    (tmp_path / "_setup").mkdir()
    return tmp_path


def test_schunk_has_a_picture_a_finger_of_all_readings_or_of_one(schunk):
    whole, instant, coarse = (read_schunk(schunk, cells) for cells in (None, (27, 6), (7, 3)))
    assert whole.images.shape == (12, 126, 126, 3) and instant.images.shape == (12, 27, 6)
    assert coarse.images.shape == (12, 7, 3)
    assert whole.classes == ["ball", "duck"] and whole.groups.tolist() == coarse.groups.tolist()
    assert whole.groups[:4].tolist() == ["ball/grasp-0.mat"] * 3 + ["ball/grasp-1.mat"]
    assert (instant.images[:3, 0] > 128).all() and (instant.images[:, 1:] == 128).all()  # the distal array comes first
    assert (np.diff(instant.images[:3, 0, 0].astype(int)) > 0).all()  # fingers in their order, on one scale
    assert (coarse.images[:3, 0] > 128).all() and (coarse.images[:, 1:] == 128).all()


def test_schunk_names_a_grasp_that_does_not_fit(schunk):
    bad = schunk / "duck/grasp-1.mat"
    savemat(bad, {"TS": np.zeros((3, 3))})
    with pytest.raises(ValueError, match="duck/grasp-1.mat"):
        read_schunk(schunk)
    bad.write_text("no grasp")
    with pytest.raises(ValueError, match="duck/grasp-1.mat is not such a grasp"):
        read_schunk(schunk)
    with pytest.raises(ValueError, match="nowhere does not exist: give the path of the grasps of st-hmp"):
        read_schunk(schunk / "nowhere")


def test_reshape_is_matlabs():
    cells = np.arange(7 * 3 * 700).reshape(7, 3, 700)
    image = colour_image(cells)
    for row, column, sample in ((0, 0, 0), (6, 2, 699), (3, 1, 233), (5, 2, 400)):
        place = row + 7 * column + 21 * sample
        pixel = place % 70, place // 70 % 70, place // 4900
        assert image[pixel] == cells[row, column, sample]
    assert sorted(image.ravel()) == list(range(14700))


def test_each_electrode_has_one_cell_and_the_gaps_their_neighbours_mean():
    assert sorted(np.ravel(GRID)) == [0, 0, *range(1, 20)]
    image = electrode_grid(np.arange(1, 20)[None].astype(float))[0]
    assert image[0].tolist() == [9, 7, 8] and image[6].tolist() == [16, 19, 6]
    assert image[3].tolist() == [13, 8, 3] and image[4].tolist() == [14, 9, 4]


@pytest.mark.parametrize(
    ("text", "said"),
    [("1,2\n3,4", "2 lines of 2 numbers"), ("1;2", "not a table"), ("nan," * 18 + "1", "1 lines of 19")],
)
def test_bigs_names_a_table_that_does_not_fit(bigs, text, said):
    (bigs / "box/success/grasp_1/left.csv").write_text(text)
    with pytest.raises(ValueError, match=f"box/success/grasp_1/left.csv.*{said}"):
        read_bigs(bigs)


def test_bigs_names_what_is_missing(bigs):
    (bigs / "box/success/grasp_1/left.csv").unlink()
    with pytest.raises(ValueError, match="grasp_1 holds 2 tables, 3 are needed"):
        read_bigs(bigs)
    (bigs / "ball").rename(bigs / "tube")
    with pytest.raises(ValueError, match="ball/success is not a folder"):
        read_bigs(bigs)


@pytest.mark.parametrize(
    ("images", "labels", "classes", "said"),
    [
        (np.zeros((2, 4, 4)), [0, 1], ["a", "b"], "must be u1"),
        (np.zeros((2, 4, 4, 2), np.uint8), [0, 1], ["a", "b"], "must be u1"),
        (np.zeros((2, 4, 4), np.uint8), [0], ["a", "b"], "as many labels"),
        (np.zeros((2, 4, 4), np.uint8), [0, 0], ["a", "b"], "without any: b"),
        (np.zeros((2, 4, 4), np.uint8), [0, 0], ["a"], "two classes"),
        (np.zeros((2, 4, 4), np.uint8), [0, 2], ["a", "b"], "two classes"),
    ],
)
def test_parts_that_do_not_fit_are_refused(images, labels, classes, said):
    with pytest.raises(ValueError, match=said):
        Recorded(images, np.array(labels), classes, None)
