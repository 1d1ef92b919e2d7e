"""The panel Know without a page: what is known, and what is touched."""

from types import SimpleNamespace

import numpy as np
import pytest

from haptic_glance.know import Exploration, learn, primitives
from haptic_glance.lod import write_any
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.studio.panels.know import KnowPanel, gather
from haptic_glance.studio.session import Session
from haptic_glance.studio.specimen import Specimen


@pytest.fixture(scope="module")
def shapes():
    return primitives()


def test_everything_that_was_opened_is_known(tmp_path, shapes):
    write_any(tmp_path / "brick.stl", shapes["box"])
    (tmp_path / "broken.stl").write_bytes(b"nothing")
    table = Specimen(shapes["torus"], "ring")
    files = [tmp_path / "brick.stl", tmp_path / "broken.stl"]
    meshes, notes = gather(files, None, table, True, None)
    assert set(meshes) == {*shapes, "brick", "ring"} and len(notes) == 1 and "broken.stl" in notes[0]
    assert set(gather([], None, table, False, tmp_path)[0]) == {"brick", "ring"}
    table = Specimen(Mesh(shapes["torus"].vertices, shapes["torus"].faces), "ball")
    meshes, _ = gather([], None, table, True, None)  # the mesh on the table wins over one of the same name
    assert len(meshes["ball"].faces) == len(shapes["torus"].faces)


def test_a_mesh_that_is_no_longer_on_the_table_is_not_touched_and_another_panel_draws_nothing(shapes):
    library = learn(shapes)
    old, new = (Exploration(library, shapes["cone"], np.random.default_rng(seed)) for seed in range(2))
    panel = KnowPanel(SimpleNamespace(session=Session(kept={"Know": new}), panel=None))
    panel.bars, panel.about = SimpleNamespace(), SimpleNamespace()
    panel.touch(old, old.candidate(0))
    assert len(old.images) == len(new.images) == 0
    panel.touch(new, new.candidate(0))
    panel.draw()
    assert len(new.images) == 1 and panel.bars.visible
