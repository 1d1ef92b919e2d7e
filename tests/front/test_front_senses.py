"""Looking and pressing on real meshes: what is kept, what the faces of the model change, and the whole command."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh
from omegaconf import OmegaConf

from haptic_glance.base.files import write_mesh, write_text
from haptic_glance.mesh import normalise
from haptic_glance.mesh.mesh import Mesh
from stages import compose
from stages.engine.rows import read_rows
from stages.front import senses as module
from stages.front import space
from stages.front.senses import Senses
from stages.front.space import SPACE, WHOLE, choice_of

SMALL = {"method": "random", "viewpoints": "four", "image_rows": 225, "points": 20, "cells": 8, "level": "500",
         "touches": 1, "classifier": "knn"}  # fmt: skip
BLIND = choice_of(SMALL)


def shape(number):
    """A ball with bumps of its own."""
    ball = trimesh.creation.icosphere(subdivisions=3)
    random = np.random.default_rng(number)
    bumps = np.exp(-20 * (1 - ball.vertices @ random.normal(size=(3, 4)) / 2) ** 2).sum(axis=1)
    return normalise(Mesh(ball.vertices * (1 + 0.3 * bumps[:, None]) * random.uniform(0.6, 1, 3), ball.faces))


@pytest.fixture(scope="module", autouse=True)
def settings_by_classifier():
    """Settings are composed once a classifier; tests/front/test_front_space.py composes them for each choice."""

    def composed(overrides):
        _, classifier, *values = overrides
        chosen = OmegaConf.merge(compose.composed(["data=household", classifier]), OmegaConf.from_dotlist(values))
        return OmegaConf.to_container(chosen)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(space, "composed", composed)
        yield
    space.settings_of.cache_clear()


@pytest.fixture
def feeler(tmp_path):
    write_mesh(tmp_path / "one.npz", shape(0))
    return Senses({"one": tmp_path / "one.npz"}, tmp_path / "felt", 0)


@pytest.mark.slow
def test_a_coarse_model_is_learned_and_the_object_itself_is_asked_and_what_was_felt_is_kept(feeler, monkeypatch):
    whole, coarse = (feeler.feel("one", replace(BLIND, level=level)) for level in (WHOLE, "500"))
    assert (whole.faces, coarse.faces) == (1280, 500)
    assert (whole.learned == whole.asked).all() and not np.allclose(coarse.learned, coarse.asked)
    assert whole.seconds["simplifying"] == 0 < coarse.seconds["simplifying"]
    assert coarse.learned.shape == (len(coarse.places), 41) and len(coarse.places) <= 20
    many = feeler.feel("one", replace(BLIND, points=60))
    few = len(coarse.places)
    assert few < len(many.places) and (many.places[:few] == coarse.places).all()  # more places begin with the fewer
    monkeypatch.setattr(module, "press_both", None)
    for again in (BLIND, replace(BLIND, touches=3, classifier="svm")):
        felt = feeler.feel("one", again)
        assert (felt.learned == coarse.learned).all() and felt.seconds == coarse.seconds
    with pytest.raises(TypeError):
        feeler.feel("one", replace(BLIND, cells=16))


@pytest.mark.slow
def test_parts_that_cannot_be_so_coarse_keep_the_fewest_faces_they_can(tmp_path):
    balls = [trimesh.creation.icosphere(subdivisions=2) for _ in range(3)]
    for number, ball in enumerate(balls):
        ball.vertices += [3 * number, 0, 0]
    many = trimesh.util.concatenate(balls)
    write_mesh(tmp_path / "three.npz", normalise(Mesh(many.vertices, many.faces)))
    simple, _ = Senses({"three": tmp_path / "three.npz"}, tmp_path / "felt", 0)._level("three", "8")
    assert 8 < len(simple.faces) <= 100


@pytest.mark.slow
def test_a_tiny_study_leaves_rows_that_a_second_call_finds_done(tmp_path, monkeypatch, capsys):
    pytest.importorskip("optuna", reason="pip install 'haptic-glance[front]'")
    from stages.front import __main__ as command
    from stages.front import search
    from stages.front.known import Effort

    few = {name: tuple(option for option in options if option in (SMALL[name], "harris", 3, "svm"))
           for name, options in SPACE.items()}  # fmt: skip
    efforts = {name: Effort(shapes=6, sixes=1, regions=1, folds=2) for name in search.RUNGS}
    monkeypatch.setattr(command, "stage_digest", str)
    for part in (space, search):
        monkeypatch.setattr(part, "SPACE", few)
        monkeypatch.setattr(part, "DEFAULT", choice_of(SMALL | {"method": "farthest"}))
    monkeypatch.setattr(search, "RUNGS", efforts)
    monkeypatch.setattr(search, "CONFIRMATION", efforts["last"])
    for number in range(12):
        write_mesh(tmp_path / f"data/household/meshes/shape{number}.npz", shape(number))
    lines = [f"class{number // 2},object{number}" for number in range(8)]
    for number in range(8):
        write_mesh(tmp_path / f"data/furniture/meshes/object{number}.npz", shape(20 + number))
    write_text(tmp_path / "data/furniture/meshes/classes.csv", "\n".join(["class,object", *lines]))
    monkeypatch.chdir(Path(__file__).parents[2])
    assert command.run(["--trials", "4"], tmp_path) == 0
    rows = {
        name: read_rows(tmp_path / f"reports/measurements/{name}/front.csv.gz") for name in ("household", "furniture")
    }
    assert set(rows["household"]["split"]) == {"regions"} and set(rows["furniture"]["split"]) == {"objects"}
    for table in rows.values():
        seen = table["rung"].isin(["wide", "narrow", "last"])
        assert seen.any() and not set(table[seen]["item"]) & set(table[~seen]["item"])
        assert set(table["role"].dropna()) == {"default", "smallest"} and table["value"].dropna().between(0, 1).all()
    capsys.readouterr()
    assert command.run(["--trials", "4", "--minutes", "0"], tmp_path) == 0
    assert "front: wide" not in capsys.readouterr().err
    monkeypatch.setattr(command, "stage_digest", lambda stage: "another")
    with pytest.raises(ValueError, match="a study of another version .code .*, now another"):
        command.run(["--trials", "4"], tmp_path)
