"""The sweep appends tidy rows, replaces those of a repeated job, and ends with a table."""

import pandas as pd
import pytest

from stages import sweep
from stages.compose import compose
from stages.kit.files import read_table, write_table


def job_rows(job, classifier, value, seed=0):
    common = {"dataset": "household", "group": "four", "method": "itti", "classifier": classifier}
    rows = [
        {
            "job": job,
            **common,
            "repetition": i,
            "split": "random",
            "metric": "accuracy",
            "value": value + 0.01 * (-1) ** i,
        }
        for i in range(4)
    ]
    return pd.DataFrame([{**row, "seconds": 0.01, "seed": seed} for row in rows])


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
    stored = read_table(out)
    assert stored.groupby("classifier").value.mean().to_dict() == pytest.approx({"knn": 0.6, "svm": 0.7})
    assert len(stored) == 8 and "1 jobs, 4 rows appended" in capsys.readouterr().out


def test_the_table_has_one_line_a_job_and_classifier():
    lines = sweep.table(pd.concat([job_rows("a", "knn", 0.5), job_rows("b", "knn", 0.25)]))
    assert lines.job.tolist() == ["a", "b"] and lines.accuracy.tolist()[1].startswith("0.250 [0.2")


@pytest.mark.slow
def test_missing_upstream_results_are_named(tmp_path):
    config = compose(["sets=[household_four]", "profile=smoke", "classifier=knn"])
    values = {"seed": 0} | config["household_four"]
    with pytest.raises(SystemExit, match=r"elephant.npz is not there: run `dvc repro meshes@toys` first"):
        sweep.recognise(values, tmp_path / "data/toys")
