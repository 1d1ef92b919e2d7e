"""The recorded stage on an archive of each kind."""

import pandas as pd
import pytest

from haptic_glance.base.files import read_json
from stages.classification.touch_readers import ELECTRODES, PALMS
from stages.engine.rows import read_rows
from stages.recorded import pressure_images
from stages.recorded.__main__ import run


def settings(kind, folder):
    return {"recorded": {"kind": kind, "folder": str(folder), "repetitions": 1}}


@pytest.mark.slow
def test_pressure_images(make_workspace, recordings, tmp_path, monkeypatch):
    monkeypatch.setattr(pressure_images, "CLASSIFIERS", ["knn"])
    recordings.write_archive(tmp_path / "archive", recordings.touches(noise=0.01))
    workspace = make_workspace(settings("pressure_images", "archive"))
    run(workspace)
    rows = read_rows(workspace.measurements / "recorded.csv.gz")
    assert set(rows.loc[rows["metric"] == "accuracy", "split"]) == {"random", "blocks", "folds"}
    metrics = read_json(workspace.metrics / "recorded.json")
    assert set(metrics) == {"share_similar", "accuracy_random", "accuracy_blocks", "accuracy_folds"}


@pytest.mark.slow
def test_biotac_grasps(make_workspace, recordings, tmp_path, monkeypatch):
    grasps = recordings.grasps()
    (tmp_path / "archive").mkdir()
    for palm in PALMS:
        for test in (False, True):
            mask = (grasps.palms == palm) & (grasps.test == test)
            table = pd.DataFrame(grasps.electrodes[mask], columns=ELECTRODES)
            table = table.assign(object=grasps.objects[mask], slipped=grasps.slipped[mask].astype(int))
            table.to_csv(tmp_path / f"archive/bts3v2_palm_{palm}{'_test' if test else ''}.csv", index=False)
    workspace = make_workspace(settings("biotac_grasps", tmp_path / "archive"))
    run(workspace)
    rows = read_rows(workspace.measurements / "recorded.csv.gz")
    assert set(rows["metric"]) == {"accuracy"} and set(rows["components"].dropna()) == {12, 72}
    metrics = read_json(workspace.metrics / "recorded.json")
    assert set(metrics) == {"slip_test_objects", "slip_objects", "recognition_random", "recognition_blocks"}
