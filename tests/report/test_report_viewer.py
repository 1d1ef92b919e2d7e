"""The turnable meshes of the page: what is packed, and what a browser shows of it."""

import base64
import io
import zlib
from string import Template

import numpy as np
import pytest
from PIL import Image

from haptic_glance.base.files import write_mesh
from haptic_glance.base.packing import SHADES, ordered
from haptic_glance.mesh.mesh import Mesh
from stages.report.page import FINEST, apart, pack_object, pack_viewer, part, script_json
from stages.report.site import page


@pytest.fixture
def levels(results, small):
    """The results with two levels of the ball; the coarser is pressed flat, the finer is the ball itself, sparser."""
    folder = results.data / "test/lod/ball"
    write_mesh(folder / "qem_25pct.npz", small.ball(8))
    flat = small.ball(6)
    write_mesh(folder / "qem_10pct.npz", Mesh(flat.vertices * [1, 1, 0.9], flat.faces))
    (folder / "qem_50pct.npz").unlink()
    return results


def shades(packed, where):
    store = np.frombuffer(zlib.decompress(base64.b64decode(packed["store"])), np.uint8).astype(np.int64)
    return store[where[0] : sum(where)].cumsum() % 256 / (SHADES - 1)


def test_error_is_the_distance_of_the_original_to_the_level(levels, small):
    packed = pack_object(levels, "ball")
    full = ordered(small.ball())[0]
    level = packed["ladders"]["qem"]["levels"][1]
    error = packed["error_top"] * shades(packed, level["error"]) ** 2
    top = full.vertices[:, 2].argmax()
    assert len(error) == len(full.vertices)
    assert error[top] == pytest.approx(min(100 * 0.05 / full.diagonal, packed["error_top"]), rel=0.04)
    assert level["error_max"] >= level["error_mean"] > 0


def test_levels_share_one_scale_on_which_the_error_grows(levels):
    packed = pack_object(levels, "ball")
    fine, coarse = (shades(packed, level["error"]) for level in packed["ladders"]["qem"]["levels"])
    assert coarse.mean() > fine.mean()
    assert coarse.max() == 1
    assert fine.max() < 1


def test_level_equal_to_the_original_has_no_error(results, small, monkeypatch):
    monkeypatch.setattr("stages.report.page.FINEST", 1.0)
    write_mesh(results.data / "test/lod/ball/qem_50pct.npz", small.ball())
    packed = pack_object(results, "ball")
    level = packed["ladders"]["qem"]["levels"][0]
    assert level["error_max"] == level["error_mean"] == 0
    assert packed["error_top"] < 1e-6


def test_levels_nearly_as_fine_as_the_original_are_left_out(results, small):
    write_mesh(results.data / "test/lod/ball/qem_90pct.npz", small.ball(11))
    faces = len(small.ball().faces)
    assert all(one["faces"] <= FINEST * faces for one in pack_object(results, "ball")["ladders"]["qem"]["levels"])


def test_levels_that_look_the_same_are_shown_once(small):
    levels = [small.ball(rings) for rings in (20, 19, 16, 15, 8)]
    shown = apart(levels)
    assert [len(mesh.faces) for mesh in shown] == [len(levels[k].faces) for k in (0, 2, 4)]
    assert apart([]) == []


class Page:
    """The viewer alone, in a browser."""

    def __init__(self, page):
        self.page, self.faults = page, []
        page.on("console", lambda message: self.faults.append(message.text))
        page.on("pageerror", lambda error: self.faults.append(str(error)))

    def caption(self):
        return self.page.locator("#viewer-right").inner_text()

    def slide(self, step):
        script = f"q = document.getElementById('level'); q.value = {step}; q.dispatchEvent(new Event('input'))"
        self.page.evaluate(script)

    def canvas(self):
        """(h, w, 3) what the canvas shows, without the captions."""
        script = "document.getElementById('canvas').toDataURL().split(',')[1]"
        return np.asarray(Image.open(io.BytesIO(base64.b64decode(self.page.evaluate(script)))).convert("RGB"))


@pytest.fixture(params=[1400, 390])
def shown(request, browser, levels, tmp_path):
    """The viewer of two objects, opened at a width."""
    yield from opened(browser, levels, tmp_path, request.param)


def opened(browser, results, tmp_path, width):
    front = Template(part("front.html"))
    parts = {"meshes": script_json(pack_viewer(results)), "viewer": part("viewer.html")}
    main = front.substitute(dict.fromkeys(front.get_identifiers(), "") | parts)
    (tmp_path / "page.html").write_text(page([], "", "", main, ["viewer.js", "site.js"]), encoding="utf-8")
    tab = browser.new_page(viewport={"width": width, "height": 900})
    found = Page(tab)
    tab.goto((tmp_path / "page.html").as_uri())
    tab.wait_for_function("document.getElementById('level').max > 0")
    yield found
    tab.close()


def halves(image):
    h, w = image.shape[:2]
    return (image[: h // 2], image[h // 2 :]) if h > 1.1 * w else (image[:, : w // 2], image[:, w // 2 :])


@pytest.mark.slow
def test_original_and_level_stand_side_by_side_and_turn_together(shown):
    before = halves(shown.canvas())
    assert all((half < 250).any(axis=2).mean() > 0.1 for half in before)
    shown.page.locator("#edges").check()
    wired = halves(shown.canvas())
    shown.page.locator("#canvas").press("ArrowUp")
    after = halves(shown.canvas())
    assert all((a != b).any() for a, b in zip(wired, after, strict=True))
    assert shown.page.evaluate("document.documentElement.scrollWidth") == shown.page.viewport_size["width"]
    assert not shown.faults


def test_slider_leads_from_the_original_to_more_and_more_error(shown):
    redness = []
    for step in (0, 1, 2):
        shown.slide(step)
        meshes = [half[(half < 250).any(axis=2)] for half in halves(shown.canvas().astype(int))]
        redness.append([float((mesh[:, 0] - mesh[:, 2]).mean()) for mesh in meshes])
    assert shown.caption().startswith("simplified: 120 faces")
    assert (np.diff(redness, axis=0) > 0).all()
    shown.slide(0)
    assert shown.caption().startswith("the original itself")
    assert not shown.faults


def test_faces_are_those_of_the_original_where_a_coarser_one_is_drawn(browser, levels, small, tmp_path):
    for found in opened(browser, small.results(levels.data.parent, viewer_faces=300), tmp_path, 1400):
        assert found.page.locator("#viewer-left").inner_text() == "ball, original: 528 faces (drawn with 300)"
        found.slide(1)
        assert found.caption().startswith("simplified: 120 faces (23 %)")


def test_one_can_look_at_saliency_and_shading_instead(shown):
    shown.page.locator("#points").select_option("")
    seen = [shown.canvas()]
    for choice in ("glance", ""):
        shown.page.locator("#colour").select_option(choice)
        seen.append(shown.canvas())
    assert (seen[0] != seen[1]).any() and (seen[1] != seen[2]).any()
    grey = seen[2].astype(int)
    assert np.abs(grey[..., 0] - grey[..., 1]).max() < 10
    assert shown.page.locator("#legend").is_hidden()
