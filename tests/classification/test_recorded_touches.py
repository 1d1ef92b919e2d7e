"""Readers of recorded touches: what is in the archives arrives, and what is broken is named."""

import io
import zipfile
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from PIL import Image

from stages.classification.recorded import ELECTRODES, PALMS, read_grasps, read_pressure_images

SHARED = Path(__file__).parents[2].parent / "shared/data"


def jpg(value, shape=(28, 50)):
    stream = io.BytesIO()
    Image.fromarray(np.full(shape, value, dtype=np.uint8)).save(stream, "JPEG")
    return stream.getvalue()


def images(**changes):
    """Files of an archive of two classes; the value of a picture is its number times ten."""
    files = {f"Images/{name}/{name[:3]}{k}.jpg": jpg(10 * k) for name in ("tube", "ball") for k in (1, 2, 10)}
    return {name: found for name, found in (files | changes).items() if found is not None}


def table(objects=("apple", "cup"), **changes):
    rows = pd.DataFrame({"object": objects, "slipped": [0, 1]})
    rows[ELECTRODES] = np.arange(2 * len(ELECTRODES)).reshape(2, -1)
    return rows.assign(**changes)


def grasps(**changes):
    """Files of an archive of grasps; changes: {PALM or PALM_test: table, or None for a missing one}."""
    tables = {f"{palm}{test}": table() for palm in PALMS for test in ("", "_test")} | changes
    return {
        f"bts3v2_palm_{name}.csv": rows.to_csv(index=False).encode()
        for name, rows in tables.items()
        if rows is not None
    }


@pytest.fixture(params=["zip", "folder"])
def stored(request, tmp_path):
    def write(files):
        path = tmp_path / ("archive.zip" if request.param == "zip" else "archive")
        if request.param == "zip":
            with zipfile.ZipFile(path, "w") as archive:
                for name, content in files.items():
                    archive.writestr(name, content)
        else:
            path.mkdir()
            for name, content in files.items():
                (path / name).parent.mkdir(parents=True, exist_ok=True)
                (path / name).write_bytes(content)
        return path

    return write


def test_classes_are_sorted_and_touches_stand_by_their_number(stored):
    found = read_pressure_images(stored(images()))
    assert list(found) == ["ball", "tube"]
    assert found["tube"].shape == (3, 28, 50) and found["tube"].dtype == np.float64
    assert found["tube"].mean(axis=(1, 2)) == pytest.approx(np.array([10, 20, 100]) / 255, abs=0.005)


def test_rows_of_a_picture_are_the_shorter_side_of_the_sensor(stored):
    ramp = np.repeat(np.arange(28, dtype=np.uint8)[:, None] * 9, 50, axis=1)
    stream = io.BytesIO()
    Image.fromarray(ramp).save(stream, "JPEG", quality=95)
    found = read_pressure_images(stored(images(**{"Images/tube/tub1.jpg": stream.getvalue()})))["tube"][0]
    assert np.abs(255 * found - ramp).max() < 6


def test_an_archive_of_pressure_images_without_its_folder_is_refused(stored):
    with pytest.raises(ValueError, match=r"archive.*no \.jpg in Images.*expected"):
        read_pressure_images(stored({"other.txt": b"none"}))


def test_a_picture_that_is_none_is_named(stored):
    with pytest.raises(ValueError, match=r"tub2\.jpg is not a readable picture: download"):
        read_pressure_images(stored(images(**{"Images/tube/tub2.jpg": b"no picture"})))


def test_pictures_of_several_sizes_are_refused(stored):
    with pytest.raises(ValueError, match="several sizes"):
        read_pressure_images(stored(images(**{"Images/tube/tub2.jpg": jpg(1, (16, 16))})))


@pytest.mark.parametrize("read", [read_pressure_images, read_grasps])
def test_what_is_no_zip_file_or_not_there_is_named(read, tmp_path):
    with pytest.raises(ValueError, match="gone.zip does not exist: give the path of"):
        read(tmp_path / "gone.zip")
    (tmp_path / "half.zip").write_bytes(b"PK but no more")
    with pytest.raises(ValueError, match="half.zip is not a complete zip file: download it again"):
        read(tmp_path / "half.zip")


def test_a_damaged_member_is_named(tmp_path):
    path = tmp_path / "damaged.zip"
    with zipfile.ZipFile(path, "w") as archive:
        for name, content in images().items():
            archive.writestr(name, content)
    content = bytearray(path.read_bytes())
    content[content.index(b"tub1.jpg") + 60] ^= 0xFF
    path.write_bytes(content)
    with pytest.raises(ValueError, match=r"tub1\.jpg is damaged .*download the archive again"):
        read_pressure_images(path)


def test_grasps_keep_electrodes_objects_palms_labels_and_which_are_tests(stored):
    found = read_grasps(stored(grasps(side_test=table(objects=("new", "newer"), th_biotac_24=7.5))))
    assert found.electrodes.shape == (12, 72) and found.electrodes.dtype == np.float64
    assert found.palms.tolist() == [palm for _ in range(2) for palm in PALMS for _ in range(2)]
    assert found.test.tolist() == [False] * 6 + [True] * 6 and found.slipped.tolist() == [False, True] * 6
    assert found.objects[-2:].tolist() == ["new", "newer"] and found.electrodes[-1, -1] == 7.5
    assert found.electrodes[0].tolist() == list(range(72))


def test_a_missing_table_is_named(stored):
    with pytest.raises(ValueError, match=r"archive.* has no bts3v2_palm_down_test\.csv; expected"):
        read_grasps(stored(grasps(down_test=None)))


def test_a_missing_column_is_named(stored):
    with pytest.raises(ValueError, match=r"palm_45\.csv has no column mf_biotac_3"):
        read_grasps(stored(grasps(**{"45": table().drop(columns="mf_biotac_3")})))


@pytest.mark.slow
@pytest.mark.parametrize(
    "change, said",
    [
        ({"ff_biotac_1": [1, "odd"]}, "line 3: an empty cell or not a number"),
        ({"th_biotac_9": [None, 1]}, "line 2: an empty cell or not a number"),
        ({"slipped": [0, 2]}, "line 3: slipped must be 0 or 1, not 2"),
    ],
)
def test_a_bad_cell_is_named_by_its_line(stored, change, said):
    with pytest.raises(ValueError, match=rf"palm_side\.csv, {said}"):
        read_grasps(stored(grasps(side=table(**change))))


def test_a_table_that_is_none_is_named(stored):
    files = grasps() | {"bts3v2_palm_side.csv": b""}
    with pytest.raises(ValueError, match=r"palm_side\.csv is not a valid table"):
        read_grasps(stored(files))


@pytest.mark.slow
@pytest.mark.skipif(not (SHARED / "pressure_images.zip").exists(), reason="no pressure_images.zip in ../shared/data")
def test_the_true_archive_of_pressure_images():
    found = read_pressure_images(SHARED / "pressure_images.zip")
    assert len(found) == 22 and {touches.shape for touches in found.values()} == {(50, 28, 50)}
    assert all(touches.max() > 0.3 and touches.min() == 0 for touches in found.values())


@pytest.mark.skipif(not (SHARED / "biotac_grasps.zip").exists(), reason="no biotac_grasps.zip in ../shared/data")
def test_the_true_archive_of_grasps():
    found = read_grasps(SHARED / "biotac_grasps.zip")
    assert found.electrodes.shape == (5831, 72) and found.test.sum() == 1149
    assert (found.slipped[~found.test].sum(), found.slipped[found.test].sum()) == (2354, 589)  # as its authors count
    assert not set(found.objects[found.test]) & set(found.objects[~found.test])
    assert len(set(found.objects)) == 51
