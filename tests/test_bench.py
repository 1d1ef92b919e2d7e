"""A saliency of one's own is judged as the stages judge theirs, and what is no saliency is named."""

import json
import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import trimesh

from haptic_glance.look.agreement import METRICS, GroundTruth, nss
from haptic_glance.mesh.mesh import Mesh
from stages import bench
from stages.engine import statistics
from stages.engine.rows import read_rows

PAGE = (Path(__file__).parents[1] / "docs/judging.md").read_text(encoding="utf-8")
*EXAMPLES, OWN_GAZE = re.findall(r"^```python\n(.*?)^```$", PAGE, re.M | re.S)
SHORT = 20  # lines of a new method
OBJECTS = ("first", "second", "third")
METHODS = """
import numpy as np

def height(mesh):
    print("a method may print")
    return mesh.vertices[:, 2] - mesh.vertices[:, 2].min()

def positions(mesh):
    return mesh.vertices

def moody(mesh):
    values, size = height(mesh), mesh.vertices[:, 0].max()
    if size == 1:
        raise KeyError("no such part")
    return values if size == 2 else values * np.nan

def quits(mesh):
    raise SystemExit(3)

def waves(mesh):
    return height(mesh) * 1j

def counts(training):
    assert all(len(mesh.vertices) == len(density) for mesh, density in training)
    sizes = {mesh.vertices[:, 0].max() for mesh, _ in training}
    for mesh, density in training:
        density[:] = 0  # which spoils nothing for the objects that come later
    return lambda mesh: height(mesh) * (len(sizes) == 2 and mesh.vertices[:, 0].max() not in sizes)
"""


@pytest.fixture(scope="module", autouse=True)
def few_resamples():
    """Most of the time of a judgement goes to the resamples of its intervals."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(statistics, "RESAMPLES", 400)
        yield


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "mine.py"
    path.write_text(METHODS)
    return path


@pytest.fixture
def toys(monkeypatch):
    """Three pairs of triangles of width 1, 2 and 3, with gaze at their highest vertex."""
    shapes = {}
    for width, name in enumerate(OBJECTS, start=1):
        corners = np.array([[0, 0, 0], [width, 0, 0.2], [0, 1, 0.5], [width, 1, 1.0]])
        mesh = Mesh(corners, np.array([[0, 1, 2], [1, 3, 2]]))
        shapes[name] = mesh, GroundTruth(np.array([0, 0, 0, 1.0]), np.array([0, 0, 0.1, 1.0]), mesh.vertex_areas)
    monkeypatch.setattr(bench, "gazed", lambda dataset, archive: shapes)


def listed(capsys, *options):
    """{method: its row} as --json prints them."""
    bench.run([*options, "--json"])
    return {row["method"]: row for row in json.loads(capsys.readouterr().out)}


def frame_of(rows):
    frame = pd.DataFrame(rows, columns=["item", "method", "value"]).assign(seconds=0.5)
    return pd.concat([frame.assign(metric=metric) for metric in bench.SCORES])


ROWS = [("a", "glance", 2.0), ("b", "glance", 1.0), ("c", "glance", 9.0), ("a", "yours", 2.5), ("b", "yours", 1.1),
        ("c", "yours", 1.2), ("a", "older", 0.1), ("b", "older", 0.3)]  # fmt: skip


def test_a_method_is_ranked_by_its_scores_and_compared_on_the_same_meshes():
    assert set(bench.SCORES) == set(METRICS)
    table = bench.leaderboard(frame_of(ROWS))
    assert [row["method"] for row in table] == ["glance", "yours", "older"]
    older = table[2]
    assert older["objects"] == 2 and older["nss_lead"] == pytest.approx((2.4 + 0.8) / 2)
    assert older["nss_lead_low"] < older["nss_lead"] < older["nss_lead_high"] and "nss_lead" not in table[1]
    assert [line.split()[0] for line in bench.as_text(table).splitlines()[1:4]] == ["1", ">", "2"]


def test_less_kl_is_better_in_order_and_lead():
    table = bench.leaderboard(frame_of(ROWS), "kl")
    assert [row["method"] for row in table] == ["older", "yours", "glance"]
    assert table[0]["kl_lead"] == pytest.approx(-(2.4 + 0.8) / 2) and table[2]["kl_lead"] > 0
    assert "KL (less is better)" in bench.as_text(table, "kl") and "  -1.60 [" in bench.as_text(table, "kl")


@pytest.mark.slow
def test_a_method_is_judged_beside_the_committed_rows(file, toys, capsys):
    table = listed(capsys, f"{file}:height")
    assert table["yours"]["objects"] == 3 and table["yours"]["nss"] > 0 and table["yours"]["auc"] > 0.8
    assert table["glance"]["objects"] == 19 and table["glance"]["nss"] > table["itti"]["nss"]
    assert all(low < table["glance"][metric] < high for metric in bench.SCORES
               for low, high in [(table["glance"][f"{metric}_low"], table["glance"][f"{metric}_high"])])  # fmt: skip
    assert table["glance"]["values"]["cow"].keys() == {*bench.SCORES, "seconds"}
    assert table["svm+object"]["has_seen"] and not table["svm"]["has_seen"]


@pytest.mark.slow
def test_an_object_on_which_a_method_fails_is_named_and_the_others_are_judged(file, toys, capsys):
    bench.run([f"{file}:height"])
    out, err = capsys.readouterr()
    assert "first" not in out and "the other methods were judged on other objects" in err
    bench.run([f"{file}:moody", "--objects"])
    out, err = capsys.readouterr()
    assert "bench: 3 of 3: third" in err
    assert "bench: first is left out: KeyError: 'no such part'" in err and "bench: third is left out" in err
    assert re.search(r"^ +> yours +1 ", out, re.M) and re.search(r"^yours +third +ValueError: .*NaN", out, re.M)
    yours = listed(capsys, f"{file}:moody")["yours"]
    assert [*yours["values"]] == ["second"] and [*yours["failed"]] == ["first", "third"]


@pytest.mark.parametrize(("name", "reason"), [("quits", "SystemExit: 3"), ("waves", "complex values")])
def test_a_method_that_fails_on_every_object_ends_with_the_reason(file, toys, name, reason):
    with pytest.raises(ValueError, match=f"failed on every object, on third by .*{reason}"):
        bench.run([f"{file}:{name}"])


@pytest.mark.slow
def test_a_method_that_learns_never_gets_the_object_that_it_is_judged_on(file, toys, capsys):
    options = listed(capsys, f"{file}:counts", "--train"), listed(capsys, f"{file}:height")
    for metric in ("nss", "cc"):
        assert options[0]["yours"][metric] == pytest.approx(options[1]["yours"][metric])
        assert options[0]["yours"][metric] > 0


def test_an_object_of_ones_own_with_a_published_name_is_compared_with_no_row_of_that_name(file, toys, capsys):
    objects = bench.gazed("gaze", Path())
    (_, truth), *_ = objects.values()
    rows = [("first", "human", nss(truth.density, truth) + 4e-6), ("second", "human", 0.1)]
    assert [*bench.with_own_names(objects, frame_of(rows))] == ["first", "second (yours)", "third"]


def test_a_function_that_is_no_saliency_is_named(file, toys):
    with pytest.raises(ValueError, match="failed on every object.*saliency must have shape"):
        bench.run([f"{file}:positions"])


@pytest.mark.parametrize(("code", "options"), zip(EXAMPLES, ([], ["--train"]), strict=True))
@pytest.mark.slow
def test_a_new_method_takes_few_lines(code, options, tmp_path, toys, capsys):
    (tmp_path / "my_method.py").write_text(code)
    (name,) = re.findall(r"my_method\.py:(\w+).*" + (options[0] if options else "$"), PAGE, re.M)[:1]
    table = listed(capsys, f"{tmp_path / 'my_method.py'}:{name}", *options)
    assert len(code.splitlines()) <= SHORT and table["yours"]["objects"] == len(OBJECTS)


def test_what_is_not_there_is_named_before_anything_is_read(file, monkeypatch):
    broken = file.with_name("broken.py")
    broken.write_text("def width(mesh:")
    monkeypatch.setattr("stages.engine.rows.read_rows", None)
    for options, words in (
        (["nowhere.py:saliency"], "^nowhere.py: no such file"),
        (["nowhere.py"], "name a file and a function of it"),
        ([f"{file}:width"], "mine.py has no function 'width'"),
        ([f"{broken}:width"], "broken.py cannot be imported: SyntaxError: "),
        (["--train"], "--train is about a METHOD: name one"),
        ([f"{file}:height", "--gaze", "gone.zip"], "^--gaze gone.zip: no such file"),
    ):
        with pytest.raises(ValueError, match=words):
            bench.run(options)


def test_objects_whose_gaze_is_of_no_use_are_named_and_left_out(tmp_path, capsys):
    tables, meshes = tmp_path / "dataset_x", tmp_path / "Models_3D"
    tables.mkdir()
    meshes.mkdir()
    ball = trimesh.creation.icosphere(2)
    rows = np.column_stack([ball.vertices, ball.vertices, ball.vertices[:, 2] > 0, ball.vertices[:, 0] > 0])
    for name, seconds in (("good", 1), ("empty", 0), ("missing", 1), ("negative", -1)):
        (meshes / f"{name}.obj").write_text(ball.export(file_type="obj", digits=17))
        np.savetxt(tables / f"{name}.txt", rows * ([1] * 6 + [seconds, 1]), fmt="%.17g")
    (tables / "missing.txt").rename(tables / "missing.csv")
    assert list(bench.gazed("gaze", tmp_path)) == ["good"]
    printed = capsys.readouterr().err
    for words in (
        "empty is left out: the ground truth is empty",
        "missing is left out: no dataset_*/missing.txt holds its gaze",
        "negative is left out: dataset_x/negative.txt: 73 rows hold NaN or negative seconds",
    ):
        assert f"bench: {words}" in printed
    (meshes / "good.obj").unlink()
    with (
        pytest.warns(UserWarning, match="good is left out: no Models_3D/good.obj holds its mesh"),
        pytest.raises(ValueError, match="holds no mesh with gaze of --set gaze$"),
    ):
        bench.gazed("gaze", tmp_path)


@pytest.mark.slow
def test_a_method_gets_the_scores_that_the_stage_gave_it(file):
    dataset, item = "gaze", "bunny"
    archive = Path(bench.GAZE.format(dataset))
    if not archive.exists():
        pytest.skip(f"{archive} is not here")
    rows = read_rows(Path(bench.ROWS.format(dataset)))
    rows = rows[(rows["method"] == "height") & (rows["item"] == item)].set_index("metric")["value"]
    for row in bench.judged(bench.function_of(f"{file}:height"), bench.gazed(dataset, archive, [item])):
        assert row["value"] == pytest.approx(rows[row["metric"]], abs=1e-5)
