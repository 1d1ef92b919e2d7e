"""DVC knows every file that the report opens: watched while it works, not read off its code."""

import sys
from pathlib import Path

import yaml

from stages.report.__main__ import write_report
from stages.report.results import Results

WATCHED = []  # lists that take the paths opened while they stand here; an audit hook cannot be taken back


def note(event, arguments):
    if event == "open" and WATCHED and isinstance(arguments[0], str | Path):
        WATCHED[-1].append(Path(arguments[0]))


sys.addaudithook(note)


def test_dvc_knows_every_file_that_the_report_opens(root, small, monkeypatch):
    small.write_attention(root)
    monkeypatch.chdir(root)
    opened = []
    WATCHED.append(opened)
    write_report(Results(small.settings()))
    WATCHED.pop()
    listed = yaml.safe_load((Path(__file__).parents[2] / "dvc.yaml").read_text())["stages"]["report"]["deps"]
    read = [("data",), ("reports", "measurements"), ("reports", "attention"), ("reports", "simplification")]
    inputs = {path for path in opened if path.parts[:1] in read or path.parts[:2] in read}
    assert {path.parts[1] for path in inputs} >= {"meshes", "classification", "lod", "weights", "attention"}
    unknown = {str(path) for path in inputs if not any(path.is_relative_to(dep) for dep in listed)}
    assert not unknown
