"""The benchmarks: help for each, and what the one of the backends counts as a result."""

import numpy as np
import pandas as pd
import pytest
import trimesh

from benchmarks import _history, simplification
from haptic_glance.lod import SimplifyError
from haptic_glance.mesh.mesh import Mesh

BALL = Mesh(*(getattr(trimesh.creation.icosphere(2), name) for name in ("vertices", "faces")))


def of_backends(monkeypatch, faces, **answers):
    """dict backend -> row of a cell of a ball, where the backends answer with meshes or errors."""

    def answer(result):
        def work(*_):
            if isinstance(result, Exception):
                raise result
            return result

        return work

    monkeypatch.setattr(simplification, "BACKENDS", {name: answer(result) for name, result in answers.items()})
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


def test_nothing_is_compared_with_a_reference_that_did_not_reach_the_target(monkeypatch):
    for reference in (part(201), SimplifyError("no")):
        rows = of_backends(monkeypatch, 200, pymeshlab=reference, other=part(200))
        assert rows["other"]["outcome"] == "reached" and not [name for name in rows["other"] if "ratio" in name]


def history(*rows):
    """Rows (commit, hour, kernel, ratio, machine) of a made-up history, with quartiles 5 % about the ratio."""
    return pd.DataFrame([
        {"commit": commit, "date": f"2026-11-21T{hour:02}:00:00+00:00", "what": kernel, "peer": "peer", "ratio": ratio,
         "low": 0.95 * ratio, "high": 1.05 * ratio, "limit": _history.TOLERANCE * 1.05 * ratio, "seconds": 1,
         "machine": machine}
        for commit, hour, kernel, ratio, machine in rows
    ])  # fmt: skip


def complaints(known, here="here", **ratios):
    """What the check says of kernels that are measured with these ratios, one after the other, the last again."""

    def measure(kernel):
        return {"ratio": ratios[kernel].pop(0) if len(ratios[kernel]) > 1 else ratios[kernel][0]}

    return _history.slower(known, here, list(ratios), measure)


def test_a_slower_kernel_is_named_and_an_equal_one_is_not():
    known = history(("a", 1, "press", 0.5, "here"), ("a", 1, "maps", 0.1, "here"))
    (line,) = complaints(known, press=[0.5], maps=[0.2])
    assert line.startswith("maps is slower: 0.2 times")
    assert complaints(known, press=[0.01], maps=[0.13]) == []
    assert complaints(known, press=[float("nan")], maps=[0.1])


def test_a_kernel_is_slow_only_where_each_of_three_measurements_says_so():
    known = history(("a", 1, "press", 0.5, "here"))
    assert complaints(known, press=[2.0, 2.0, 0.5]) == []
    assert complaints(known, press=[2.0, 2.0, 2.0, 0.5])
    known = history(("a", 1, "press", 0.5, "here"), ("a", 1, "maps", 0.1, "elsewhere"))
    (line,) = complaints(known, press=[0.5], new=[9.0])
    assert line.startswith("maps is in ") and "no longer measured" in line


def test_the_last_commit_of_this_machine_counts_and_others_only_without_it():
    known = history(("b", 5, "press", 0.4, "here"), ("a", 1, "press", 0.8, "here"), ("c", 9, "press", 8, "elsewhere"))
    assert _history.limits(known, "here")["press"] == pytest.approx(1.3 * 1.05 * 0.4)
    known = history(("a", 1, "press", 0.4, "one"), ("a", 1, "press", 0.8, "another"), ("b", 2, "press", 0.5, "another"))
    assert _history.limits(known, "here")["press"] == pytest.approx(2 * 1.3 * 1.05 * 0.5)


def test_a_timed_call_finds_nothing_that_the_library_knows_of_an_equal_mesh(monkeypatch):
    seen = []
    monkeypatch.setattr(simplification, "BACKENDS", {"pymeshlab": lambda mesh, *_: seen.append(mesh) or part(200)})
    monkeypatch.setattr(simplification, "WHOLE", ())
    simplification.cell(BALL, 200, np.zeros(0, dtype=np.int64), 0)
    assert len(seen) == simplification.ROUNDS == len({BALL, *seen}) - 1
