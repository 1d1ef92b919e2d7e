"""The contract of a panel: it shows, is clicked, and hides, without a message; free of a browser."""

import threading
import time
from contextlib import suppress
from dataclasses import replace
from types import SimpleNamespace

import msgspec
import numpy as np
import pytest
from viser import __version__ as version
from viser import _messages as messages
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from haptic_glance.know import learn, primitives
from haptic_glance.lod import write_any
from haptic_glance.look.views import render
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.studio.app import Studio
from haptic_glance.studio.feeling import felt_by
from haptic_glance.studio.guard import COOKIE
from haptic_glance.studio.panels import PANELS
from haptic_glance.studio.panels.know import BOARD, CAMERA, Course, KnowPanel, gather
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


def do(window, work):
    """Runs what a button runs, and waits until it is done."""
    window.run("", work)
    until(lambda: not window.jobs)


def test_a_peek_and_touches_know_the_mesh_and_come_back_with_the_panel(window):
    window.choose("Know")
    until(lambda: window.panel.course is not None and not window.jobs)
    panel = window.panel
    do(window, panel.learn)
    do(window, panel.peek)
    assert panel.picture.visible and panel.course.words == "after a peek"
    do(window, panel.touch_next)
    assert len(panel.course.belief.touches) == 1 and window.scene.has("/know/touched/1")
    assert panel.grid.visible and "touch 1" in panel.grid.content
    do(window, panel.touch_on)
    assert panel.about.content.startswith("**knob**, after a peek and ")
    window.choose("Look")
    assert not window.scene.has("/know")
    window.choose("Know")
    assert window.scene.has("/know/touched/1") and not window.said


def test_another_mesh_on_the_table_starts_again(window, shapes):
    window.choose("Know")
    until(lambda: window.panel.course is not None and not window.jobs)
    do(window, window.panel.peek)
    do(window, window.panel.touch_next)
    before, knob = window.panel.course, window.session.specimen
    window.put(Specimen(shapes["torus"], "ring"))
    until(lambda: window.panel.course is not None and not window.jobs)
    course = window.panel.course
    assert "ring has the shape of torus" in window.panel.known.content
    assert course.words == "" and "ring" in course.belief.library.names and not window.scene.has("/know")
    assert not window.panel.picture.visible and not window.panel.grid.visible
    window.panel.advance(before, before)  # a touch of the old mesh that ends late
    assert window.panel.course is course
    window.put(knob)
    until(lambda: window.panel.course is not None and not window.jobs)


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


@pytest.fixture(scope="module")
def library(shapes):
    return learn(shapes)


@pytest.mark.parametrize("share", [0.0, 0.6, 0.9])
def test_the_board_hides_the_asked_share_and_another_peek_moves_it(library, shapes, share):
    course = Course(shapes["cone"], library.belief()).peek(share)
    view = render(shapes["cone"], CAMERA, size=(96, 96))
    is_object = view.face >= 0
    covered = (course.picture != view.rgb).any(axis=2)
    assert covered[is_object].mean() == pytest.approx(share, abs=0.03)
    assert (course.picture[covered] == BOARD).all()
    assert ((course.peek(share).picture == course.picture).all()) == (share == 0)


def test_a_peek_and_touches_name_a_cone(library, shapes):
    start = Course(shapes["cone"], library.belief())
    peeked = start.peek(0.6)
    assert peeked.belief.name == "cone" and (peeked.words, start.words) == ("after a peek", "")
    touched = peeked.touch(peeked.belief.next_touch())
    assert touched.belief.known == "cone" and touched.words == "after a peek and 1 touch"
    again = touched.peek(0.6)  # takes the place of the first peek, and keeps the touch
    fresh = replace(start, peeks=1).peek(0.6).touch(touched.belief.touches[0].approach)
    assert again.belief.log_weights == pytest.approx(fresh.belief.log_weights) and again.words == touched.words
    assert (again.peek(0.6).picture != again.picture).any()
    blind = start.touch(start.belief.next_touch())
    assert blind.touch(blind.belief.next_touch()).words == "after 2 touches"


def test_the_cells_of_a_touch_lie_on_the_mesh(library, shapes):
    """Looking down on the tip of a cone, from 0.6 above it: the middle is pressed, and the corners are lower."""
    tip = shapes["cone"].vertices[shapes["cone"].vertices[:, 2].argmax()]
    approach = library.approach(tip + [0, 0, 0.6], [0, 0, -1])
    (touch,) = Course(shapes["cone"], library.belief()).touch(approach).belief.touches
    felt = felt_by(touch, library, unit=40.0)
    places, pressed = felt.contacts
    assert len(places) and felt.span == (pytest.approx(40 * library.sensor.depth), 0.0)
    slope = np.ptp(shapes["cone"].vertices[:, 2]) / np.ptp(shapes["cone"].vertices[:, 0]) * 2
    height = tip[2] - slope * np.linalg.norm(places[:, :2] - tip[:2], axis=1)
    assert np.abs(places[:, 2] - height).max() < 0.03
    assert felt.pressed[3:5, 3:5].min() > 0.5 and felt.pressed[0, 0] < 0.15
    away = Course(shapes["cone"], library.belief()).touch(library.approach([0.8, 0, 0.9], [0, 0, -1]))
    missed = felt_by(away.belief.touches[0], library)
    assert np.isinf(missed.depths).all() and not missed.pressed.any()


def test_a_touch_that_meets_nothing_is_told_and_not_drawn(window):
    window.choose("Know")
    until(lambda: window.panel.course is not None and not window.jobs)
    panel = window.panel
    window.run("", panel.learn)
    assert panel.course is None and not window.scene.has("/know")
    until(lambda: not window.jobs)
    before = panel.course
    met, missed = (before.belief.library.approach([x, 0, 0.9], [0, 0, -1]) for x in (0, 0.8))
    window.run("", lambda: panel.advance(before, before.touch(met)))
    first = panel.course
    assert panel.grid.visible and window.scene.has("/know/felt/1")
    window.run("", lambda: panel.advance(first, first.touch(missed)))
    assert panel.about.content.startswith("Touch 2 met nothing. ") and not panel.grid.visible
    assert window.scene.has("/know/touched/1") and not window.scene.has("/know/touched/2")


def test_a_click_touches_the_place_along_its_normal_and_another_panel_draws_nothing(library, shapes):
    table = Specimen(shapes["box"], "box")
    hit = table.pick(np.array([2.0, 0.1, 0.05]), np.array([-1.0, 0, 0]))
    session = Session(table, kept={"Know": Course(table.mesh, library.belief())})
    window = SimpleNamespace(session=session, panel=None, work=lambda _, work, receiver, **__: receiver(work(None)))
    panel = KnowPanel(window)
    panel.on_click(hit)
    (touch,) = panel.course.belief.touches
    assert touch.contact == pytest.approx(hit.position, abs=0.01) and touch.approach.line == -1
    assert touch.approach.direction == pytest.approx([-1, 0, 0])
    session.kept = {}
    with pytest.raises(ValueError, match="still being learned"):
        panel.on_click(hit)
