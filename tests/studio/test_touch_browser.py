"""Touching and knowing in a real browser: a click, a slider, a path, and a mystery to its end."""

import shutil

import numpy as np
import pytest

from haptic_glance.studio.app import Studio
from haptic_glance.studio.session import Settings
from haptic_glance.studio.specimen import Hit

from .conftest import ball

playwright = pytest.importorskip("playwright.sync_api", reason="playwright drives the browser: pip install playwright")
pytestmark = pytest.mark.slow

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "microsoft-edge")
SOFTWARE_GL = ("--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")  # WebGL without a card
PATIENCE = 40_000  # milliseconds, on a machine with other work


@pytest.fixture(scope="module")
def studio(tmp_path_factory):
    folder = tmp_path_factory.mktemp("touched")
    ball().export(folder / "knob.ply")
    with pytest.MonkeyPatch.context() as patch:  # what `make repro` may have left in data/ is not among the known
        patch.setattr("haptic_glance.studio.panels.know.HOUSEHOLD", folder / "nothing")
        opened = Studio(Settings([folder / "knob.ply"], panel="Touch"))
        yield opened
        opened.stop()


@pytest.fixture(scope="module")
def page(studio):
    found = next((path for path in map(shutil.which, BROWSERS) if path), None)
    if not found:
        pytest.skip(f"no browser is installed: one of {', '.join(BROWSERS)}")
    faults = []
    with playwright.sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=found, args=SOFTWARE_GL)
        opened = browser.new_page(viewport={"width": 800, "height": 560})
        opened.set_default_timeout(PATIENCE)
        opened.on("pageerror", lambda error: faults.append(str(error)))
        opened.goto(studio.address)
        yield opened
        browser.close()
    assert not faults


def dismiss_messages(page):
    """Closes the messages over the canvas, which would catch clicks on its middle."""
    for button in reversed(page.locator("[class*=Notification-closeButton]").all()):
        button.click()


def click(page, right=0, down=0):
    """A click on the canvas, so many pixels beside its middle."""
    box = page.locator("canvas").first.bounding_box()
    page.mouse.click(box["x"] + box["width"] / 2 + right, box["y"] + box["height"] / 2 + down)


def click_until(page, found, right=0, down=0):
    """Clicks until something appears: a page that is still drawing its first picture misses a click."""
    for _ in range(PATIENCE // 2000):
        click(page, right, down)
        try:
            found.first.wait_for(timeout=2000)
            return
        except playwright.TimeoutError:
            continue
    raise AssertionError("the click was not answered")


def reads(page, text):
    playwright.expect(page.get_by_text(text).first).to_be_visible(timeout=PATIENCE)


def panel(page, title):
    page.get_by_role("button", name=title, exact=True).click()


def test_a_click_shows_what_is_felt_and_a_slider_changes_it(page):
    reads(page, "knob")
    reads(page, "Click the mesh: the array is pressed there.")
    grid = page.locator("img.grid")
    click_until(page, grid)
    playwright.expect(grid).to_have_attribute("width", "16", timeout=PATIENCE)
    before = grid.get_attribute("src")
    page.get_by_role("slider").first.focus()
    page.keyboard.press("ArrowRight")
    playwright.expect(grid).to_have_attribute("width", "17", timeout=PATIENCE)
    assert grid.get_attribute("src") != before
    reads(page, "17 x 17 cells")
    assert float(page.locator(".low").inner_text()) > 0 == float(page.locator(".high").inner_text())


def test_a_path_plays_to_its_end_and_one_that_leaves_the_mesh_is_refused(page, studio):
    panel(page, "Path")
    reads(page, "Click two or more places")
    click(page, -40)
    click(page, 40, 20)
    reads(page, "2 places")
    page.get_by_role("button", name="Play", exact=True).wait_for()  # it was Pause while it played
    reads(page, "frame 25 of 25")
    ((_, window),) = studio.windows.values()
    path = next(one for one in window.panels if one.title == "Path")
    front = path.places[0]
    beside = Hit(0, 0, front.position + 3 * np.cross(front.normal, [0, 0, 1]), front.normal)  # across a gap
    window.run("", lambda: path.on_click(beside))
    reads(page, "leaves the mesh between places 2 and 3")
    assert len(path.places) == 2


def test_a_mystery_to_its_end(page, studio):
    panel(page, "Know")
    page.locator('.bar[data-name="knob"]').wait_for()
    page.get_by_role("button", name="Mystery object").click()
    reads(page, "An object hides in the ball")
    ((_, window),) = studio.windows.values()
    know, scene = window.panel, window.scene
    assert know.guess.hidden and not scene.has("/mesh") and not scene.has("/know/shown")
    name = know.guess.name
    for down in (0, 25, 50, 75, -25, -50):  # of a torus the middle is empty
        dismiss_messages(page)
        click(page, 0, down)
        for _ in range(50):  # a slow answer is no miss: another click would be another touch
            if know.guess.touches:
                break
            page.wait_for_timeout(100)
        if know.guess.touches:
            break
    by_hand = know.guess.touches
    assert by_hand > 0 and know.guess.helped == 0
    told = page.get_by_text("the planner alone").or_(page.get_by_text("Not sure after"))
    playwright.expect(told.first).to_be_visible(timeout=PATIENCE)  # a first touch may name the object already
    if not know.guess.over:
        page.get_by_role("button", name="Touch next").click()
        told = page.get_by_text("the planner alone").or_(page.get_by_text(f"after {by_hand + 1} touches"))
        playwright.expect(told.first).to_be_visible(timeout=PATIENCE)
    if not know.guess.over:
        page.get_by_role("button", name="Touch until it is known").click()
    reads(page, "the planner alone")
    reads(page, f"It is {name}.")
    assert scene.has("/know/shown") and know.guess.over
    shown = {bar.get_attribute("data-name") for bar in page.locator(".bar").all()}
    assert shown == {*know.guess.exploration.library.names}
    panel(page, "Look")
    page.wait_for_timeout(500)
    assert scene.has("/mesh") and not scene.has("/know")
