"""A claim judged again from the committed rows, as a reader of a fresh clone does it."""

import json
import shutil
import subprocess
from importlib import import_module
from pathlib import Path

import pytest

from stages.charts.cells import rows_of
from stages.claim import run

ROOT = Path(__file__).parents[1]
KEYS = ["glance_soft_gaze", "equal_over_itti_gaze", "hybrid_smaller"]


@pytest.mark.slow
def test_the_committed_verdicts_follow_from_the_committed_rows(capsys):
    assert run([*KEYS, "--json"]) == 0
    records = {record["key"]: record for record in map(json.loads, capsys.readouterr().out.splitlines())}
    assert set(records) == set(KEYS)
    soft = records["glance_soft_gaze"]
    assert len(soft["differences"]) == soft["units"] and {"gaze", "gaze_clouds", "1,500 faces"} <= set(soft["effects"])
    assert all(map(Path.exists, map(Path, soft["rows"])))
    anew = "python -m stages.compose experiment=attention && dvc repro lod@gaze lod@gaze_clouds report"
    assert soft["command"] == anew


@pytest.mark.slow
def test_a_verdict_that_is_not_the_committed_one_is_named(monkeypatch, capsys):
    judging = import_module("stages.report.verdict")
    monkeypatch.setattr(judging, "verdict", lambda *_: "contradicted")
    assert run(["glance_soft_gaze"]) == 1
    captured = capsys.readouterr()
    assert "glance_soft_gaze: verdict contradicted, in reports/claims.csv supported; `git checkout" in captured.err
    assert "31 objects" in captured.out and "measure anew" in captured.out


@pytest.mark.slow
def test_the_size_of_a_file_has_no_interval(capsys):
    assert run(["hybrid_smaller"]) == 0
    text = capsys.readouterr().out
    assert "a single number" in text and "princeton_six: +1.43\n" in text


@pytest.fixture
def clone(tmp_path, monkeypatch):
    """A folder with the committed claims, and rows of lod that may be changed; the current folder."""
    for name in ("params.yaml", "conf", "data"):
        (tmp_path / name).symlink_to(ROOT / name)
    for path in (ROOT / "reports/measurements").glob("gaze*/lod.csv.gz"):
        copy = tmp_path / path.relative_to(ROOT)
        copy.parent.mkdir(parents=True)
        shutil.copyfile(path, copy)
    shutil.copyfile(ROOT / "reports/claims.csv", tmp_path / "reports/claims.csv")
    subprocess.run("git init -q && git add reports", shell=True, cwd=tmp_path, check=True)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.slow
def test_rows_that_are_missing_are_named_with_the_line_of_the_claim(clone):
    Path("reports/measurements/gaze_3_2/lod.csv.gz").unlink()
    with pytest.raises(ValueError, match=r"chapter_3.yaml:\d+ \(keep_metro\): no measurements of lod on gaze_3_2"):
        run(["keep_metro"])


@pytest.mark.slow
def test_a_new_claim_is_judged_and_what_adds_it_is_named(clone, capsys):
    file = Path("reports/claims.csv")
    claims = rows_of(file)
    claims[claims["key"] != "glance_soft_gaze"].to_csv(file, index=False)
    assert run(["glance_soft_gaze"]) == 1
    captured = capsys.readouterr()
    assert "supported" in captured.out
    assert captured.err == "claim: glance_soft_gaze: not yet in reports/claims.csv; `make repro` adds it\n"


def test_a_key_without_a_claim_is_answered_by_its_neighbour():
    with pytest.raises(ValueError, match="there is no claim glance_soft_gase: try glance_soft_gaze"):
        run(["glance_soft_gase"])
