"""The annotation page in a real browser: what a hand does to it, and what lies on disk afterwards."""

import shutil
import threading
from datetime import UTC, datetime

import numpy as np
import pytest
import trimesh

from stages.kit import Mesh, Viewpoint
from stages.meshes import normalise
from stages.weights.annotate import open_server, read_marks

playwright = pytest.importorskip("playwright.sync_api", reason="playwright drives the browser: pip install playwright")

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "microsoft-edge")
SOFTWARE_GL = ("--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")  # WebGL without a card
WIDE, NARROW = {"width": 900, "height": 620}, {"width": 390, "height": 844}
START = (305.0, 22.0)  # azimuth and elevation that the page opens with, degrees
FILL = 0.92  # of the picture's shorter side that the bounding sphere takes
TURN = 0.4  # degrees a pixel of dragging


@pytest.fixture(scope="module")
def browser():
    found = next((path for path in map(shutil.which, BROWSERS) if path), None)
    if not found:
        pytest.skip(f"no browser is installed: one of {', '.join(BROWSERS)}")
    with playwright.sync_playwright() as driver:
        opened = driver.chromium.launch(executable_path=found, args=SOFTWARE_GL)
        yield opened
        opened.close()


@pytest.fixture(scope="module")
def sphere():
    shape = trimesh.creation.icosphere(subdivisions=2)
    return normalise(Mesh(shape.vertices, shape.faces))


class Hand:
    """What a person does on the page of one mesh, in terms of its vertices."""

    def __init__(self, mesh, page, server):
        self.mesh, self.page, self.server = mesh, page, server
        self.azimuth, self.elevation = START

    def open(self):
        self.page.goto(f"http://127.0.0.1:{self.server.server_port}/")
        self.page.wait_for_selector("#canvas[aria-label*='320 faces']")
        self.page.wait_for_selector("#message:not(:empty), #name-dialog[open]")
        return self

    @property
    def middle(self):
        box = self.page.locator("#canvas").bounding_box()
        return np.array([box["x"] + box["width"] / 2, box["y"] + box["height"] / 2])

    def where(self, vertex):
        """Place of a vertex in the window, by the camera of the kit."""
        box = self.page.locator("#canvas").bounding_box()
        right, up, _ = Viewpoint(self.azimuth, self.elevation).axes @ self.mesh.vertices[vertex]
        return self.middle + FILL * min(box["width"], box["height"]) * np.array([right, -up])

    def facing(self, count):
        """Vertices that face the viewer, the most frontal first."""
        return np.argsort(-self.mesh.vertices @ Viewpoint(self.azimuth, self.elevation).axes[2])[:count].tolist()

    def click(self, vertex, away=(0, 0)):
        self.page.mouse.click(*(self.where(vertex) + away))

    def drag(self, right, down):
        self.page.mouse.move(*self.middle)
        self.page.mouse.down()
        self.page.mouse.move(*(self.middle + [right, down]), steps=5)
        self.page.mouse.up()
        self.azimuth, self.elevation = self.azimuth - TURN * right, self.elevation + TURN * down
        self.wait_for_paint()

    def wait_for_paint(self):
        """Waits until the picture is drawn."""
        self.page.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")

    @property
    def listed(self):
        return [int(row.get_attribute("data-vertex")) for row in self.page.locator("#points li").all()]

    def dot(self, place):
        """Middle of a numbered dot in the window."""
        self.wait_for_paint()
        box = self.page.locator("#dots span").nth(place).bounding_box()
        return np.array([box["x"] + box["width"] / 2, box["y"] + box["height"] / 2])

    def reads(self, part, text):
        playwright.expect(self.page.locator(part)).to_contain_text(text)


@pytest.fixture
def opened(browser, sphere, tmp_path):
    """opened(annotator="ann", viewport=WIDE, ...) -> Hand; every page must stay on this machine and free of errors."""
    servers, contexts, faults = [], [], []

    def make(annotator="ann", server=None, **options):
        server = server or open_server("ball", sphere, tmp_path / "marks", annotator)
        if server not in servers:
            servers.append(server)
            threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.02}, daemon=True).start()
        context = browser.new_context(**{"viewport": WIDE} | options)
        contexts.append(context)
        page = context.new_page()
        page.set_default_timeout(5000)
        page.on("pageerror", lambda error: faults.append(str(error)))
        page.on("request", lambda sent: "http://127.0.0.1:" in sent.url or faults.append(sent.url))
        return Hand(sphere, page, server).open()

    yield make
    for context in contexts:
        context.close()
    for server in servers:
        server.shutdown()
        server.server_close()
    assert not [fault for fault in faults if not fault.startswith("data:")]


@pytest.mark.slow
def test_points_land_on_the_vertices_under_the_pointer_before_and_after_turning(opened, sphere, tmp_path):
    begun = datetime.now(UTC)
    hand = opened()
    front = hand.facing(20)
    for vertex in (front[0], front[19]):
        hand.click(vertex, away=(4, -4))
    hand.drag(230, 60)
    side = [vertex for vertex in hand.facing(20) if vertex not in front]
    for vertex in (side[0], side[5]):
        hand.click(vertex)
    assert hand.listed == [front[0], front[19], side[0], side[5]]
    hand.page.click("#undo")
    hand.page.click("#save")
    hand.reads("#message", "Saved 3 points")
    found = read_marks(tmp_path / "marks" / "ball.csv")
    assert list(found.vertex) == [front[0], front[19], side[0]] and set(found.annotator) == {"ann"}
    assert np.allclose(found[["x", "y", "z"]], sphere.vertices[found.vertex], atol=5e-7)
    times = [datetime.fromisoformat(time) for time in found.time]
    assert begun.replace(microsecond=0) <= times[0] < times[1] < times[2] <= datetime.now(UTC)


@pytest.mark.slow
def test_numbered_dots_lie_where_their_vertices_are_and_fade_behind(opened):
    hand = opened()
    vertex = hand.facing(1)[0]
    hand.click(vertex, away=(5, 5))
    assert np.abs(hand.dot(0) - hand.where(vertex)).max() < 1
    assert hand.page.locator("#dots span").inner_text() == "1"
    hand.drag(-200, -90)
    assert np.abs(hand.dot(0) - hand.where(vertex)).max() < 1
    assert "hidden" not in hand.page.locator("#dots span").get_attribute("class")
    hand.drag(-250, 0)
    hand.wait_for_paint()
    assert "hidden" in hand.page.locator("#dots span").get_attribute("class")


@pytest.mark.slow
def test_clicks_beside_the_object_and_on_known_points_add_nothing(opened):
    hand = opened()
    vertex = hand.facing(1)[0]
    hand.page.mouse.click(*(hand.middle - [255, 0]))
    hand.reads("#message", "No point there")
    hand.click(vertex)
    hand.wait_for_paint()
    hand.click(vertex)
    hand.reads("#message", "Point 1 chosen")
    assert hand.listed == [vertex]


@pytest.mark.slow
def test_a_single_point_is_removed_and_undo_brings_it_back(opened, tmp_path):
    hand = opened()
    first, second, third = hand.facing(7)[::3]
    for vertex in (first, second, third):
        hand.click(vertex)
    hand.wait_for_paint()
    hand.click(second)
    hand.page.keyboard.press("Delete")
    assert hand.listed == [first, third]
    hand.page.get_by_role("button", name="Remove point 1").click()
    assert hand.listed == [third]
    hand.page.keyboard.press("Control+z")
    hand.page.keyboard.press("Control+z")
    assert hand.listed == [first, second, third]
    hand.page.keyboard.press("Control+s")
    hand.reads("#message", "Saved 3 points")
    found = read_marks(tmp_path / "marks" / "ball.csv")
    assert list(found.vertex) == [first, second, third] and list(found.time) == sorted(found.time)


@pytest.mark.slow
def test_leaving_asks_while_points_are_unsaved_and_reopening_loads_the_saved_ones(opened):
    hand = opened()
    asked = []
    hand.page.on("dialog", lambda dialog: (asked.append(dialog.type), dialog.accept()))
    kept, lost = hand.facing(4)[::3]
    hand.click(kept)
    hand.page.click("#save")
    hand.reads("#state", "all saved")
    hand.page.reload()
    hand.reads("#message", "1 point of ann loaded")
    assert hand.listed == [kept] and asked == []
    hand.wait_for_paint()
    hand.click(lost)
    hand.reads("#state", "not saved")
    hand.page.reload()
    hand.reads("#message", "1 point of ann loaded")
    assert hand.listed == [kept] and asked == ["beforeunload"]


@pytest.mark.slow
def test_the_page_asks_for_a_name_and_keeps_points_placed_before_it_is_given(opened, tmp_path):
    hand = opened("ann")
    first, second = hand.facing(4)[::3]
    hand.click(first)
    hand.page.keyboard.press("Control+s")
    hand.reads("#message", "Saved")
    hand = opened("")
    hand.page.click("#name-cancel")
    hand.click(second)
    hand.page.click("#save")
    hand.page.fill("#name", "ann")
    hand.page.keyboard.press("Enter")
    hand.reads("#message", "Saved 2 points")
    assert list(read_marks(tmp_path / "marks" / "ball.csv").vertex) == [first, second]


@pytest.mark.slow
def test_a_second_person_starts_afresh_and_leaves_the_first_ones_points(opened, tmp_path):
    hand = opened("ann")
    first, second = hand.facing(4)[::3]
    hand.click(first)
    hand.page.click("#save")
    hand.reads("#message", "Saved")
    hand.page.click("#change")
    hand.page.fill("#name", "bob")
    hand.page.keyboard.press("Enter")
    hand.reads("#who", "bob")
    assert hand.listed == []
    hand.wait_for_paint()
    hand.click(second)
    hand.page.click("#save")
    hand.reads("#message", "Saved 1 point")
    found = read_marks(tmp_path / "marks" / "ball.csv")
    assert list(zip(found.annotator, found.vertex, strict=True)) == [("ann", first), ("bob", second)]


@pytest.mark.slow
def test_two_windows_under_one_name_lose_nothing(opened, tmp_path):
    one = opened()
    other = opened(server=one.server)
    first, second = one.facing(4)[::3]
    one.click(first)
    one.page.click("#save")
    one.reads("#message", "Saved")
    other.click(second)
    other.page.click("#save")
    other.reads("#error", "saved meanwhile")
    assert list(read_marks(tmp_path / "marks" / "ball.csv").vertex) == [first]
    other.page.click("#save")
    other.reads("#message", "Saved 2 points")
    assert list(read_marks(tmp_path / "marks" / "ball.csv").vertex) == [first, second]


@pytest.mark.slow
def test_a_folder_that_cannot_be_written_is_shown_and_the_points_stay(opened, tmp_path):
    (tmp_path / "marks").write_text("a file where the folder should be")
    hand = opened()
    hand.reads("#error", "nothing can be saved")
    vertex = hand.facing(1)[0]
    hand.click(vertex)
    hand.page.click("#save")
    hand.reads("#error", "Not saved")
    hand.reads("#state", "not saved")
    assert hand.listed == [vertex]
    (tmp_path / "marks").unlink()
    hand.page.click("#save")
    hand.reads("#message", "Saved 1 point")
    assert hand.page.locator("#error").inner_text() == ""


@pytest.mark.slow
def test_a_damaged_file_is_shown_with_its_line_and_stays(opened, tmp_path):
    hand = opened()
    (tmp_path / "marks").mkdir()
    (tmp_path / "marks" / "ball.csv").write_text("annotator,time,vertex,x,y,z\nzoe,now")
    hand.click(hand.facing(1)[0])
    hand.page.click("#save")
    hand.reads("#error", "ball.csv, line 2")
    assert len(hand.listed) == 1 and (tmp_path / "marks" / "ball.csv").read_text().endswith("zoe,now")


@pytest.mark.slow
def test_points_stay_when_the_server_has_ended(opened):
    hand = opened()
    hand.click(hand.facing(1)[0])
    hand.server.shutdown()
    hand.server.server_close()
    hand.page.click("#save")
    hand.reads("#error", "start it again")
    assert len(hand.listed) == 1


@pytest.mark.slow
def test_the_wheel_zooms_about_the_pointer_and_reset_goes_back(opened):
    hand = opened()
    near, far = hand.facing(12)[::11]
    hand.click(near)
    hand.click(far)
    before = hand.dot(0), hand.dot(1)
    hand.page.mouse.move(*before[0])
    hand.page.mouse.wheel(0, -500)
    after = hand.dot(0), hand.dot(1)
    assert np.abs(after[0] - before[0]).max() < 2  # the browser rounds the pointer to whole pixels
    grown = np.linalg.norm(after[1] - after[0]) / np.linalg.norm(before[1] - before[0])
    assert grown == pytest.approx(np.exp(0.75), rel=0.02)
    hand.page.click("#reset")
    assert np.abs(hand.dot(1) - before[1]).max() < 1


@pytest.mark.slow
def test_fingers_pinch_and_tap(opened):
    hand = opened(viewport=NARROW, has_touch=True, is_mobile=True)
    near, far = hand.facing(12)[::11]
    for vertex in (near, far):
        hand.page.touchscreen.tap(*hand.where(vertex))
    assert hand.listed == [near, far]
    before = np.linalg.norm(hand.dot(1) - hand.dot(0))
    touch = hand.page.context.new_cdp_session(hand.page)
    for kind, reach in (("touchStart", 40), ("touchMove", 60), ("touchMove", 80), ("touchEnd", 0)):
        fingers = [{"x": hand.middle[0] + side * reach, "y": hand.middle[1], "id": side} for side in (-1, 1)]
        points = [finger | {"id": k} for k, finger in enumerate(fingers)] if reach else []
        touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})
    assert np.linalg.norm(hand.dot(1) - hand.dot(0)) == pytest.approx(2 * before, rel=0.03)
    assert hand.listed == [near, far]


@pytest.mark.slow
def test_keys_alone_turn_mark_and_save(opened, tmp_path):
    hand = opened()
    hand.page.locator("#canvas").focus()
    for _ in range(5):
        hand.page.keyboard.press("ArrowLeft")
    hand.page.keyboard.press("ArrowUp")
    hand.azimuth, hand.elevation = START[0] + 40, START[1] - 8
    hand.wait_for_paint()
    hand.page.keyboard.press("Enter")
    hand.page.keyboard.press("Control+s")
    hand.reads("#message", "Saved 1 point")
    assert list(read_marks(tmp_path / "marks" / "ball.csv").vertex) == hand.facing(1)


@pytest.mark.slow
def test_a_narrow_window_shows_everything_without_scrolling_sideways(opened):
    hand = opened(viewport=NARROW)
    for vertex in hand.facing(12):
        hand.click(vertex)
    hand.wait_for_paint()
    assert hand.page.evaluate("document.documentElement.scrollWidth") <= NARROW["width"]
    for button in hand.page.locator("main button").all():
        box = button.bounding_box()
        assert box["x"] >= 0 and box["x"] + box["width"] <= NARROW["width"] and box["height"] >= 24


@pytest.mark.slow
def test_every_control_has_a_name(opened):
    hand = opened()
    hand.click(hand.facing(1)[0])
    for control in hand.page.locator("button, input, canvas").all():
        named = (
            control.get_attribute("aria-label") or control.inner_text() or control.evaluate("(e) => e.labels?.length")
        )
        assert named, control.evaluate("(e) => e.outerHTML")
