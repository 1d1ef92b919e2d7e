"""The contract of a panel: it shows, is clicked, and hides, without a message; free of a browser."""

import threading
import time
from contextlib import suppress
from types import SimpleNamespace

import msgspec
import numpy as np
import pytest
from viser import __version__ as version
from viser import _messages as messages
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from haptic_glance.know import Exploration, learn, primitives
from haptic_glance.lod import write_any
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.studio.app import Studio
from haptic_glance.studio.guard import COOKIE
from haptic_glance.studio.panels import PANELS
from haptic_glance.studio.panels.know import KnowPanel, gather
from haptic_glance.studio.session import Session, Settings
from haptic_glance.studio.specimen import Specimen

from .conftest import ball

PATIENCE = 120  # seconds, on a machine with other work
EYE = (1.05, -1.4, 0.6)


def read(line):
    """Reads what the server sends, or it would wait."""
    with suppress(ConnectionClosed):
        for _ in line:
            pass


def until(holds):
    """Waits until a condition holds."""
    end = time.monotonic() + PATIENCE
    while not holds():
        assert time.monotonic() < end, "the condition did not come to hold"
        time.sleep(0.05)


@pytest.fixture(scope="module")
def window(tmp_path_factory):
    """The studio's side of a page that answers nothing; what it says to the person is in window.said."""
    folder = tmp_path_factory.mktemp("studio")
    ball().export(folder / "knob.ply")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("haptic_glance.studio.panels.know.HOUSEHOLD", folder / "nothing")
        patch.setattr("haptic_glance.studio.app.SECONDS", 0.1)  # this page has no storage
        studio = Studio(Settings([folder / "knob.ply"], marks=folder / "marks", annotator="ann"))
        port = studio.server.get_port()
        header = {"Cookie": f"{COOKIE}{port}={studio.server.token}"}
        options = {"subprotocols": [f"viser-v{version}"], "additional_headers": header, "max_size": None}
        with connect(f"ws://127.0.0.1:{port}/", **options) as line:
            threading.Thread(target=read, args=(line,), daemon=True).start()
            pose = (1.0, 0.0, 0.0, 0.0), EYE, 0.62, 0.1, 10.0, 600, 800, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)
            camera = messages.ViewerCameraMessage(*pose).as_serializable_dict()
            line.send(msgspec.msgpack.encode(camera))
            until(lambda: studio.windows)
            ((_, window),) = studio.windows.values()
            window.said = []
            patch.setattr(window, "say", lambda *said, **_: window.said.append(said))
            until(lambda: window.session.specimen is not None and not window.jobs)
            yield window
        studio.stop()


@pytest.mark.parametrize("title", [panel.title for panel in PANELS])
def test_a_panel_shows_is_clicked_and_hides_without_a_message(window, title):
    window.choose(title)
    until(lambda: not window.jobs)
    eye = np.array(EYE)
    window.run("", lambda: window.clicked(eye, -eye / np.linalg.norm(eye)))
    until(lambda: not window.jobs)
    assert window.panel.title == title and window.scene.has("/mesh")
    window.run("", lambda: window.clicked(eye, eye / np.linalg.norm(eye)))  # beside the mesh
    window.choose(next(panel.title for panel in PANELS if panel.title != title))
    until(lambda: not window.jobs)
    assert not window.said


def test_the_planner_knows_the_mesh_and_the_belief_comes_back_with_the_panel(window):
    window.choose("Know")
    until(lambda: window.panel.exploration is not None and not window.jobs)
    window.run("", window.panel.touch_next)
    until(lambda: not window.jobs)
    assert len(window.panel.exploration.images) and window.scene.has("/know/touched/0")
    window.run("", window.panel.touch_on)
    until(lambda: not window.jobs)
    assert window.panel.about.content.startswith("**knob**, after")
    window.choose("Look")
    assert not window.scene.has("/know")
    window.choose("Know")
    assert window.scene.has("/know/touched/0") and not window.said
    window.run("", window.panel.learn)
    until(lambda: not window.jobs)
    assert len(window.panel.exploration.images) == 0


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
