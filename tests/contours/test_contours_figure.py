"""The figure of contours: built from what the stage wrote, and told where nothing was."""

from types import SimpleNamespace

import numpy as np
import pytest
import trimesh

from stages.classes.files import write_object
from stages.contours import gather, write_sequences
from stages.imprints import Surface
from stages.kit import Mesh
from stages.kit.rng import rng
from stages.report.figures import figure_4_14
from stages.report.figures._contours import followed
from stages.report.results import NotRun

SHAPE = trimesh.creation.torus(0.35, 0.15, major_sections=40, minor_sections=20)
RING = Mesh(SHAPE.vertices, SHAPE.faces)


def results(root, preferred=()):
    settings = SimpleNamespace(figure_objects=list(preferred))
    return SimpleNamespace(data=root / "data", reports=root / "reports", settings=settings)


def write(root, names, strategies):
    for name in names:
        write_object(root / f"data/classes/{name}.npz", RING, {})
        found = {one: gather(Surface(RING), np.arange(800), 3, rng(0, one), cells=(8, 8))[0] for one in strategies}
        write_sequences(root / f"data/contours/{name}.npz", found)


def test_the_figure_shows_blind_and_guided_contours_and_what_is_felt(tmp_path):
    write(tmp_path, ["a", "b"], ["enhanced", "random", "thesis_ssim"])
    found = figure_4_14.build(results(tmp_path, ["b"]))
    assert [path.name for path in found.paths] == ["figure_4_14.png", "figure_4_15.png"]
    assert all(path.stat().st_size > 10_000 for path in found.paths)
    assert "b, a" in found.alt and "blind touch and enhanced attention (SSIM)" in found.alt
    assert "first contour of b" in found.caption


def test_the_figure_does_without_guided_contours(tmp_path):
    write(tmp_path, ["a"], ["random"])
    assert "contours each, blind touch;" in figure_4_14.build(results(tmp_path)).alt


def test_without_contours_the_figure_is_not_run(tmp_path):
    with pytest.raises(NotRun, match="dvc repro contours"):
        figure_4_14.build(results(tmp_path))


def test_the_contour_drawn_is_the_one_followed():
    found, _ = gather(Surface(RING), np.arange(800), 5, rng(0, "a"), cells=(8, 8))
    for pair, positions in zip(found.planes, found.positions, strict=True):
        drawn = followed(RING, pair)
        ends = np.roll(drawn.points, -1, axis=0)
        away = np.linalg.norm((drawn.points + ends)[None] / 2 - positions[:, None], axis=2).min(axis=1)
        assert (away <= drawn.steps.max()).all()
