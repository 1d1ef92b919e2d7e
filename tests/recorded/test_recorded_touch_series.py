"""Readers of touches over time, on small files in the published layouts."""

import zipfile
from pathlib import Path

import numpy as np
import pytest
from scipy.io import savemat

from stages.recorded.series import TAXELS, read_grasp_series, read_touch_events, spread_taxels

DATA = Path(__file__).parents[3] / "shared/data"


@pytest.fixture
def events(tmp_path):
    """A folder as TactileSGNet publishes it: three training touches and two test touches of two objects each."""
    random = np.random.default_rng(0)
    for folder, steps in (("Ev-Objects", 50), ("Ev-Containers", 65)):
        for part, count in (("train", 6), ("test", 4)):
            (tmp_path / folder / part).mkdir(parents=True)
            for k in range(count):
                touch = (random.random((39, 2, steps)) < 0.1).astype(np.float32)
                np.save(tmp_path / folder / part / f"sample_{k}_label_{k % 2}.npy", touch)
    return tmp_path


def test_events_are_read_in_order_with_the_publishers_parts_from_a_folder_or_a_zip_file(events, tmp_path_factory):
    touches = read_touch_events(events)
    assert touches["objects"].values.shape == (10, 39, 2, 50) and touches["containers"].values.shape == (10, 39, 2, 65)
    objects = touches["objects"]
    assert objects.labels.tolist() == ["00", "01"] * 5 and objects.test.tolist() == [False] * 6 + [True] * 4
    assert objects.names[[0, 6]].tolist() == ["train 0", "test 0"] and objects.values.dtype == np.uint8
    assert np.array_equal(objects.values[7], np.load(events / "Ev-Objects/test/sample_1_label_1.npy"))
    archive = tmp_path_factory.mktemp("zip") / "events.zip"
    with zipfile.ZipFile(archive, "w") as file:
        for path in sorted(events.rglob("*.npy"), reverse=True):
            file.write(path, path.relative_to(events))
    zipped = read_touch_events(archive)["objects"]
    assert np.array_equal(objects.values, zipped.values) and np.array_equal(objects.labels, zipped.labels)


TOUCH = "Ev-Objects/train/sample_2_label_0.npy"
FAULTS = {
    "damaged": (lambda file: file.write_bytes(b"\x93NUMPY"), f"{TOUCH} is damaged .* download the archive again"),
    "of another shape": (lambda file: np.save(file, np.zeros((38, 2, 50))), f"{TOUCH} is no touch of 39 taxels"),
    "not of events": (lambda file: np.save(file, np.full((39, 2, 50), 0.5)), f"{TOUCH} is no touch of 39 taxels"),
    "shorter": (lambda file: np.save(file, np.zeros((39, 2, 40))), "touches of Ev-Objects differ in shape"),
    "pickled": (lambda file: np.save(file, np.array([{}]), allow_pickle=True), f"{TOUCH} is damaged"),
    "absent": (lambda file: file.unlink(), "has no Ev-Objects/train/sample_2_label_L.npy; expected the archive of Tac"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_touch_that_is_not_one_is_named_with_the_remedy(fault, events):
    harm, message = FAULTS[fault]
    harm(events / TOUCH)
    with pytest.raises(ValueError, match=message):
        read_touch_events(events)


@pytest.fixture
def grasps(tmp_path):
    """A folder as st-hmp publishes it: two grasps of two objects each, the first of each kept for testing."""
    (tmp_path / "_setup").mkdir()
    (tmp_path / "_setup/test.list").write_text("0 ../data/BALL/grasp-0.mat\n1 ../data/WOOD/grasp-2.mat\n")
    for k, name in enumerate(("BALL", "BALL", "WOOD", "WOOD")):
        arrays = [np.full((rows, 6, 300), 5.0) for rows in (14, 13) * 3]
        arrays[1][2, 1, 100:] = 7 + k  # the distal array of the first finger
        arrays[0][0, 0, 50:] = 1  # pressure that falls is no pressure
        cells = np.empty((1, 6), dtype=object)
        cells[0] = arrays
        (tmp_path / name).mkdir(exist_ok=True)
        savemat(tmp_path / f"{name}/grasp-{k}.mat", {"TS": cells})
    return tmp_path


def test_grasps_are_the_rise_of_pressure_with_the_publishers_list(grasps):
    series = read_grasp_series(grasps)["grasps"]
    assert series.values.shape == (4, 486, 1, 294) and series.labels.tolist() == ["BALL", "BALL", "WOOD", "WOOD"]
    assert series.test.tolist() == [True, False, True, False]
    assert series.values[..., -1].sum(axis=(1, 2)).tolist() == [2, 3, 4, 5] and not series.values[..., :100].any()


def test_a_list_that_names_what_is_not_there_and_no_list_are_said(grasps):
    (grasps / "WOOD/grasp-2.mat").unlink()
    with pytest.raises(ValueError, match=r"lacks grasp-2\.mat, which _setup/test\.list names"):
        read_grasp_series(grasps)
    (grasps / "_setup/test.list").unlink()
    with pytest.raises(ValueError, match=r"has no _setup/test\.list; expected the grasps of st-hmp"):
        read_grasp_series(grasps)


def test_fewer_taxels_are_spread_from_the_middle_to_the_ends():
    assert spread_taxels(1).tolist() == [20] and spread_taxels(39).tolist() == list(range(39))
    away = np.linalg.norm(TAXELS[spread_taxels(5)][:, None] - TAXELS[spread_taxels(5)], axis=2)
    assert away[~np.eye(5, dtype=bool)].min() > 6  # the finger is 12 x 17.8


@pytest.mark.slow
@pytest.mark.parametrize(
    ("archive", "read"), [("touch_events", read_touch_events), ("grasp_arrays", read_grasp_series)]
)
def test_the_published_archives(archive, read):
    if not (DATA / f"{archive}.zip").exists():
        pytest.skip(f"{archive}.zip is not beside the project")
    shapes = {
        name: (*series.values.shape, len(set(series.labels)), int(series.test.sum()))
        for name, series in read(DATA / f"{archive}.zip").items()
    }
    assert shapes in (
        {"objects": (720, 39, 2, 250, 36, 144), "containers": (300, 39, 2, 325, 20, 60)},
        {"grasps": (51, 486, 1, 294, 5, 5)},
    )
