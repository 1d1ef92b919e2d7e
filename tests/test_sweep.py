"""The sweep appends tidy rows, replaces those of a repeated job, and ends with a table."""

import pandas as pd
import pytest

from stages import sweep
from stages.kit.files import read_table, write_table


def job_rows(job, classifier, value, seed=0):
    common = {"dataset": "household", "object": "four", "method": "itti", "classifier": classifier}
    rows = [{"job": job, **common, "repetition": i, "metric": "accuracy_holdout", "value": value} for i in range(4)]
    return pd.DataFrame([{**row, "seconds": 0.01, "seed": seed} for row in rows])


@pytest.fixture
def leave(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)

    def leave(name, frame):
        write_table(tmp_path / name / sweep.ROWS, frame)
        return tmp_path / name

    return leave


def test_rows_are_appended_and_a_repeated_job_replaces_its_own(leave, capsys):
    sweep.gather(leave("first", job_rows("classifier=knn", "knn", 0.5)))
    sweep.gather(leave("second", job_rows("classifier=svm", "svm", 0.7)))
    sweep.gather(leave("third", job_rows("classifier=knn", "knn", 0.6)))
    stored = read_table(sweep.OUT)
    assert stored.groupby("classifier").value.mean().to_dict() == pytest.approx({"knn": 0.6, "svm": 0.7})
    assert len(stored) == 8 and "1 jobs, 4 rows appended" in capsys.readouterr().out


def test_the_table_has_one_line_a_job_and_classifier():
    lines = sweep.table(pd.concat([job_rows("a", "knn", 0.5), job_rows("b", "knn", 0.25)]))
    assert lines.job.tolist() == ["a", "b"] and lines.accuracy.tolist()[1].startswith("0.250 [0.250, 0.250]")


def test_missing_upstream_results_are_named(tmp_path, monkeypatch):
    from omegaconf import OmegaConf

    from stages.compose import compose

    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit, match=r"no data/meshes/elephant.npz: run `dvc repro meshes` first"):
        sweep.recognise(OmegaConf.to_container(compose(["profile=smoke", "classifier=knn"])))
