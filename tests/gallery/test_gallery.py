"""`haptic-glance gallery` and `demo`: what is made of each mesh, and what the page shows."""

import base64
import io
import json
import re
import zlib
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import replace

import numpy as np
import pytest
import trimesh

from haptic_glance.base.packing import ordered
from haptic_glance.cli import saliency
from haptic_glance.cli.simplify import run as simplify
from haptic_glance.cli.touch import run as touch
from haptic_glance.gallery import command
from haptic_glance.gallery.command import run
from haptic_glance.gallery.exhibit import exhibit
from haptic_glance.gallery.page import turnable
from haptic_glance.gallery.viewer import as_script, show
from haptic_glance.lod import vertex_errors
from haptic_glance.mesh import load, rotate_to_z_up
from tests.shapes import flat_grid

pytestmark = pytest.mark.slow


def pear(path, size=1.0):
    body = trimesh.creation.icosphere(3)
    x, y, z = body.vertices.T
    body.vertices *= (1 + 0.5 * np.exp(-8 * ((z - 1) ** 2 + x**2)))[:, None] * [size, size, size]
    body.vertices += [30, 4, -7]
    body.export(path)


def make_scans(folder):
    """A folder of two meshes, a broken one and a text."""
    (folder / "scans").mkdir()
    pear(folder / "scans/pear.ply")
    pear(folder / "scans/pear & co.stl", 50)
    (folder / "scans/broken.obj").write_text("v 1 2\n")
    (folder / "scans/notes.txt").write_text("no mesh")
    return folder / "scans"


def gallery(meshes, out, *options):
    """Makes the gallery; returns (exit status, page, standard output, standard error)."""
    with redirect_stdout(io.StringIO()) as printed, redirect_stderr(io.StringIO()) as reported:
        status = run([str(meshes), "--out", str(out), *options])
    return status, (out / "index.html").read_text("utf-8"), printed.getvalue(), reported.getvalue()


@pytest.fixture
def scans(tmp_path):
    return make_scans(tmp_path)


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The gallery of the scans without options: (folder, exit status, page, standard output, standard error)."""
    folder = tmp_path_factory.mktemp("whole")
    return folder / "out", *gallery(make_scans(folder), folder / "out")


def page_data(page):
    return json.loads(re.search(r'id="mesh-data">(.*?)</script>', page)[1])


def test_a_broken_file_is_named_and_the_rest_goes_on(whole):
    out, status, page, printed, reported = whole
    assert status == 1 and "broken.obj is left out: " in reported
    assert reported.splitlines()[-1].endswith("1 of 3 are left out: broken.obj")
    assert re.search(r"Left out:<ul><li>broken.obj: ", page) and "notes" not in page
    assert [item["name"] for item in page_data(page)["objects"]] == ["pear & co", "pear"]
    assert "<h2>pear &amp; co</h2>" in page and printed.count("6 places, 3 levels, 6 imprints") == 2
    levels = {f"pear_{share}pct.ply" for share in (50, 25, 10)}
    made = {path.name for path in (out / "pear").iterdir()}
    assert made == levels | {"saliency.ply", "points.csv", "imprints.npz", "places.csv"}


def test_the_page_needs_nothing_but_itself_and_claims_nothing(whole):
    out, _, page, _, _ = whole
    assert not re.search(r'(src|href)="(https?:)?//', page) and "@import" not in page
    assert "$" not in re.sub(r"<script>.*?</script>", "", page, flags=re.S)  # every placeholder is filled
    links = [link.replace("%20", " ").replace("%26", "&") for link in re.findall(r'href="([^#"][^"]*)"', page)]
    assert links and all((out / link).is_file() for link in links)
    text = re.sub(r"<(style|script)\b.*?</\1>|base64,[\w+/=]+", "", page, flags=re.S)
    assert not re.search("supported|contradicted|claim|household|duck", text, re.I)


def test_a_notebook_shows_a_mesh_in_its_own_colours_on_a_light_page_of_its_own(scans):
    mesh = load(scans / "pear.ply")
    for values in (None, mesh.vertices[:, 2] + 8):
        page = show(replace(mesh, colors=np.full((len(mesh.vertices), 3), 90, np.uint8)), values).html
        (item,) = page_data(page)["objects"]
        assert not re.search(r'(src|href)="', page) and len(page) < 60_000 and item["faces"] == 1280
        store = np.frombuffer(zlib.decompress(base64.b64decode(item["store"])), np.uint8)
        at, count = item["tints"]
        assert (store[at : at + count].reshape(-1, 3).cumsum(axis=0, dtype=np.uint8) == 90).all()
        assert list(item["saliency"]) == ([] if values is None else ["values"]) and not item["ladders"]
    assert "tints" not in page_data(show(mesh).html)["objects"][0]
    with pytest.raises(ValueError, match="finite and 0 or more"):
        show(mesh, mesh.vertices[:, 2])


def test_the_same_comes_of_the_three_commands_that_it_names(scans, capsys):
    out, mesh = scans.parent, str(scans / "pear.ply")
    _, page, _, _ = gallery(scans / "pear.ply", out / "out", "--count", "4", "--levels", "300,10%")
    named = re.findall(r"haptic-glance (\w+) YOUR_MESH.stl ([^<\n]*)", page)
    assert [name for name, _ in named] == ["saliency", "simplify", "touch"]
    for (_, options), work in zip(named, (saliency.run, simplify, touch), strict=True):
        work([mesh, *re.sub(r"(--out|--points) ", rf"\1 {out}/", options).split()])
    ours = out / "out/pear"
    assert (out / "points.csv").read_text() == (ours / "points.csv").read_text()
    assert np.array_equal(load(out / "saliency.ply").colors, load(ours / "saliency.ply").colors)
    for name in ("pear_300.ply", "pear_10pct.ply"):
        assert np.array_equal(load(out / "levels" / name).vertices, load(ours / name).vertices)
    with np.load(out / "touched/imprints.npz") as alone, np.load(ours / "imprints.npz") as together:
        order = [list(alone["vertices"]).index(vertex) for vertex in together["vertices"]]
        assert np.allclose(alone["images"][order], together["images"], atol=1e-5)


def test_what_turns_on_the_page_is_the_mesh_with_its_levels(whole):
    _, item = page_data(whole[2])["objects"]
    assert item["faces"] == item["full"]["faces"] == 1280 and item["points"]["glance"]["ids"][1] == 6
    levels = item["ladders"]["glance"]["levels"]
    assert [level["faces"] for level in levels] == [640, 320, 128]
    assert levels[0]["error_mean"] < levels[1]["error_mean"] < levels[2]["error_mean"]
    store = np.frombuffer(zlib.decompress(base64.b64decode(item["store"])), np.uint8)
    at, count = item["saliency"]["glance"]["values"]
    assert (store[at : at + count].cumsum(dtype=np.uint8)).max() == 63  # the brightest of the shades


def test_errors_stand_at_the_vertices_that_have_them(scans):
    item = exhibit(scans / "pear.ply", "pear", scans.parent / "out", None, 3, ["10%"])
    packed = turnable(item, 20_000)
    full, level = ordered(item.touched.mesh)[0], packed["ladders"]["glance"]["levels"][0]
    expected = 100 * vertex_errors(rotate_to_z_up(item.levels[0].mesh), full) / full.diagonal
    store = np.frombuffer(zlib.decompress(base64.b64decode(packed["store"])), np.uint8)
    at, count = level["error"]
    shown = packed["error_top"] * (store[at : at + count].cumsum(dtype=np.uint8) / 63.0) ** 2
    assert shown == pytest.approx(np.minimum(expected, packed["error_top"]), abs=0.03 * packed["error_top"])
    assert level["error_mean"] == pytest.approx(expected.mean(), abs=1e-4)


def test_each_imprint_has_its_place_and_how_salient_that_is(whole):
    out, _, page, _, _ = whole
    texts = [(out / name / "points.csv").read_text() for name in ("pear & co", "pear")]
    rows = [line.split(",") for text in texts for line in text.splitlines()[1:]]
    captions = re.findall(r"<b>(\d+)</b> score ([\d.]+)", page)
    assert captions == [(row[0], f"{float(row[5]):.2f}") for row in rows] and len(captions) == 12


def test_a_large_mesh_is_drawn_with_fewer_faces_and_says_so(scans, monkeypatch):
    monkeypatch.setattr("haptic_glance.gallery.page.ALL", 600)
    monkeypatch.setattr("haptic_glance.gallery.page.LEAST", 100)
    _, page, _, _ = gallery(scans / "pear.ply", scans.parent / "out", "--levels", "50%,10%")
    (item,) = page_data(page)["objects"]
    assert item["faces"] == 1280 and item["full"]["faces"] <= 600
    levels = item["ladders"]["glance"]["levels"]
    assert [level["faces"] for level in levels] == [640, 128] and all(level["drawn"] <= 600 for level in levels)


def test_json_lists_what_was_made_and_a_level_that_is_infeasible_is_named(scans):
    _, page, printed, reported = gallery(scans, scans.parent / "out", "--json", "--levels", "300,2")
    by_name = {row["mesh"].split("/")[-1]: row for row in json.loads(printed)}
    assert set(by_name) == {"pear.ply", "pear & co.stl", "broken.obj"} and "error" in by_name["broken.obj"]
    assert by_name["pear.ply"]["levels"] == [300] and by_name["pear.ply"]["faces"] == 1280
    assert "<li>2: " in page and "pear_300.ply" in page and "pear.ply has no level 2: " in reported


def test_a_boundary_that_leaves_too_many_faces_is_simplified_too(scans):
    strip = flat_grid(41, 5)
    u, v = strip.vertices[:, 0] * 3 / 40, strip.vertices[:, 1] / 10
    trimesh.Trimesh(np.stack([np.cos(u), np.sin(u), v], axis=1), strip.faces).export(scans / "strip.ply")
    _, page, _, _ = gallery(scans / "strip.ply", scans.parent / "out", "--levels", "25%")
    (item,) = page_data(page)["objects"]
    assert item["faces"] == 320 and [level["faces"] for level in item["ladders"]["glance"]["levels"]] == [80]


def test_where_it_is_stopped_the_page_shows_what_is_done(scans, monkeypatch, capsys):
    work, exhibits = command.exhibit, []

    def stopped(*args):
        if exhibits:
            raise KeyboardInterrupt
        exhibits.append(work(*args))
        return exhibits[0]

    monkeypatch.setattr(command, "exhibit", stopped)
    (scans / "broken.obj").unlink()
    with pytest.raises(KeyboardInterrupt):
        run([str(scans), "--out", str(scans.parent / "out")])
    assert len(page_data((scans.parent / "out/index.html").read_text("utf-8"))["objects"]) == 1


def test_vertices_that_a_file_doubles_are_touched_where_they_are(tmp_path, capsys):
    pear(tmp_path / "pear.ply")
    mesh = load(tmp_path / "pear.ply")
    soup = trimesh.Trimesh(
        mesh.vertices[mesh.faces].reshape(-1, 3), np.arange(3 * len(mesh.faces)).reshape(-1, 3), process=False
    )
    soup.export(tmp_path / "soup.ply")
    assert run([str(tmp_path / "soup.ply"), "--count", "3", "--levels", "300", "--out", str(tmp_path / "out")]) == 0
    rows = [(tmp_path / "out/soup" / name).read_text().splitlines()[1:] for name in ("points.csv", "places.csv")]
    points, places = (np.array([row.split(",")[2:5] for row in lines], dtype=float) for lines in rows)
    assert len(points) == 3 and points == pytest.approx(places, rel=1e-5)


def test_data_do_not_end_the_script_that_holds_them():
    """A name of a file may hold anything; after `<!--<script>` the end of the script would not count as such."""
    value = ["</script>", "<!--<script>"]
    text = as_script(value)
    assert "</" not in text and "<!--" not in text and json.loads(text) == value
