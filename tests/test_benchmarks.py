"""The benchmarks: help for each, and what the one of the backends counts as a result."""

import importlib
import runpy
import sys
from pathlib import Path

import numpy as np
import pytest
import trimesh

from benchmarks import imprints, simplification
from stages.kit import Mesh
from stages.lod import SimplifyError

BENCHMARKS = sorted(path.stem for path in Path(simplification.__file__).parent.glob("[a-z]*.py"))
BALL = Mesh(*(getattr(trimesh.creation.icosphere(2), name) for name in ("vertices", "faces")))


def run_as_program(monkeypatch, name, *arguments):
    monkeypatch.setattr(sys, "argv", ["python", *arguments])
    monkeypatch.delitem(sys.modules, f"benchmarks.{name}", raising=False)
    runpy.run_module(f"benchmarks.{name}", run_name="__main__", alter_sys=True)


@pytest.mark.parametrize("name", BENCHMARKS)
def test_help_of_a_benchmark_is_its_docstring(name, monkeypatch, capsys):
    doc = importlib.import_module(f"benchmarks.{name}").__doc__.splitlines()
    with pytest.raises(SystemExit) as end:
        run_as_program(monkeypatch, name, "--help")
    said = capsys.readouterr().out
    assert end.value.code == 0 and said.startswith(f"usage: python -m benchmarks.{name} ")
    assert doc[0] in said and doc[-1] in said


def of_backends(monkeypatch, faces, **answers):
    """dict backend -> row of a cell of a ball, where the backends answer with meshes or errors."""

    def answer(found):
        def work(*_):
            if isinstance(found, Exception):
                raise found
            return found

        return work

    monkeypatch.setattr(simplification, "BACKENDS", {name: answer(found) for name, found in answers.items()})
    monkeypatch.setattr(simplification, "WHOLE", ())
    rows = simplification.cell(BALL, faces, np.zeros(0, dtype=np.int64), 0)
    return {row["backend"]: row for row in rows}


def part(faces):
    return Mesh(BALL.vertices, BALL.faces[:faces])


def test_more_faces_than_asked_for_are_a_miss_without_ratios(monkeypatch):
    rows = of_backends(monkeypatch, 200, pymeshlab=part(200), more=part(201), fewer=part(190))
    assert {name: row["outcome"] for name, row in rows.items()} == {"pymeshlab": "reached", "more": "missed",
                                                                     "fewer": "reached"}  # fmt: skip
    assert rows["more"]["faces"] == 201 and "ratio" not in rows["more"] and "error_ratio" not in rows["more"]
    assert rows["pymeshlab"]["ratio"] == 1 and rows["fewer"]["ratio"] > 0


@pytest.mark.parametrize("reference", [part(201), SimplifyError("no")])
def test_nothing_is_compared_with_a_reference_that_did_not_reach_the_target(monkeypatch, reference):
    rows = of_backends(monkeypatch, 200, pymeshlab=reference, other=part(200))
    assert rows["other"]["outcome"] == "reached" and not [name for name in rows["other"] if "ratio" in name]


def test_a_talkative_peer_is_heard_and_a_failing_one_gives_its_reason(tmp_path):
    peer = tmp_path / "peer"
    peer.write_text(
        "#!/bin/sh\nhead -c 300000 /dev/zero >&2\nread job\necho '{\"seconds\": 1}'\nread job\necho no GL >&2\n"
    )
    peer.chmod(0o755)
    cameras = imprints.Cameras(str(peer))
    assert cameras.ask("tacto_32x32", 16, "job") == {"seconds": 1}
    for _ in range(2):
        with pytest.raises(ValueError, match="not run: .*no GL"):
            cameras.ask("tacto_32x32", 16, "job")
    cameras.close()
