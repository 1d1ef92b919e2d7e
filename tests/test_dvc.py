"""What users of DVC expect: a few headline metrics, and plots with data."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from stages.report.headlines import HEADLINES, write_headlines

pytest.importorskip("dvc")
ROOT = Path(__file__).parents[1]


def dvc(*arguments):
    """The parsed output of a command of DVC in this repository."""
    command = [sys.executable, "-m", "dvc", *arguments, "--json"]
    return json.loads(subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout)


@pytest.mark.slow
def test_metrics_are_the_headlines():
    [shown] = dvc("metrics", "show").values()
    (numbers,) = (file["data"] for file in shown["data"].values())
    assert {*HEADLINES} < {*numbers} and len(numbers) <= 16
    assert numbers == json.loads((ROOT / "reports/headlines.json").read_text())


@pytest.mark.slow
def test_every_plot_has_rows():
    shown = dvc("plots", "show")
    assert not shown.get("errors")
    charts = [chart for plots in shown["data"].values() for chart in plots]
    assert len(charts) == 4 and all("seconds" in json.dumps(chart) for chart in charts)


@pytest.mark.slow
def test_a_fresh_clone_knows_what_has_changed_and_what_would_run(tmp_path):
    subprocess.run(["git", "clone", "-q", str(ROOT), str(tmp_path / "clone")], check=True)
    for words in (["status", "--json"], ["repro", "--dry", "--force"]):
        command = [sys.executable, "-m", "dvc", *words]
        process = subprocess.run(command, cwd=tmp_path / "clone", capture_output=True, text=True)
        assert process.returncode == 0, process.stderr
    assert process.stdout.index("python -m stages.code") < process.stdout.index("python -m stages.report")


def test_a_chart_that_is_not_there_is_left_out(tmp_path):
    (tmp_path / "tradeoff").mkdir()
    (tmp_path / "tradeoff/saliency.csv").write_text("method,mean\nitti,0.3\nglance,0.75\n")
    (tmp_path / "tradeoff/scene.csv").write_text("name\nours\n")
    write_headlines(tmp_path, {"supported": 2})
    numbers = json.loads((tmp_path / "headlines.json").read_text())
    assert numbers == {
        "touch_accuracy_knn_glance": 0.75,
        "claims_supported": 2,
        "claims_contradicted": 0,
        "claims_open": 0,
    }
