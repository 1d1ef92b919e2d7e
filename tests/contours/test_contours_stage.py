"""The stage on small objects, in a folder of its own: its files, its rows, and a kill in the middle."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import trimesh

from stages.contours import Sequences, gather, read_sequences, write_sequences
from stages.contours import __main__ as stage
from stages.contours.schema import Params
from stages.imprints import Surface, follow
from stages.kit import Mesh
from stages.kit.files import sha256
from stages.kit.rng import rng

SHAPE = trimesh.creation.torus(0.35, 0.15, major_sections=40, minor_sections=20)
RING = Mesh(SHAPE.vertices, SHAPE.faces)
BOX = Mesh(trimesh.creation.box((0.4, 0.6, 0.2)).vertices, trimesh.creation.box((0.4, 0.6, 0.2)).faces)
POINTS = np.array([5, 100, 300, 555, 700])
SMALL = {"frames": 5, "cells": (6, 6), "pitch": 0.02}
SETTINGS = Params(["random", "salient"], 4, 5, [6, 6], 0.02)


@pytest.fixture
def run(tmp_path, monkeypatch):
    """A function that processes the ring and returns its rows."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(stage, "read_object", lambda path: (RING, {"salient": POINTS}))
    return lambda settings, folder="out": stage.process("ring", tmp_path / folder, settings, 0)


def test_stage_writes_the_contract(run, tmp_path):
    rows = run(SETTINGS)
    stored = read_sequences(tmp_path / "out/ring.npz")
    assert list(stored) == ["random", "salient"]
    for found in stored.values():
        assert found.images.shape == (4, 5, 6, 6) and found.images.dtype == np.uint8
        assert found.normals.shape == found.positions.shape == (4, 5, 3) and found.normals.dtype == np.float32
        assert found.pitches.shape == (4, 5) and found.planes.shape == (4, 2) and found.planes.dtype == np.int64
    assert np.isin(stored["salient"].planes, POINTS).all()
    metrics = ["sequences", "refused", "loops", "share", "shrunk"]
    assert [(row["method"], row["metric"]) for row in rows] == [(way, key) for way in stored for key in metrics]
    assert rows[0]["value"] == 4 and all(row["object"] == "ring" and row["seconds"] > 0 for row in rows)
    means = stage.summary(rows, 0)
    assert means["random"]["sequences"] == 4 and 0 < means["salient"]["share"]["mean"] <= 1


def test_a_stored_sequence_is_what_follow_feels():
    found, facts = gather(Surface(RING), POINTS, 3, rng(0, "a"), **SMALL)
    again = follow(RING, np.r_[np.zeros((1, 3)), RING.vertices[found.planes[2]]], **SMALL)
    assert np.array_equal(found.images[2], np.round(255 * again.images))
    assert np.array_equal(found.positions[2], again.positions.astype(np.float32))
    assert facts["sequences"] == 3 and found.images.max() == 255


def test_an_unknown_strategy_names_the_known_ones(run):
    with pytest.raises(ValueError, match="contours.strategies: itti is not among random, salient"):
        run(Params(["itti"], 4, 5, [6, 6], 0.02))


def test_an_object_with_too_few_pairs_gives_all_and_says_so(run, tmp_path):
    rows = run(Params(["salient"], 50, 5, [6, 6], 0.02))
    assert rows[0]["value"] == 10 - rows[1]["value"] and "of 50; its 5 points have no more pairs" in rows[0]["note"]
    planes = read_sequences(tmp_path / "out/ring.npz")["salient"].planes
    assert len({frozenset(pair) for pair in planes.tolist()}) == rows[0]["value"]


def test_pairs_on_a_line_with_the_centre_are_refused_and_others_drawn():
    found, facts = gather(Surface(BOX), np.arange(8), 40, rng(0, "b"), **SMALL)  # 28 pairs, 4 of opposite corners
    assert (facts["sequences"], facts["refused"]) == (24, 4) and len(found.images) == 24
    assert not (BOX.vertices[found.planes].sum(axis=1) == 0).all(axis=1).any()
    few, facts = gather(Surface(BOX), np.arange(8), 20, rng(0, "b"), **SMALL)
    assert facts["sequences"] == 20 and np.array_equal(few.planes, found.planes[:20])


def test_an_object_without_a_contour_gives_none():
    found, facts = gather(Surface(BOX), np.array([3]), 5, rng(0, "c"), **SMALL)
    assert found.images.shape == (0, 5, 6, 6) and found.planes.shape == (0, 2)
    assert facts == {"sequences": 0, "refused": 0, "loops": None, "share": None, "shrunk": None}


def test_no_sequences_at_all_are_refused():
    with pytest.raises(ValueError, match="count must be"):
        gather(Surface(BOX), np.arange(8), 0, rng(0, "c"), **SMALL)


def test_files_hold_what_was_written(tmp_path):
    parts = (np.arange(96).reshape(2, 3, 4, 4), np.ones((2, 3, 3)), np.ones((2, 3, 3)), np.ones((2, 3)), np.eye(2))
    write_sequences(tmp_path / "a.npz", {"random": Sequences(*parts)})
    found = read_sequences(tmp_path / "a.npz")["random"]
    assert np.array_equal(found.images, parts[0]) and np.array_equal(found.planes, np.eye(2))


SCRIPT = """
import os, signal, sys
import numpy as np, trimesh
import stages.classes
from stages.kit import Mesh
SIZES = {"a": (0.4, 0.6, 0.2), "b": (0.3, 0.3, 0.5), "c": (0.2, 0.2, 0.7)}
die = False
def read_object(path):
    if path.stem == "b" and die:
        os.kill(os.getpid(), signal.SIGKILL)
    box = trimesh.creation.box(SIZES[path.stem]).subdivide().subdivide()
    return Mesh(box.vertices, box.faces), {"thesis_ssim": np.arange(0, 90, 7)}
stages.classes.read_object = read_object
from stages.contours import __main__ as stage
for run in ("killed die", "killed live", "whole live"):  # a process each, and the imports only once
    child = os.fork()
    if child == 0:
        folder, how = run.split()
        os.chdir(folder)
        die, sys.argv = how == "die", ["stages/contours/__main__.py"]
        stage.main()
        os._exit(0)
    print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), os.path.isdir("killed/data/contours"), flush=True)
"""
PARAMS = """
seed: 0
parallel: {backend: sequential, workers: 1}
classes: {source: made, folder: "", up: z, names: {}, methods: [], count: 1}
contours: {strategies: [random, thesis_ssim], count: 3, frames: 4, cells: [5, 5], pitch: 0.02}
"""


def test_a_killed_run_goes_on_and_ends_with_the_same_bytes(tmp_path):
    for run in ("killed", "whole"):
        (tmp_path / run / "data/classes").mkdir(parents=True)
        for name in "abc":
            (tmp_path / run / f"data/classes/{name}.npz").touch()
        (tmp_path / run / "params.yaml").write_text(PARAMS)
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[2]), "OMP_NUM_THREADS": "1"}
    done = subprocess.run([sys.executable, "-c", SCRIPT], cwd=tmp_path, env=environment, capture_output=True, text=True)
    told = [line for line in done.stdout.splitlines() if not line.startswith("contours:")]
    assert told == [f"{-signal.SIGKILL} False", "0 True", "0 True"], done.stderr
    for name in "abc":
        one, other = (tmp_path / run / f"data/contours/{name}.npz" for run in ("killed", "whole"))
        assert sha256(one) == sha256(other)
    table = [(tmp_path / run / "reports/measurements/contours.csv").read_text() for run in ("killed", "whole")]
    assert len(table[0].splitlines()) == len(table[1].splitlines()) == 1 + 3 * 2 * 5
    assert table[0].splitlines()[1].startswith("made,a,random,")
