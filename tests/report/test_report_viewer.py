"""The turnable meshes of the page: what is packed, and what a browser shows of it."""

import base64
import shutil
import zlib
from string import Template

import numpy as np
import pytest

from haptic_glance.base.files import read_arrays, write_arrays, write_mesh
from haptic_glance.base.packing import SHADES, STEPS, Store, ordered, viewer_data
from haptic_glance.gallery.viewer import as_script
from haptic_glance.mesh.mesh import Mesh
from stages.report.site import page_file, page_html
from stages.report.viewer import FINEST, apart, pack_object, pack_viewer


class Reader:
    """Reads an object as page/viewer.js does."""

    def __init__(self, text):
        self.store = np.frombuffer(zlib.decompress(base64.b64decode(text)), np.uint8).astype(np.int64)

    def words(self, where):
        at, count = where
        return self.store[at : at + count] | (self.store[at + count : at + 2 * count] << 8)

    def positions(self, where):
        steps = self.words(where).reshape(-1, 3).cumsum(axis=0) % 65536
        return np.where(steps > 32767, steps - 65536, steps) / (2 * STEPS)

    def ids(self, where):
        return self.words(where).cumsum() % 65536

    def shades(self, where):
        return self.store[where[0] : sum(where)].cumsum() % 256 / (SHADES - 1)

    def triangles(self, where):
        following, ids = 0, []
        for below in self.words(where):
            ids.append(following - below)
            following += below == 0
        return np.array(ids).reshape(-1, 3)


def test_packed_mesh_reads_back(small):
    mesh = ordered(small.ball())[0]
    store = Store()
    values = np.random.default_rng(0).random(len(mesh.vertices))
    places = [store.put_positions(mesh.vertices), store.put_triangles(mesh.faces), store.put_shades(values)]
    numbers = np.array([5, 60000, 0, 65535])
    ids = store.put_words(numbers)
    reader = Reader(store.text())
    assert np.abs(reader.positions(places[0]) - mesh.vertices).max() <= 0.5 / (2 * STEPS) + 1e-12
    assert (reader.triangles(places[1]) == mesh.faces).all()
    assert np.abs(reader.shades(places[2]) - values).max() <= 0.5 / (SHADES - 1) + 1e-12
    assert (reader.ids(ids) == numbers).all()


def test_ordering_keeps_the_surface_and_leaves_unused_vertices_out(small):
    mesh = small.ball()
    reordered, ids = ordered(mesh)
    assert np.array_equal(reordered.vertices, mesh.vertices[ids])
    corners = lambda m: sorted(map(tuple, np.sort(m.vertices[m.faces].round(9), axis=1).reshape(-1, 9)))  # noqa: E731
    assert corners(reordered) == corners(mesh)
    assert reordered.face_areas.sum() == pytest.approx(mesh.face_areas.sum())
    extra = type(mesh)(np.vstack([[[0, 0, 0]], mesh.vertices]), mesh.faces + 1)
    assert 0 not in ordered(extra)[1]


def test_objects_that_do_not_fit_are_named(results, small):
    size = len(pack_viewer(results)["objects"][0]["store"]) / 1000
    tight = small.read_results(results.data.parent, viewer_kilobytes=int(1.5 * size))
    packed = pack_viewer(tight)
    assert [entry["name"] for entry in packed["objects"]] == ["ball"]
    assert packed["left_out"] == ["cube"]


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
    return Reader(packed["store"]).shades(where)


def test_error_is_the_distance_of_the_original_to_the_level_on_one_scale_of_all_levels(levels, small):
    packed = pack_object(levels, "ball")
    fine, coarse = (shades(packed, level["error"]) for level in packed["ladders"]["qem"]["levels"])
    assert coarse.mean() > fine.mean() and coarse.max() == 1 > fine.max()
    full = ordered(small.ball())[0]
    level = packed["ladders"]["qem"]["levels"][1]
    error = packed["error_top"] * shades(packed, level["error"]) ** 2
    top = full.vertices[:, 2].argmax()
    assert len(error) == len(full.vertices)
    assert error[top] == pytest.approx(min(100 * 0.05 / full.diagonal, packed["error_top"]), rel=0.04)
    assert level["error_max"] >= level["error_mean"] > 0


def test_level_equal_to_the_original_has_no_error_and_levels_nearly_as_fine_are_left_out(results, small, monkeypatch):
    write_mesh(results.data / "test/lod/ball/qem_90pct.npz", small.ball(11))
    faces = [level["faces"] for level in pack_object(results, "ball")["ladders"]["qem"]["levels"]]
    assert max(faces) <= FINEST * len(small.ball().faces)
    monkeypatch.setattr("stages.report.viewer.FINEST", 1.0)
    write_mesh(results.data / "test/lod/ball/qem_90pct.npz", small.ball())
    packed = pack_object(results, "ball")
    level = packed["ladders"]["qem"]["levels"][0]
    assert level["error_max"] == level["error_mean"] == 0


def test_levels_that_look_the_same_are_shown_once(small):
    levels = [small.ball(rings) for rings in (20, 19, 16, 15, 8)]
    shown = apart(levels)
    assert [len(mesh.faces) for mesh in shown] == [len(levels[k].faces) for k in (0, 2, 4)]
    assert apart([]) == []


def test_page_offers_few_methods_and_any_where_none_of_those_ran(seen, tmp_path, small):
    assert list(pack_viewer(seen)["objects"][0]["saliency"]) == ["glance", "itti"]
    root = shutil.copytree(seen.workspace.root, tmp_path / "root")
    for path in (root / "data/test/salient_points").glob("*.npz"):
        write_arrays(path, **{key: values for key, values in read_arrays(path).items() if key.startswith("height")})
    assert list(pack_viewer(small.read_results(root))["objects"][0]["saliency"]) == ["height"]


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


WIDE, NARROW = 1400, 390


@pytest.fixture
def shown(request, browser, levels, tmp_path):
    """The viewer of two objects, opened at a width."""
    yield from opened(browser, levels, tmp_path, getattr(request, "param", WIDE))


def opened(browser, results, tmp_path, width):
    front = Template(page_file("front.html"))
    parts = {"meshes": as_script(pack_viewer(results)), "viewer": page_file("viewer.html")}
    main = front.substitute(dict.fromkeys(front.get_identifiers(), "") | parts)
    (tmp_path / "page.html").write_text(page_html({}, "", "Page", "", main, ["viewer.js", "site.js"]), encoding="utf-8")
    tab = browser.new_page(viewport={"width": width, "height": 900})
    viewer = Page(tab)
    tab.goto((tmp_path / "page.html").as_uri())
    tab.wait_for_function("document.getElementById('level').max > 0")
    yield viewer
    tab.close()


@pytest.mark.slow
@pytest.mark.parametrize("shown", [WIDE, NARROW], indirect=True)
def test_slider_leads_from_the_original_to_fewer_faces(shown):
    shown.slide(2)
    assert shown.caption().startswith("simplified: 120 faces")
    shown.slide(0)
    assert shown.caption().startswith("the original itself")
    assert shown.page.evaluate("document.documentElement.scrollWidth") == shown.page.viewport_size["width"]
    assert not shown.faults


def test_a_larger_error_is_darker_for_every_eye():
    shades = viewer_data([], np.zeros((SHADES, 3)), [])["colours"]
    errors = np.frombuffer(base64.b64decode(shades), np.uint8).reshape(-1, 3)[SHADES:]
    luminance = (errors / 255) ** 2.2 @ [0.2126, 0.7152, 0.0722]
    assert len(errors) == SHADES and (np.diff(luminance) < 0).all()
