"""The figure of contours: built from what the stage wrote, and told where nothing was."""

import numpy as np
import pytest
import trimesh

from haptic_glance.base.files import write_mesh, write_text
from haptic_glance.base.rng import rng
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import Surface
from stages.charts.results import Results
from stages.contours.contours import sample_contours, write_sequences
from stages.engine.settings import Workspace
from stages.report import Params
from stages.report.parts import build_item
from stages.sequences import report as sequences
from stages.sequences.report import followed

SHAPE = trimesh.creation.torus(0.35, 0.15, major_sections=40, minor_sections=20)
RING = Mesh(SHAPE.vertices, SHAPE.faces)
PARAMS = "seed: 0\nprofile: test\nparallel: {backend: sequential}\ngraph: {}\nsets: [furniture]\n"


def results(root, preferred=()):
    write_text(root / "params.yaml", PARAMS)
    settings = Params(
        hero_object="a", figure_objects=list(preferred), viewer_objects=[], viewer_count=1, viewer_faces=100,
        viewer_lod_methods=[], viewer_kilobytes=100,
    )  # fmt: skip
    return Results(Workspace(root), settings)


def write(root, names, strategies):
    for name in names:
        write_mesh(root / f"data/furniture/meshes/{name}.npz", RING)
        contours = {
            strategy: sample_contours(Surface(RING), np.arange(800), 3, rng(0, strategy), cells=(8, 8))[0]
            for strategy in strategies
        }
        write_sequences(root / f"data/furniture/contours/{name}.npz", contours)


def figure(name, results):
    return build_item(sequences, "figures", name, results)


@pytest.mark.slow
def test_the_figures_show_blind_and_guided_contours_and_what_is_felt(tmp_path):
    write(tmp_path, ["a", "b"], ["glance", "random", "thesis_ssim"])
    run = results(tmp_path, ["b"])
    contours, felt = figure("figure_4_14", run), figure("figure_4_15", run)
    assert all(picture.paths[0].stat().st_size > 10_000 for picture in (contours, felt))
    assert "b, a" in contours.alt and "blind touch and thesis, SSIM" in contours.alt
    write(tmp_path, ["a", "b"], ["random"])
    assert "contours each, blind touch." in figure("figure_4_14", results(tmp_path)).alt


def test_the_contour_drawn_is_the_one_followed():
    contours, _ = sample_contours(Surface(RING), np.arange(800), 5, rng(0, "a"), cells=(8, 8))
    for pair, positions in zip(contours.planes, contours.positions, strict=True):
        drawn = followed(RING, pair)
        ends = np.roll(drawn.points, -1, axis=0)
        away = np.linalg.norm((drawn.points + ends)[None] / 2 - positions[:, None], axis=2).min(axis=1)
        assert (away <= drawn.steps.max()).all()
