"""The stage on small objects, in a folder of its own: its pairs, its files, its rows, and a kill in the middle."""

import numpy as np
import pytest
import trimesh

from haptic_glance.base.files import write_arrays, write_mesh
from haptic_glance.base.rng import rng
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import Surface, follow
from stages.contours import Params
from stages.contours import __main__ as stage
from stages.contours.contours import draw_pairs, read_sequences, sample_contours

SHAPE = trimesh.creation.torus(0.35, 0.15, major_sections=40, minor_sections=20)
RING = Mesh(SHAPE.vertices, SHAPE.faces)
BOX = Mesh(trimesh.creation.box((0.4, 0.6, 0.2)).vertices, trimesh.creation.box((0.4, 0.6, 0.2)).faces)
POINTS = np.array([5, 100, 300, 555, 700])
SMALL = {"frames": 5, "cells": (6, 6), "pitch": 0.02}
SETTINGS = Params(["random", "salient"], 4, 5, [6, 6], 0.02)


@pytest.fixture
def run(tmp_path):
    """A function that processes the ring and returns its rows."""
    write_object(tmp_path, "ring", RING, {"salient": POINTS})
    return lambda settings: stage.process("ring", tmp_path / "out", tmp_path, settings, 0)


def write_object(data, name, mesh, points):
    """Writes a mesh and its salient points where the stage reads them."""
    write_mesh(data / f"meshes/{name}.npz", mesh)
    write_arrays(data / f"salient_points/{name}.npz", **{f"{method}.points": ids for method, ids in points.items()})


def test_stage_writes_the_contract(run, tmp_path):
    rows = run(SETTINGS)
    stored = read_sequences(tmp_path / "out/ring.npz")
    assert list(stored) == ["random", "salient"]
    for sequences in stored.values():
        assert sequences.images.shape == (4, 5, 6, 6) and sequences.images.dtype == np.uint8
        assert (
            sequences.normals.shape == sequences.positions.shape == (4, 5, 3) and sequences.normals.dtype == np.float32
        )
        assert (
            sequences.pitches.shape == (4, 5)
            and sequences.planes.shape == (4, 2)
            and sequences.planes.dtype == np.int64
        )
    assert np.isin(stored["salient"].planes, POINTS).all()
    metrics = ["sequences", "refused", "loops", "share", "shrunk"]
    assert [(row["method"], row["metric"]) for row in rows] == [(way, key) for way in stored for key in metrics]
    assert rows[0]["value"] == 4 and all(row["item"] == "ring" and row["seconds"] > 0 for row in rows)
    means = stage.summary(rows, 0)
    assert means["random"]["sequences"] == 4 and 0 < means["salient"]["share"]["mean"] <= 1
    with pytest.raises(ValueError, match="contours.strategies: itti is not among salient, random"):
        run(Params(["itti"], 4, 5, [6, 6], 0.02))


def test_a_stored_sequence_is_what_follow_feels():
    sequences, facts = sample_contours(Surface(RING), POINTS, 3, rng(0, "a"), **SMALL)
    again = follow(RING, np.r_[np.zeros((1, 3)), RING.vertices[sequences.planes[2]]], **SMALL)
    assert np.array_equal(sequences.images[2], np.round(255 * again.images))
    assert np.array_equal(sequences.positions[2], again.positions.astype(np.float32))
    assert facts["sequences"] == 3 and sequences.images.max() == 255


def test_an_object_with_too_few_pairs_gives_all_and_says_so(run, tmp_path):
    rows = run(Params(["salient"], 50, 5, [6, 6], 0.02))
    assert rows[0]["value"] == 10 - rows[1]["value"] and "of 50; its 5 points have no more pairs" in rows[0]["note"]
    planes = read_sequences(tmp_path / "out/ring.npz")["salient"].planes
    assert len({frozenset(pair) for pair in planes.tolist()}) == rows[0]["value"]


def test_pairs_on_a_line_with_the_centre_are_refused_and_others_drawn():
    sequences, facts = sample_contours(
        Surface(BOX), np.arange(8), 40, rng(0, "b"), **SMALL
    )  # 28 pairs, 4 of opposite corners
    assert (facts["sequences"], facts["refused"]) == (24, 4) and len(sequences.images) == 24
    assert not (BOX.vertices[sequences.planes].sum(axis=1) == 0).all(axis=1).any()
    few, facts = sample_contours(Surface(BOX), np.arange(8), 20, rng(0, "b"), **SMALL)
    assert facts["sequences"] == 20 and np.array_equal(few.planes, sequences.planes[:20])


def test_an_object_without_a_contour_gives_none():
    sequences, facts = sample_contours(Surface(BOX), np.array([3]), 5, rng(0, "c"), **SMALL)
    assert sequences.images.shape == (0, 5, 6, 6) and sequences.planes.shape == (0, 2)
    assert facts == {"sequences": 0, "refused": 0, "loops": None, "share": None, "shrunk": None}
    with pytest.raises(ValueError, match="count must be"):
        sample_contours(Surface(BOX), np.arange(8), 0, rng(0, "c"), **SMALL)


def as_sets(pairs):
    return {frozenset(pair) for pair in pairs.tolist()}


def test_all_pairs_come_once_where_there_are_no_more():
    points = np.array([7, 3, 11, 40, 5])
    pairs = draw_pairs(points, 100, rng(0, "a"))
    assert pairs.shape == (10, 2) and len(as_sets(pairs)) == 10
    assert {vertex for pair in pairs.tolist() for vertex in pair} == set(points.tolist())
    for few in ([], [3], [3, 3]):
        assert draw_pairs(np.array(few, dtype=np.int64), 5, rng(0, "e")).shape == (0, 2)


@pytest.mark.slow
@pytest.mark.parametrize("size", [60, 300_000])
def test_pairs_are_distinct_and_of_the_points(size):
    pairs = draw_pairs(np.arange(size), 1500, rng(0, "b"))
    assert len(as_sets(pairs)) == 1500 and (pairs[:, 0] != pairs[:, 1]).all()
    assert pairs.min() >= 0 and pairs.max() < size


def test_every_pair_and_both_orders_are_as_likely():
    counts = np.zeros((4, 4))
    for turn in range(3000):
        first, second = draw_pairs(np.arange(4), 1, rng(turn, "c"))[0]
        counts[first, second] += 1
    off = counts[~np.eye(4, dtype=bool)]
    assert off.min() > 180 and off.max() < 320  # 250 each, five standard deviations
