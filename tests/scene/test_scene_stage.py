"""From settings to rows: the committed scenes are sound, a scene goes on without what is not there, rows say it all."""

import dataclasses
import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml

from haptic_glance.base.files import read_arrays, read_table, write_arrays, write_mesh, write_table
from stages.engine.rows import read_rows
from stages.engine.settings import check_section
from stages.scene import Params, __main__
from stages.scene import measure as stage_measure
from stages.scene.__main__ import levels_of
from stages.scene.level_files import export
from stages.scene.measure import Case, measure, measure_network, report_missing, scene_of
from stages.scene.rows import summary
from tests.scene.conftest import bumpy

pytestmark = pytest.mark.slow

SCENES = sorted((Path(__file__).parents[2] / "conf/scene").glob("*.yaml"))
COMMON = {"limit": 0, "hold": 2, "method": "glance-soft", "factors": [1.0], "msft_lod": True}


def settings_of(path, **changes):
    return check_section(Params, COMMON | yaml.safe_load(path.read_text())["scene"] | changes)


@pytest.fixture(scope="module")
def settings():
    placed = [{"name": name, "position": [x, 0.0, 0.0], "turn": 0.0, "size": 0.2}
              for name, x in (("one", -0.15), ("nothing", 0.0), ("two", 0.15))]  # fmt: skip
    camera = [{"eye": eye, "target": [0, 0, 0.1]} for eye in ([0, -3, 0.5], [0, -1, 0.4])]
    changes = {"frames": 4, "screen": [48, 64], "angle": 35.0, "tolerance": 1.0}
    return settings_of(SCENES[0], name="small", objects=placed, camera=camera, **changes)


@pytest.fixture(scope="module")
def root(meshes, tmp_path_factory):
    """A folder with meshes and salient_points: the two meshes of the scene, and a third without a curve."""
    root = tmp_path_factory.mktemp("root")
    for name, mesh in {"one": bumpy(0, 3), "two": meshes["two"], "third": meshes["two"]}.items():
        write_mesh(root / f"meshes/{name}.npz", mesh)
        saliency = np.linspace(0, 1, len(mesh.vertices)).astype(np.float32)
        arrays = {"glance.points": np.array([0, 5]), "glance.strong": np.int64(2), "glance.saliency": saliency}
        arrays |= {"itti.points": np.array([0, 5]), "itti.strong": np.int64(2)}
        write_arrays(root / f"salient_points/{name}.npz", **arrays)
    return root


@pytest.fixture(scope="module")
def run_in(settings, root):
    """A function of a folder and factors: all jobs of the stage; returns their rows."""

    def work(folder, factors, others=("third",)):
        rows = [row for name in ("one", "two") for row in levels_of(name, folder, root, settings.method, 0)]
        for factor in factors:
            case = Case(settings, factor)
            rows += measure(case, folder, root, folder, ["one", "two"], 0)
            rows += measure_network(case, folder, root, folder, ["one", "two"], others, 0)
        export(folder, root, scene_of(settings, ["one", "two"])[0], settings)
        return rows

    return work


@pytest.fixture(scope="module")
def run(run_in, root):
    return root / "out", run_in(root / "out", [1.0, 2.0])


@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.stem)
def test_every_scene_is_sound(path):
    settings = settings_of(path)
    names = {item.name for item in settings.objects}
    scene, missing = scene_of(settings, names)
    assert settings.name == path.stem and not missing
    assert len(scene.cameras) == settings.frames and all(0.02 < placed.size < 0.5 for placed in scene.objects)


@pytest.mark.parametrize(
    ("present", "placed", "words"),
    [
        (["one", "two"], ["one", "two"], "without them; not in data/SET/meshes: nothing"),
        (["cube", "urn"], ["cube", "urn"], "with cube, urn in their places"),
    ],
)
def test_a_scene_goes_on_without_what_is_not_there_and_says_so(settings, capsys, present, placed, words):
    scene, missing = scene_of(settings, present)
    report_missing(settings, scene, missing)
    assert [item.name for item in scene.objects] == placed and {item.size for item in scene.objects} == {0.2}
    assert words in capsys.readouterr().err


def value(rows, method, metric, matched="", factor=1.0):
    values = [row["value"] for row in rows if (row["method"], row["metric"], row.get("matched"), row.get("factor")) ==
             (method, metric, matched, factor) and row["frame"] == "all" and not row["item"]]  # fmt: skip
    assert len(values) == 1, (method, metric, matched)
    return values[0]


def test_ours_holds_every_frame_with_fewer_faces_than_all(run):
    rows = run[1]
    assert value(rows, "ours", "held") == value(rows, "full", "held") == 1
    assert value(rows, "ours", "error_worst") <= 1.0 and value(rows, "full", "error") == 0
    assert value(rows, "ours", "step_worst") <= 1.0
    assert value(rows, "ours", "faces", factor=2.0) <= value(rows, "ours", "faces") < value(rows, "full", "faces") / 2
    assert value(rows, "ours", "planning_ms") >= 0
    metrics = summary(rows)
    assert {"faces_ours", "faces_full", "held_ours", "error_uniform", "saved_uniform_error"} <= set(metrics)
    assert all(np.isfinite(number) for number in metrics.values())
    network = [row for row in rows if row["method"] == "network"]  # there is no curve to learn from
    assert [(row["kind"], row["tolerance"]) for row in network] == [("pixels", 1.0), ("pixels", 2.0)]
    assert all("curve.csv" in row["note"] for row in network)


def test_rivals_have_no_smaller_error_than_ours_or_say_so(run):
    rows = run[1]
    for method in ("uniform", "uniform_size"):
        worse = value(rows, method, "error", "error") >= value(rows, "ours", "error")
        notes = {row["note"] for row in rows if row["method"] == method and row.get("matched") == "error"}
        assert worse or any("less error" in note for note in notes)
        assert value(rows, method, "error_worst", "held") <= 1.0


def test_frames_of_the_table_add_up_and_each_level_is_exported_once(run):
    folder, rows = run
    plan = read_table(folder / "plan.csv")
    plan = plan[plan["in_view"]]
    mean = plan.groupby("frame")["faces"].sum().mean()
    assert mean == pytest.approx(value(rows, "ours", "faces"))
    of_frames = [row["value"] for row in rows if row["method"] == "ours" and row["metric"] == "faces"
                 and row["frame"] != "all"]  # fmt: skip
    assert np.mean(of_frames) == pytest.approx(mean) and len(of_frames) == 4
    wanted = {f"{row.item}_{row.faces}.glb" for row in plan.itertuples()}
    assert wanted | {"one.glb", "two.glb", "scene.glb"} == {path.name for path in (folder / "export").glob("*.glb")}
    stored = read_arrays(folder / "pictures.npz")
    assert stored["methods"].tolist()[0] == "full" and "ours" in stored["methods"]
    assert stored["rgb"].shape[1:] == (3, 48, 64, 3) and stored["rgb"][:, 0].max() > 100
    assert np.nanmax(stored["displacement"][:, 0]) == 0 < np.nanmax(stored["displacement"][:, -1])


def test_equal_runs_give_equal_files(run, run_in, root):
    folder = root / "again"
    run_in(folder, [1.0])
    for path in sorted(path for path in folder.rglob("*") if path.is_file()):
        assert path.read_bytes() == (run[0] / path.relative_to(folder)).read_bytes(), path


def write_curve(data, name):
    """An object outside the scene with a curve, on which the network learns."""
    for kind in ("meshes", "salient_points"):
        write_arrays(data / kind / f"{name}.npz", **read_arrays(data / kind / "two.npz"))
    curve = pd.DataFrame({"faces": [25, 50, 100, 200, 400]})
    curve = curve.assign(item=name, method="itti", points=4, metric="metro_mean", value=2 / curve["faces"])
    write_table(data / f"lod/{name}/curve.csv", curve)


@pytest.fixture
def workspace(settings, root, make_workspace):
    """A data set whose third object, outside the scene, has a curve."""
    workspace = make_workspace({"scene": dataclasses.asdict(settings)})
    for kind in ("meshes", "salient_points"):
        shutil.copytree(root / kind, workspace.data / kind)
    write_curve(workspace.data, "third")
    return workspace


def test_an_object_outside_the_scene_runs_the_network_again_and_nothing_else(workspace, monkeypatch):
    calls = []
    for name in ("build_lod_chain", "compare", "compare_network"):
        place = __main__ if name == "build_lod_chain" else stage_measure
        work = getattr(place, name)
        monkeypatch.setattr(place, name, lambda *a, name=name, work=work, **k: calls.append(name) or work(*a, **k))
    __main__.run(workspace)
    assert calls == [*["build_lod_chain"] * 4, "compare", "compare_network"]
    rows = read_rows(workspace.measurements / "scene.csv.gz").to_dict("records")
    assert {row["group"] for row in rows if row["condition"] != row["condition"]} == {"small"}
    assert {
        row["value"] for row in rows if (row["method"], row["metric"], row["matched"]) == ("network", "held", "held")
    }
    calls.clear()
    write_curve(workspace.data, "fourth")
    __main__.run(workspace)
    assert calls == ["compare_network"]
