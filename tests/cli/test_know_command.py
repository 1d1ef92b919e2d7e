"""`haptic-glance know FOLDER --object FILE`: from a folder and a file to a name, in the terminal and on a page."""

import json
import re

import numpy as np
import pytest
import trimesh

from haptic_glance.cli.know import percent, run, whence
from haptic_glance.know import Approach, PressureArray, primitives
from haptic_glance.lod.export import write_any
from haptic_glance.mesh.mesh import Mesh

STEP = re.compile(r"touch \d+, from .+, (contact after [\d.]+ diameters|it meets nothing): (.+ %)")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Balls with a bump at a height each, which a look at a twentieth hardly tells apart, and a box."""
    place, ball = tmp_path_factory.mktemp("scans"), trimesh.creation.icosphere(4, radius=0.5)
    for degrees in (0, 20, 40, 60):
        top = [np.cos(np.radians(degrees)), 0, np.sin(np.radians(degrees))]
        radii = 1 + 0.12 * np.exp(-20 * (1 - 2 * ball.vertices @ top))
        write_any(place / f"bump{degrees}.obj", Mesh(30 * ball.vertices * radii[:, None], ball.faces))
    write_any(place / "box.obj", primitives()["box"])
    (place / "broken.stl").write_text("no mesh")
    (place / "notes.txt").write_text("not a mesh either")
    return place


@pytest.fixture
def know(folder, tmp_path, capsys):
    """Function: runs the command; returns (standard output, standard error, page)."""

    def work(*options, name="bump40.obj", place=folder):
        out = tmp_path / "out"
        run([str(place), "--object", str(place / name), "--out", str(out), *map(str, options)])
        captured = capsys.readouterr()
        return captured.out, captured.err, (out / "index.html").read_text("utf-8")

    return work


@pytest.mark.slow
def test_the_terminal_tells_the_look_each_touch_and_the_end(know, folder):
    printed, messages, _ = know("--hidden", 0.95, "--seed", 1)
    look, *touches, end = printed.splitlines()
    assert re.fullmatch(r"look at 5 % of bump40: (\w+ [<>]?[ \d]+ %, ){2}\w+ [<>]?[ \d]+ %", look)
    assert touches and all(STEP.fullmatch(line) for line in touches)
    count = f"{len(touches)} touch{'es' * (len(touches) > 1)}"
    assert end == f"bump40, after a look and {count}: right" and "bump40" in touches[-1].partition(": ")[2][:8]
    lines = messages.splitlines()
    assert lines[0] == f"know: reading {folder}" and lines[-1].startswith("know: written: ")
    (left_out,) = (line for line in lines if "left out" in line)
    assert left_out.startswith("know: left out: broken.stl: ")
    assert "know: learning 5 objects" in lines


@pytest.mark.slow
def test_json_has_the_steps_and_a_seed_decides_them(know):
    first = json.loads(know("--hidden", 0.95, "--seed", 1, "--json")[0])
    again = json.loads(know("--hidden", 0.95, "--seed", 1, "--json")[0])
    other = json.loads(know("--hidden", 0.95, "--seed", 2, "--json")[0])
    assert first == again and first["steps"] != other["steps"]
    assert first["object"] == first["answer"] == "bump40" and first["verdict"] == "right" and first["is_known"]
    look, *touches = first["steps"]
    assert look["step"] == "look" and len(touches) == first["touches"] > 0
    for step in (look, *touches):
        assert sum(step["probabilities"].values()) == pytest.approx(1)
    for step in touches:
        if step["travel"] is not None:
            way = np.array(step["origin"]) + step["travel"] * np.array(step["direction"])
            assert np.allclose(step["contact"], way) and np.linalg.norm(way) < 0.7
            assert (
                np.shape(step["imprint"]) == (8, 8)
                and 0 <= np.min(step["imprint"]) <= np.max(step["imprint"]) <= 0.0501
            )
    assert first["left_out"][0].startswith("broken.stl: ")


@pytest.mark.slow
def test_the_page_needs_no_other_file_and_shows_each_step(know):
    printed, _, page = know("--hidden", 0.95, "--seed", 1)
    count = len(printed.splitlines()) - 2
    assert page.count("<h2>Touch ") == page.count("<svg ") == count and page.count('<ul class="bars"') == count + 1
    sources = re.findall(r'(?:src|href)="([^"]{,20})', page)
    assert len(sources) >= 2 * count + 2 and all(text.startswith(("data:image/", "#")) for text in sources)
    assert '<span class="word yes">right</span> The object is bump40.' in page
    assert "A grey board hides 95 % of the object." in page and "0.05 diameters or more" in page
    assert "--hidden 0.95 --pose turned --most 10 --seed 1" in page and "<li>broken.stl: " in page


def test_without_a_board_a_look_alone_may_be_enough(know):
    printed, _, page = know("--hidden", 0, name="box.obj")
    assert printed.splitlines() == ["look at box: " + printed.splitlines()[0][13:], "box, after a look: right"]
    assert "board hides" not in page


@pytest.mark.slow
def test_an_object_that_was_not_learned_is_none_of_these_if_that_is_an_answer(know, tmp_path):
    write_any(tmp_path / "torus.obj", primitives()["torus"])
    printed, messages, page = know("--unknown", name=tmp_path / "torus.obj")
    assert "know: torus is not among the known objects" in messages.splitlines()
    assert re.fullmatch(
        r"none of these, after a look and \d+ touch(es)?: right; torus is not among the known objects",
        printed.splitlines()[-1],
    )
    assert "The object is torus, which is not among the known objects." in page
    without = json.loads(know("--json", name=tmp_path / "torus.obj")[0])
    assert without["verdict"] in ("wrong", "undecided") and not without["is_known"]


@pytest.mark.slow
def test_after_the_most_touches_it_is_undecided(know, monkeypatch):
    monkeypatch.setattr("haptic_glance.know.belief.SURE", 2)
    printed, _, page = know("--most", 2)
    *_, end = printed.splitlines()
    assert len(printed.splitlines()) == 4 and end.startswith("undecided after a look and 2 touches; the likeliest is ")
    assert page.count("<h2>Touch ") == 2 and '<span class="word open">undecided</span>' in page


@pytest.mark.slow
def test_sizes_count_and_lengths_have_the_unit_of_the_files(know, tmp_path, folder):
    _, _, page = know("--sized", "--hidden", 0.95, "--seed", 1)
    assert "of the files&#x27; units or more" in page and "diameters or more" not in page
    larger = Mesh(42 * primitives()["torus"].vertices, primitives()["torus"].faces)  # the balls measure some 33
    write_any(tmp_path / "larger.obj", larger)
    printed, _, page = know("--sized", "--hidden", 0.3, name=tmp_path / "larger.obj")
    assert printed.startswith("look at 70 % of larger: ") and "all of the object, from the same side" in page.lower()
    huge = trimesh.creation.box((200, 200, 200))
    write_any(tmp_path / "huge.obj", Mesh(huge.vertices, huge.faces))
    with pytest.raises(ValueError, match=r"huge.obj: it is [\d.]+ times as large .* or leave out --sized"):
        know("--sized", name=tmp_path / "huge.obj")


@pytest.mark.slow
@pytest.mark.filterwarnings("error:.*which axis points up")
def test_up_is_the_axis_of_all_files(know, tmp_path):
    for name in ("box", "cone"):  # their files do not say which axis points up
        shape = primitives()[name]
        trimesh.Trimesh(shape.vertices, shape.faces).export(tmp_path / f"{name}.stl")
    assert "cone, after a look: right" in know("--up", "-z", name="cone.stl", place=tmp_path)[0]
    with pytest.raises(UserWarning, match="box.stl does not say which axis points up"):
        know(name="cone.stl", place=tmp_path)


@pytest.mark.parametrize(
    "options, words",
    [
        (("--hidden", "0.96"), "--hidden 0.96: give a share from 0 to 0.95"),
        (("--hidden", "-0.1"), "--hidden -0.1: give a share from 0 to 0.95"),
        (("--hidden", "nan"), "--hidden nan: give a share"),
        (("--most", "0"), "--most 0: give 1 or more"),
        (("--seed", "-1"), "--seed -1: give 0 or more"),
        (("--out", "{folder}"), "is the folder of the meshes: name another one"),
        (("--object", "{folder}/nothing.stl"), "nothing.stl: no such file, give a mesh file, for example one of "),
        (("--object", "broken.stl"), r"\A--object [^:]*broken.stl: (?!.*broken.stl)"),
    ],
)
def test_what_cannot_be_is_named_with_a_remedy(folder, tmp_path, monkeypatch, options, words):
    monkeypatch.chdir(tmp_path)
    texts = [text.format(folder=folder) for text in options]
    with pytest.raises(ValueError, match=words):
        run([str(folder), "--object", "box.obj", *texts])
    assert not [*tmp_path.iterdir()]


def test_a_folder_without_two_meshes_is_named(folder, tmp_path):
    (tmp_path / "empty").mkdir()
    box = ["--object", str(folder / "box.obj"), "--out", str(tmp_path / "out")]
    with pytest.raises(ValueError, match="empty holds no mesh that can be touched: put two or more into it"):
        run([str(tmp_path / "empty"), *box])
    write_any(tmp_path / "empty/box.obj", primitives()["box"])
    with pytest.raises(ValueError, match="empty holds one mesh that can be touched"):
        run([str(tmp_path / "empty"), *box])
    with pytest.raises(ValueError, match="nowhere: no such folder"):
        run([str(tmp_path / "nowhere"), *box])
    with pytest.raises(ValueError, match="box.obj: is a file: give the folder that holds it"):
        run([str(folder / "box.obj"), *box])


@pytest.mark.parametrize(
    "normal, words",
    [
        ((1, 0, 0), "from the front"), ((0, 1, 0), "from the right"), ((-1, 0, 0), "from the back"),
        ((0, -1, 0), "from the left"), ((-1, -1, 1.4142), "from the back left, 45° above"),
        ((1, 0, -1), "from the front, 45° below"), ((0, 0.1, 1), "from above"), ((0, 0.1, -1), "from below"),
    ],
)  # fmt: skip
def test_from_where_the_hand_comes(normal, words):
    normal = np.array(normal) / np.linalg.norm(normal)
    axes = np.stack([np.zeros(3), np.zeros(3), normal])
    assert whence(Approach(normal, axes, PressureArray((2, 2), 0.1, 0.1))) == words


def test_a_probability_is_no_round_number_where_it_is_none():
    shown = [percent(share) for share in (0, 0.001, 0.5, 0.994, 1)]
    assert shown == ["0 %", "< 1 %", "50 %", "> 99 %", "100 %"]
