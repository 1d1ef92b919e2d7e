"""The page and the stage as a whole."""

import base64
import io
import json
import re
import zlib
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from PIL import Image

from haptic_glance.base.files import write_mesh, write_text
from haptic_glance.base.packing import SHADES, STEPS, Store, ordered
from haptic_glance.look.camera import Viewpoint
from haptic_glance.mesh.mesh import Mesh
from stages.report.__main__ import dataset_line, write_report
from stages.report.drawing import VIEWPOINT, picture, visible
from stages.report.items import Built, Table
from stages.report.page import item_html, pack_viewer, prose, small_picture
from stages.report.results import NotRun
from stages.report.site import front_main

pytestmark = pytest.mark.slow


OLD, OTHERS = "tables/gone.csv", "bench/pipeline.csv"  # results of an earlier run, and of what is no report
OLD_PAGE = "site/gone.html"
ODD = "<b>&qem</b>"


@pytest.fixture(scope="module")
def run(tmp_path_factory, small):
    """The root of a small run with a report; a method has an odd name, and marks are of a set that is switched off."""
    root = small.root(tmp_path_factory.mktemp("run"))
    for name in (OLD, OLD_PAGE, OTHERS):
        write_text(root / "reports" / name, "old")
    small.write(root, "lod", pd.concat([small.lod(), small.lod().assign(method=ODD)]))
    small.write(root, "annotations", small.agreed_marks(), "elsewhere")
    write_report(small.results(root))
    return root


@pytest.fixture(scope="module")
def front(run):
    """The text of the front page of the small run."""
    return (run / "reports/index.html").read_text()


@pytest.fixture(scope="module")
def pages(run):
    """{path: text} of all pages of the small run."""
    paths = [run / "reports/index.html", *sorted((run / "reports/site").glob("*.html"))]
    return {path: path.read_text() for path in paths}


@pytest.fixture(scope="module")
def own(tmp_path_factory, small):
    """The results of a run on a folder of one's own, with its report."""
    root = small.root(tmp_path_factory.mktemp("own"))
    text = (root / "params.yaml").read_text() + "test: {meshes: {source: folder}}\n"
    (root / "params.yaml").write_text(text)
    small.write(root, "lod", small.lod(), "elsewhere")
    results = small.results(root)
    write_report(results)
    return results


class Reader:
    """What page/viewer.js does to read an object."""

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
    reader, ids = None, store.put_words(numbers)
    reader = Reader(store.text())
    assert np.abs(reader.positions(places[0]) - mesh.vertices).max() <= 0.5 / (2 * STEPS) + 1e-12
    assert (reader.triangles(places[1]) == mesh.faces).all()
    assert np.abs(reader.shades(places[2]) - values).max() <= 0.5 / (SHADES - 1) + 1e-12
    assert (reader.ids(ids) == numbers).all()


def test_ordering_keeps_the_surface(small):
    mesh = small.ball()
    found, ids = ordered(mesh)
    assert np.array_equal(found.vertices, mesh.vertices[ids])
    corners = lambda m: sorted(map(tuple, np.sort(m.vertices[m.faces].round(9), axis=1).reshape(-1, 9)))  # noqa: E731
    assert corners(found) == corners(mesh)
    assert found.face_areas.sum() == pytest.approx(mesh.face_areas.sum())


def test_ordering_leaves_unused_vertices_out(small):
    mesh = small.ball()
    extra = type(mesh)(np.vstack([[[0, 0, 0]], mesh.vertices]), mesh.faces + 1)
    assert 0 not in ordered(extra)[1]


def test_objects_that_do_not_fit_are_named(results, small):
    size = len(pack_viewer(results)["objects"][0]["store"]) / 1000
    tight = small.results(results.data.parent, viewer_kilobytes=int(1.5 * size))
    packed = pack_viewer(tight)
    assert [one["name"] for one in packed["objects"]] == ["ball"]
    assert packed["left_out"] == ["cube"]


def test_pages_ask_nothing_of_the_network(pages):
    for text in pages.values():
        assert not re.findall(r'(?:src|href)="(?!data:image/)[a-z]+:[^"]*"', text)
        assert "@import" not in text and not re.findall(r"url\((?!#)", text)


def test_pages_are_accessible(pages):
    for text in pages.values():
        assert '<html lang="en">' in text
        assert all(re.search(r'alt="[^"]{20,}"', image) for image in re.findall(r"<img[^>]*>", text))
        assert all(re.search(r'aria-label="[^"]{20,}"', chart) for chart in re.findall(r"<svg[^>]*chart[^>]*>", text))
        ids = re.findall(r'<[^>]* id="([^"]+)"', text)
        assert len(ids) == len(set(ids))
        levels = [int(level) for level in re.findall(r"<h(\d)", text)]
        assert levels[0] == 1 and levels.count(1) == 1


def test_links_lead_to_files_and_places(pages):
    for path, text in pages.items():
        for link in re.findall(r'href="([^"]+)"', re.sub(r"<svg.*?</svg>", "", text, flags=re.DOTALL)):
            name, _, place = link.partition("#")
            target = (path.parent / name).resolve() if name else path
            assert target.exists(), link
            assert not place or f'id="{place}"' in target.read_text(), link


def test_every_page_leads_to_every_other(pages):
    for path, text in pages.items():
        nav = re.search(r'<nav aria-label="Pages">(.*?)</nav>', text)[1]
        assert {(path.parent / link).resolve() for link in re.findall(r'href="([^"]+)"', nav)} == set(pages)
        assert nav.count('aria-current="page"') == 1


def test_a_page_that_there_is_no_longer_is_removed(run, pages):
    assert not (run / "reports" / OLD_PAGE).exists() and len(pages) > 3


def test_the_front_page_carries_the_meshes(front):
    data = json.loads(re.search(r'id="mesh-data">(.*?)</script>', front, re.DOTALL)[1].replace("<\\/", "</"))
    assert [one["name"] for one in data["objects"]] == ["ball", "cube"]
    assert list(data["objects"][0]["ladders"]) == ["qem"]


def test_verdicts_are_counted_beside_the_claims(run):
    said = re.search(r"Sentences of the thesis .*rate of 5 %\.", (run / "reports/claims.md").read_text())[0]
    claims = pd.read_csv(run / "reports/claims.csv")
    supported = (claims["verdict"] == "supported").sum()
    assert f"that test a sentence elsewhere ({len(claims)}): {supported} supported" in said
    assert f"<p>{said}</p>" in (run / "reports/site/claims.html").read_text()


def test_equal_runs_give_equal_bytes_with_any_number_of_workers(run, small):
    files = sorted(path for path in (run / "reports").rglob("*") if path.is_file())
    before = [path.read_bytes() for path in files]
    params = run / "params.yaml"
    params.write_text(params.read_text().replace("backend: sequential", "backend: loky, workers: 2"))
    write_report(small.results(run))
    assert [path.read_bytes() for path in files] == before


def test_old_results_go_and_those_of_others_stay(run):
    assert not (run / "reports" / OLD).exists()
    assert (run / "reports" / OTHERS).exists()


def test_nothing_measured_is_listed_and_no_error(bare, small, capsys):
    write_report(small.results(bare))
    said = capsys.readouterr().out
    assert "tables/table_4_1 not run" in said and "dvc repro classification" in said
    text = (bare / "reports/index.html").read_text()
    assert "<p>not run: no data/SET/salient_points" in text and "no data/SET/meshes" in text


def readable(text):
    """What a page says, without code, scripts and names of files."""
    kinds = r"<(script|style|code|option)\b.*?</\1>|<a [^>]*download>.*?</a>|<[^>]*>"
    return re.sub(kinds, " ", text, flags=re.DOTALL)


def test_no_page_shows_literal_backticks(pages):
    assert not [path.name for path, text in pages.items() if "`" in readable(text)]


def test_no_table_has_raw_labels(pages):
    for path, text in pages.items():
        if path.stem != "fidelity":  # whose tables name functions and files
            cells = re.findall(r"<t[dh][^>]*>([^<]*)<", text)
            assert not [cell for cell in cells if re.search(r"\b[a-z]+_[a-z_0-9]+\b", cell)], path.name


def test_names_from_data_are_escaped(pages):
    assert not any(ODD in text for text in pages.values())
    assert any("&lt;b&gt;&amp;qem&lt;/b&gt;" in text for text in pages.values())


def test_a_mesh_drawn_again_looks_as_if_drawn_alone_and_no_ray_at_its_rim_is_left_out(small):
    ball = small.ball()
    mesh, values = Mesh(0.3 * ball.vertices, ball.faces), np.random.default_rng(0).random(len(ball.vertices))
    wide = Mesh(np.vstack([mesh.vertices, [[0.4] * 3, [-0.4] * 3]]), mesh.faces)  # rays all round
    for given in ({}, {"values": values}, {"wires": True}, {"viewpoint": Viewpoint(20, 50)}, {"smoothing": 1}, {}):
        found = picture(mesh, rows=60, **given)
        for other in (wide, Mesh(mesh.vertices, mesh.faces)):
            assert np.array_equal(found, picture(other, rows=60, **given)), given


def test_picture_is_white_off_the_object_only(small):
    image = picture(small.ball(), rows=60)
    off = np.hypot(*(np.mgrid[:60, :60] - 29.5)) > 30
    assert (image[off] == 1).all()
    assert (image[30, 30] < 1).all()


def test_points_behind_the_object_are_hidden(small):
    mesh = small.ball()
    towards = mesh.vertices @ VIEWPOINT.axes[2]
    down, across = visible(mesh, np.array([towards.argmax(), towards.argmin()]), rows=60)
    assert len(down) == len(across) == 1
    assert abs(down[0] - 29.5) < 6


def test_the_head_of_the_page_names_the_data_set_of_the_meshes(root, small):
    write_mesh(root / "data/furniture/meshes/chair.npz", small.ball())
    assert dataset_line(small.results(root)).endswith("2 objects of the data set test")  # the first that is switched on


def test_a_folder_of_ones_own_has_a_page_about_it_alone(own):
    assert own.own_meshes and own.datasets("lod") == ["test"]
    with pytest.raises(NotRun, match="not switched on"):
        own.rows("lod", "elsewhere")
    page = (own.reports / "index.html").read_text()
    assert "Your meshes" in page and all(f"<h2>{name}</h2>" in page for name in own.objects)
    assert all((own.reports / address).exists() for address in re.findall(r'href="(site/[^"]+)"', page))
    assert "units of the object&#x27;s diameter" in page and "Touched there" in page
    assert pd.read_csv(own.reports / "claims.csv")["pairs"].gt(0).all()


def test_what_was_measured_on_sets_that_are_off_is_set_apart(pages):
    apart = [found for text in pages.values() for found in re.findall(r"<p>Not part of this run: (.*?)\.</p>", text)]
    assert "elsewhere" in apart


def test_a_picture_of_many_colours_is_shrunk(tmp_path):
    noise = np.random.default_rng(0).integers(0, 255, (400, 1200, 3), dtype=np.uint8)
    Image.fromarray(noise).save(tmp_path / "noise.png")
    shown = Image.open(io.BytesIO(base64.b64decode(small_picture(tmp_path / "noise.png"))))
    assert shown.size == (900, 300)


def test_code_in_notes_is_marked_up_and_not_shown_with_its_backticks():
    assert prose("`a<b` and ` alone") == "<code>a&lt;b</code> and ` alone"
    table = Table(pd.DataFrame({"x": [1]}), notes=["see `stages.compose`"], paths=[Path("tables/t.csv")])
    assert "<li>see <code>stages.compose</code></li>" in item_html(table)


@pytest.mark.parametrize(("cell", "whole"), [("not run · 3", False), ("3", True)])
def test_a_table_with_gaps_is_listed_among_what_was_not_run(cell, whole):
    table = Table(pd.DataFrame({"x": [cell]}), name="gaps", topic="none", paths=[Path("tables/t.csv")])
    parts = {kind: Built() for kind in ("figures", "tradeoff")} | {"tables": Built([table]), "claims": pd.DataFrame()}
    parts |= {"first": [], "not_run": {}, "meshes": None, "own": True, "dataset": ""}
    page = front_main(parts, {}, {}, Path("reports"))
    assert ("Everything that this report knows was measured" in page) == whole
    assert ("<code>tables/gaps</code>: in part" in page) != whole
