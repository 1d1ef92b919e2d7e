"""DVC knows every file that the report opens: watched while it works, not read off its code."""

import sys
from pathlib import Path

import pytest
import yaml

from stages.report.__main__ import write_report

WATCHED = []  # lists that take the paths opened while they stand here; an audit hook cannot be taken back


def note(event, arguments):
    if event == "open" and WATCHED and isinstance(arguments[0], str | Path):
        WATCHED[-1].append(Path(arguments[0]))


sys.addaudithook(note)


@pytest.mark.slow
def test_dvc_knows_every_file_that_the_report_opens(root, small, monkeypatch):
    small.write_attention(root)
    monkeypatch.chdir(root)
    opened = []
    WATCHED.append(opened)
    write_report(small.results(Path()))
    WATCHED.pop()
    listed = yaml.safe_load((Path(__file__).parents[2] / "dvc.yaml").read_text())["stages"]["report"]["deps"]
    listed = [dep.replace("${out}", "reports") for dep in listed]
    inputs = {path for path in opened if path.parts[:1] == ("data",) or path.parts[:2] == ("reports", "measurements")}
    stages = {path.parts[2] for path in inputs if path.parts[0] == "data"}
    assert stages >= {"meshes", "classification", "lod", "weights"}
    assert {Path("reports/measurements/gaze/weights.csv.gz"), Path("data/reference/thesis")} <= {
        *inputs, *(path.parent for path in inputs)
    }  # fmt: skip
    unknown = {str(path) for path in inputs if not any(path.is_relative_to(dep) for dep in listed)}
    assert not unknown
