"""Readers of recorded touches: what is in the archives arrives, and what is broken is named."""

import io
import zipfile
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from PIL import Image

from stages.classification.touch_readers import ELECTRODES, PALMS, read_grasps, read_pressure_images

SHARED = Path(__file__).parents[2].parent / "shared/data"


def jpg(values):
    stream = io.BytesIO()
    Image.fromarray(values.astype(np.uint8)).save(stream, "JPEG", quality=95)
    return stream.getvalue()


def images(**changes):
    """Files of an archive of two classes; the value of a picture is its number times ten."""
    pictures = {k: jpg(np.full((28, 50), 10 * k)) for k in (1, 2, 10)}
    files = {f"Images/{name}/{name[:3]}{k}.jpg": pictures[k] for name in ("tube", "ball") for k in pictures}
    return files | changes


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


def write(folder, files):
    for name, content in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(content)
    return folder


def write_zip(path, files):
    with zipfile.ZipFile(path, "w") as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return path


@pytest.fixture(params=["zip", "folder"])
def stored(request, tmp_path):
    if request.param == "zip":
        return lambda files: write_zip(tmp_path / "archive.zip", files)
    return lambda files: write(tmp_path / "archive", files)


def test_classes_are_sorted_and_touches_stand_by_their_number_with_rows_along_the_shorter_side(stored):
    ramp = np.repeat(np.arange(28)[:, None] * 9, 50, axis=1)
    touches = read_pressure_images(stored(images(**{"Images/ball/bal1.jpg": jpg(ramp)})))
    assert list(touches) == ["ball", "tube"]
    assert touches["tube"].shape == (3, 28, 50) and touches["tube"].dtype == np.float64
    assert touches["tube"].mean(axis=(1, 2)) == pytest.approx(np.array([10, 20, 100]) / 255, abs=0.005)
    assert np.abs(255 * touches["ball"][0] - ramp).max() < 6


@pytest.mark.parametrize(
    ("files", "reason"),
    [
        ({"other.txt": b"none"}, r"archive.*no \.jpg in Images.*expected"),
        (images(**{"Images/tube/tub2.jpg": b"no picture"}), r"tub2\.jpg is not a readable picture: download"),
        (images(**{"Images/tube/tub2.jpg": jpg(np.ones((16, 16)))}), "several sizes"),
    ],
)
def test_pressure_images_that_are_none_are_named(tmp_path, files, reason):
    with pytest.raises(ValueError, match=reason):
        read_pressure_images(write(tmp_path / "archive", files))


@pytest.mark.parametrize("read", [read_pressure_images, read_grasps])
def test_what_is_no_zip_file_or_not_there_is_named(read, tmp_path):
    with pytest.raises(ValueError, match="gone.zip does not exist: give the path of"):
        read(tmp_path / "gone.zip")
    (tmp_path / "half.zip").write_bytes(b"PK but no more")
    with pytest.raises(ValueError, match="half.zip is not a complete zip file: download it again"):
        read(tmp_path / "half.zip")


def test_a_damaged_member_is_named(tmp_path):
    path = write_zip(tmp_path / "damaged.zip", images())
    content = bytearray(path.read_bytes())
    content[content.index(b"tub1.jpg") + 60] ^= 0xFF
    path.write_bytes(content)
    with pytest.raises(ValueError, match=r"tub1\.jpg is damaged .*download the archive again"):
        read_pressure_images(path)


def test_grasps_keep_electrodes_objects_palms_labels_and_which_are_tests(stored):
    recorded = read_grasps(stored(grasps(side_test=table(objects=("new", "newer"), th_biotac_24=7.5))))
    assert recorded.electrodes.shape == (12, 72) and recorded.electrodes.dtype == np.float64
    assert recorded.palms.tolist() == [palm for _ in range(2) for palm in PALMS for _ in range(2)]
    assert recorded.test.tolist() == [False] * 6 + [True] * 6 and recorded.slipped.tolist() == [False, True] * 6
    assert recorded.objects[-2:].tolist() == ["new", "newer"] and recorded.electrodes[-1, -1] == 7.5
    assert recorded.electrodes[0].tolist() == list(range(72))


@pytest.mark.parametrize(
    ("files", "reason"),
    [
        (grasps(down_test=None), r"archive.* has no bts3v2_palm_down_test\.csv; expected"),
        (grasps(**{"45": table().drop(columns="mf_biotac_3")}), r"palm_45\.csv has no column mf_biotac_3"),
        (grasps(side=table(ff_biotac_1=[1, "odd"])), r"palm_side\.csv, line 3: an empty cell or not a number"),
        (grasps(side=table(th_biotac_9=[None, 1])), r"palm_side\.csv, line 2: an empty cell or not a number"),
        (grasps(side=table(slipped=[0, 2])), r"palm_side\.csv, line 3: slipped must be 0 or 1, not 2"),
        (grasps() | {"bts3v2_palm_side.csv": b""}, r"palm_side\.csv is not a valid table"),
    ],
)
def test_tables_of_grasps_that_are_none_are_named(tmp_path, files, reason):
    with pytest.raises(ValueError, match=reason):
        read_grasps(write(tmp_path / "archive", files))


@pytest.mark.slow
@pytest.mark.skipif(not (SHARED / "pressure_images.zip").exists(), reason="no pressure_images.zip in ../shared/data")
def test_the_true_archive_of_pressure_images():
    classes = read_pressure_images(SHARED / "pressure_images.zip")
    assert len(classes) == 22 and {touches.shape for touches in classes.values()} == {(50, 28, 50)}
    assert all(touches.max() > 0.3 and touches.min() == 0 for touches in classes.values())


@pytest.mark.skipif(not (SHARED / "biotac_grasps.zip").exists(), reason="no biotac_grasps.zip in ../shared/data")
def test_the_true_archive_of_grasps():
    recorded = read_grasps(SHARED / "biotac_grasps.zip")
    test, slipped = recorded.test, recorded.slipped
    assert recorded.electrodes.shape == (5831, 72) and test.sum() == 1149
    assert (slipped[~test].sum(), slipped[test].sum()) == (2354, 589)  # as its authors count
    assert not set(recorded.objects[test]) & set(recorded.objects[~test]) and len(set(recorded.objects)) == 51
