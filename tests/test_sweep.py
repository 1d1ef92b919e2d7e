"""The sweep appends tidy rows, replaces those of a repeated job, and ends with a table."""

import json
import re
from pathlib import Path
from types import SimpleNamespace

import pandas as pd
import pytest
from omegaconf import OmegaConf

from haptic_glance.base.files import read_table, write_json, write_table, write_text
from stages import compose, sweep
from stages.engine.settings import ParamsError, load_params


def job_rows(job, classifier, value):
    common = {"dataset": "household", "group": "four", "method": "itti", "classifier": classifier}
    common |= {"job": job, "split": "random", "metric": "accuracy", "seconds": 0.01, "seed": 0}
    return pd.DataFrame([common | {"repetition": i, "value": value + 0.01 * (-1) ** i} for i in range(4)])


@pytest.fixture
def leave(tmp_path):
    def leave(name, frame):
        write_table(tmp_path / name / sweep.ROWS, frame)
        return tmp_path / name

    return leave


def test_rows_are_appended_and_a_repeated_job_replaces_its_own(leave, tmp_path, capsys):
    out = tmp_path / "recognition.csv"
    sweep.gather(leave("first", job_rows("classifier=knn", "knn", 0.5)), out)
    sweep.gather(leave("second", job_rows("classifier=svm", "svm", 0.7)), out)
    sweep.gather(leave("third", job_rows("classifier=knn", "knn", 0.6)), out)
    sweep.gather(tmp_path / "failed", out)
    stored = read_table(out)
    assert stored.groupby("classifier").value.mean().to_dict() == pytest.approx({"knn": 0.6, "svm": 0.7})
    assert len(stored) == 8 and capsys.readouterr().out.count("classifier=knn: 4 rows appended") == 2


@pytest.mark.slow
def test_a_sweep_goes_on_behind_a_job_that_fails_and_keeps_the_rows_of_each(root, monkeypatch):
    def recognise(values, _):
        if values["seed"] == 2:
            raise ParamsError("a reason")
        if values["seed"] == 4:  # Ctrl-C
            raise KeyboardInterrupt
        return job_rows("", "knn", 0.5).drop(columns=["job", "dataset"]).assign(seed=values["seed"]).to_dict("records")

    monkeypatch.setattr(sweep, "recognise", recognise)
    monkeypatch.setattr(sweep.sys, "argv", ["sweep", "-m", "data=household_four", "seed=2,3,4"])
    with pytest.raises(KeyboardInterrupt):
        sweep.job()
    assert sorted(set(read_table(sweep.OUT)["seed"])) == [3]
    monkeypatch.setattr(sweep.sys, "argv", ["sweep", "-m", "data=household_four", "seed=2,5"])
    with pytest.raises(SystemExit, match="1 of 2 jobs failed: .*seed=2"):
        sweep.job()
    assert sorted(set(read_table(sweep.OUT)["seed"])) == [3, 5]


def test_the_table_has_one_line_a_job_and_classifier():
    lines = sweep.table(pd.concat([job_rows("a", "knn", 0.5), job_rows("b", "knn", 0.25)]))
    assert lines.job.tolist() == ["a", "b"] and lines.accuracy.tolist()[1].startswith("0.250 [0.2")


@pytest.mark.parametrize(("value", "step", "shown"), [(0.99, 0.01, "0.990 [0.961, 1.000]"), (1.0, 0.0, "1.000")])
def test_an_accuracy_is_at_most_one(value, step, shown):
    rows = job_rows("a", "knn", value)
    rows["value"] = value + step * (-1.0) ** rows.repetition
    assert sweep.table(rows).accuracy.tolist() == [shown]


@pytest.fixture(scope="module")
def params():
    """A params.yaml that has another number of repetitions."""
    values = compose.compose(["sets=[household_four]", "profile=smoke", "classification.repetitions=3"])
    return OmegaConf.to_yaml(OmegaConf.create(values))


@pytest.fixture
def root(params, tmp_path, monkeypatch):
    """A folder with a params.yaml, and the files that jobs read."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "params.yaml").write_text(params)
    for stage in sweep.NEEDED:
        write_json(tmp_path / "data/household_four" / stage / "there.json", {})
    monkeypatch.setattr(sweep, "inputs_changed", lambda stages: False)  # no repository of DVC
    return tmp_path


@pytest.mark.slow
@pytest.mark.parametrize(
    "setting", ["lod.rings=two", "sets=[household_four]", "+meshes.unit=mm", "meshes.folder=/scans"]
)
def test_a_setting_that_no_job_reads_is_refused(root, setting):
    name = setting.partition("=")[0]
    with pytest.raises(ParamsError, match=rf"^{re.escape(name)} does not change a sweep: its jobs read salient_points"):
        sweep.prepare(["-m", "data=household_four", setting])


@pytest.mark.slow
def test_jobs_begin_with_the_settings_of_params_yaml_and_missing_results_are_named(root):
    sweep.prepare(["-m", "data=household_four", "classifier=knn,svm"])
    values = compose.composed(["data=household_four", "classifier=knn"])
    section = sweep.based(values, "household_four")["classification"]
    assert section["repetitions"] == 3 and section["classifiers"] == ["knn"]
    assert values["classification"]["repetitions"] == 20
    values["classification"]["repetitions"] = 7
    assert sweep.based(values, "household_four")["classification"]["repetitions"] == 7
    with pytest.raises(ParamsError, match=r"elephant.npz is not there: run `dvc repro meshes@toys` first"):
        sweep.recognise(values, root / "data/toys")


def test_sets_of_objects_that_are_not_there_are_left_out_and_names_that_are_there_are_told(tmp_path, capsys):
    data = tmp_path / "folder"
    assert sweep.sets_there({"six": ["cup"]}, data) == {"six": ["cup"]}  # its stages have not run: _touch says so
    for name in ("ball", "ring"):
        write_json(data / f"meshes/{name}.npz", {})
    sets = {"six": ["cup", "ring"], "mine": ["ball", "ring"]}
    assert sweep.sets_there(sets, data) == {"mine": ["ball", "ring"]}
    assert "six (cup)" in capsys.readouterr().err
    with pytest.raises(ParamsError, match=r"six \(cup\); name some .*\+classification.sets.NAME=.*: ball, ring$"):
        sweep.sets_there({"six": ["cup", "ring"]}, data)


@pytest.mark.slow
def test_jobs_know_the_sets_that_params_yaml_adds_and_not_those_that_it_lacks(root):
    values = OmegaConf.to_container(OmegaConf.load("params.yaml"))
    values["household_four"]["classification"]["sets"] = {"mine": ["hand", "cup"]}
    (root / "params.yaml").write_text(OmegaConf.to_yaml(OmegaConf.create(values)))
    sweep.prepare(["-m", "data=household_four"])
    job = compose.composed(["data=household_four", "+classification.sets.two=[cup,elephant]"])
    sets = sweep.based(job, "household_four")["classification"]["sets"]
    assert sets == {"mine": ["hand", "cup"], "two": ["cup", "elephant"]}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("override", "hint"),
    [
        ("chanels=itti", "did you mean channels"),
        ("channels=itti,al", "did you mean all"),
        ("classification.repetitons=3", "did you mean classification.repetitions"),
        ("imprints.pitch=0.01,-1", "imprints.pitch: -1 must be above 0"),
        ("data=household", "sets=.household.* and data=SET sweeps another set"),
    ],
)
def test_a_slip_of_the_pen_is_named_before_any_job(root, override, hint):
    with pytest.raises(ParamsError, match=hint):
        sweep.prepare(["-m", override])


@pytest.mark.slow
def test_settings_that_a_killed_sweep_left_are_put_back(root):
    before = Path("params.yaml").read_text()
    with sweep.results_in(Path("runs/sweeps")):
        left = {path: path.read_text() for path in (Path("params.yaml"), sweep.BEFORE)}
    for path, text in left.items():  # as after SIGKILL
        write_text(path, text)
    assert load_params()["out"] == "runs/sweeps"
    with sweep.results_in(Path("runs/sweeps")):
        assert load_params()["out"] == "runs/sweeps"
    assert Path("params.yaml").read_text() == before and not sweep.BEFORE.exists()


@pytest.mark.slow
@pytest.mark.parametrize("fault", ["absent", "changed"])
def test_what_jobs_read_is_made_first(root, monkeypatch, capsys, fault):
    if fault == "absent":
        (root / "data/household_four/weights/there.json").unlink()
    monkeypatch.setattr(sweep, "inputs_changed", lambda stages: fault == "changed")
    commands, before = [], Path("params.yaml").read_text()

    def run(command):
        commands.append((command[1:], load_params()["out"]))
        return SimpleNamespace(returncode=0)

    monkeypatch.setattr(sweep.subprocess, "run", run)
    sweep.prepare(["-m", "data=household_four"])
    names = [f"{stage}@household_four" for stage in sweep.NEEDED]
    assert commands == [(["-m", "dvc", "repro", *names], "runs/sweeps")]
    assert Path("params.yaml").read_text() == before
    assert "weights@household_four first: `dvc repro` makes them" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"meshes@toys": [{"changed deps": {"scans": "modified"}}]}, True),
        ({"views@toys": [{"changed outs": {"runs/sweeps/metrics/toys/views.json": "deleted"}}]}, False),  # of a sweep
        ({}, False),
        (None, False),
    ],
)
def test_files_and_settings_that_changed_since_the_stages_ran_are_seen(monkeypatch, changes, expected):
    answer = SimpleNamespace(returncode=int(changes is None), stdout=json.dumps(changes))
    monkeypatch.setattr(sweep.subprocess, "run", lambda command, **_: answer)
    assert sweep.inputs_changed(["meshes@toys"]) == expected
