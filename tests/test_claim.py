"""A claim judged again from the committed rows, as a reader of a fresh clone does it."""

import json
import shutil
import subprocess
from importlib import import_module
from pathlib import Path

import pytest

from stages.charts.cells import rows_of
from stages.claim import as_share, run
from stages.engine.settings import Workspace

ROOT = Path(__file__).parents[1]
KEYS = ["glance_soft_gaze", "equal_over_itti_gaze", "four_easier"]


@pytest.mark.slow
def test_the_committed_verdicts_follow_from_the_committed_rows(capsys):
    assert run([*KEYS, "--json"]) == 0
    records = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert {record["key"] for record in records} == set(KEYS)
    for record in records:
        assert len(record["differences"]) == record["pairs"] and all(map(Path.exists, map(Path, record["rows"])))
    (soft,) = (record for record in records if record["key"] == "glance_soft_gaze")
    anew = "python -m stages.compose experiment=attention && dvc repro lod@gaze lod@gaze_clouds report"
    assert soft["command"] == anew


@pytest.mark.slow
def test_a_verdict_that_is_not_the_committed_one_is_named(monkeypatch, capsys):
    judging = import_module("stages.report.verdict")
    monkeypatch.setattr(judging, "verdict", lambda low, high, unit: "contradicted")
    assert run(["glance_soft_gaze"]) == 1
    captured = capsys.readouterr()
    assert "glance_soft_gaze: contradicted (7.47, 31 units), in reports/claims.csv supported" in captured.err
    assert "31 objects" in captured.out and "measure anew" in captured.out


@pytest.fixture
def clone(tmp_path, monkeypatch):
    """A folder with the committed claims, and rows of lod that may be changed; the current folder."""
    for name in ("params.yaml", "conf", "data"):
        (tmp_path / name).symlink_to(ROOT / name)
    for path in (ROOT / "reports/measurements").glob("*/lod.csv.gz"):
        copy = tmp_path / path.relative_to(ROOT)
        copy.parent.mkdir(parents=True)
        shutil.copyfile(path, copy)
    shutil.copyfile(ROOT / "reports/claims.csv", tmp_path / "reports/claims.csv")
    subprocess.run("git init -q && git add reports", shell=True, cwd=tmp_path, check=True)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.slow
def test_rows_that_are_missing_are_named(clone, capsys):
    file = Path("reports/measurements/gaze_3_2/lod.csv.gz")
    file.unlink()
    assert run(["keep_metro"]) == 1
    message = capsys.readouterr().err
    assert (
        "open (not run: no measurements of lod on gaze_3_2), in reports/claims.csv contradicted (-67.6, 17 units)"
        in message
    )
    assert f"{file} is missing; `git checkout {file}`" in message


@pytest.mark.slow
def test_a_new_claim_is_judged_and_what_adds_it_is_named(clone, capsys):
    file = Path("reports/claims.csv")
    claims = rows_of(file)
    claims[claims["key"] != "glance_soft_gaze"].to_csv(file, index=False)
    assert run(["glance_soft_gaze"]) == 1
    captured = capsys.readouterr()
    assert "supported" in captured.out
    assert captured.err == "claim: glance_soft_gaze: not yet in reports/claims.csv; `make repro` adds it\n"


@pytest.mark.parametrize(
    ("key", "text"),
    [
        ("glance_soft_gaze", "7.2 [5.24, 9.13] % less than the first"),
        ("keep_metro", "2.02 [1.84, 2.19] times the first"),
    ],
)
def test_an_effect_in_percent_of_both_is_also_a_share_as_the_readme_states_it(key, text):
    """README.md has 7.2 [5.2, 9.1] % and 2.10 [1.93, 2.24] times for the two."""
    row = rows_of(ROOT / "reports/claims.csv").set_index("key").loc[key]
    fields = {"unit": row["unit"]} | {name: float(row[name]) for name in ("effect", "low", "high")}
    assert as_share(fields) == [f"  as a share: the second is {text}"]
    assert as_share(fields | {"unit": "NSS"}) == []


def test_a_key_without_a_claim_is_answered_by_its_neighbour():
    with pytest.raises(ValueError, match="there is no claim glance_soft_gase: try glance_soft_gaze"):
        run(["glance_soft_gase"])


@pytest.mark.slow
def test_a_set_that_is_not_switched_on_is_not_measured():
    assert "gaze" not in Workspace(Path(".")).params["graph"]["lod"]
    with pytest.raises(ValueError, match=r"lod is not switched on for gaze: `python -m stages.compose 'sets=\[gaze\]'"):
        run(["glance_soft_gaze", "--measure"])
