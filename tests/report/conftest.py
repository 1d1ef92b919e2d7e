"""A small run to report on: measurements with a known truth, beside the thesis's tables."""

import shutil
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from stages.kit import Mesh
from stages.kit.files import write_arrays, write_mesh, write_table
from stages.report.results import Results
from stages.report.schema import Params

THESIS = Path(__file__).parents[2] / "data/reference/thesis"
OBJECTS = ["ball", "cube"]


def settings(**changes):
    """The report's settings for the small run."""
    values = {
        "hero_object": "ball", "figure_objects": ["ball"], "viewer_objects": ["ball"], "viewer_count": 2,
        "viewer_faces": 10000, "viewer_lod_methods": ["qem", "enhanced"], "viewer_kilobytes": 1000,
    }  # fmt: skip
    return Params(**values | changes)


def ball(rings=12):
    """A closed ball of radius 0.5."""
    polar, around = np.meshgrid(
        np.linspace(0, np.pi, rings + 1)[1:-1], np.arange(2 * rings) * np.pi / rings, indexing="ij"
    )
    rows = np.stack([np.sin(polar) * np.cos(around), np.sin(polar) * np.sin(around), np.cos(polar)], -1).reshape(-1, 3)
    vertices = 0.5 * np.vstack([rows, [0, 0, 1], [0, 0, -1]])
    grid = np.arange(len(rows)).reshape(rings - 1, 2 * rings)
    a, b, c, d = grid[:-1], np.roll(grid, -1, 1)[:-1], grid[1:], np.roll(grid, -1, 1)[1:]
    sides = np.concatenate([np.stack([a, c, b], -1).reshape(-1, 3), np.stack([b, c, d], -1).reshape(-1, 3)])
    top = np.stack([grid[0], np.roll(grid[0], -1), np.full(2 * rings, len(rows))], -1)
    bottom = np.stack([np.roll(grid[-1], -1), grid[-1], np.full(2 * rings, len(rows) + 1)], -1)
    return Mesh(vertices, np.concatenate([sides, top, bottom]))


def classification(enhanced=0.8, rivals=0.5):
    """Rows with known accuracies: enhanced points are better by a margin far over the noise."""
    rng = np.random.default_rng(0)
    rows = []
    for objects in ("six", "four"):
        for method, accuracy in (("enhanced", enhanced), ("itti", rivals), ("random", rivals)):
            for classifier, seconds in (("knn", 0.01), ("deep_learning", 1.0)):
                for repetition in range(6):
                    value = accuracy + 0.01 * rng.normal()
                    row = {"dataset": "test", "object": objects, "method": method, "classifier": classifier}
                    row |= {"repetition": repetition, "metric": "accuracy_holdout", "value": value}
                    rows.append(row | {"seconds": seconds, "seed": 0})
    return pd.DataFrame(rows)


def lod():
    """Rows in which plain QEM has exactly half the error of the enhanced method; one cell is infeasible."""
    rows = []
    for name in OBJECTS:
        for method, factor in (("qem", 1.0), ("enhanced", 2.0)):
            for target, error in (("50%", 0.01), ("25%", 0.03)):
                infeasible = (name, method, target) == ("cube", "enhanced", "25%")
                cell = {"dataset": "test", "object": name, "method": method, "target": target, "faces": 100}
                values = {"faces": 100, "metro_mean": error * factor, "ssim_error": error * factor}
                for metric, value in values.items():
                    value = np.nan if infeasible else value
                    rows.append(cell | {"metric": metric, "value": value, "seconds": 0.1, "seed": 0})
    return pd.DataFrame(rows)


def write_measurements(root, stage, frame):
    """Puts a frame where the report looks for it."""
    write_table(root / "reports/measurements" / f"{stage}.csv", frame)


def write_set(root, name, count):
    """Leaves behind what the classification does of a set of so many objects."""
    write_arrays(
        root / "data/classification" / f"{name}.enhanced.npz", objects=np.array([f"o{k}" for k in range(count)])
    )


def left_out(frame, note, **where):
    """The frame without the rows of `where`; in their place one row with the reason and no more."""
    gone = np.logical_and.reduce([frame[column] == value for column, value in where.items()])
    row = {"dataset": "test", **where, "value": np.nan, "note": note, "seed": 0}
    return pd.concat([frame[~gone], pd.DataFrame([row])], ignore_index=True)


@pytest.fixture
def small():
    """What tests make their own small runs of."""
    return SimpleNamespace(
        settings=settings, ball=ball, classification=classification, write=write_measurements, write_set=write_set,
        left_out=left_out,
    )  # fmt: skip


@pytest.fixture
def bare(tmp_path):
    """A root with the thesis's tables and nothing measured."""
    shutil.copytree(THESIS, tmp_path / "data/reference/thesis")
    return tmp_path


@pytest.fixture
def root(bare):
    """A root with two objects and a few measurements."""
    mesh = ball()
    for name in OBJECTS:
        write_mesh(bare / "data/meshes" / f"{name}.npz", mesh)
        points = np.array([3, 50, 100])
        found = {"points": points, "strong": np.int64(2), "saliency": np.linspace(0, 1, len(mesh.vertices))}
        arrays = {f"enhanced.{key}": value for key, value in found.items()}
        write_arrays(bare / "data/salient_points" / f"{name}.npz", **arrays)
        write_mesh(bare / "data/lod" / name / "qem_50pct.npz", ball(8))
    write_measurements(bare, "classification", classification())
    write_set(bare, "six", 6)
    write_set(bare, "four", 4)
    write_measurements(bare, "lod", lod())
    return bare


@pytest.fixture
def results(root):
    """The results of the small run."""
    return Results(settings(), root)
