"""From settings to rows: the committed scenes are sound, a scene goes on without what is not there, rows say it all."""

import dataclasses
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml

from stages.kit.files import read_arrays, read_table, write_arrays, write_mesh, write_table
from stages.kit.params import check_section
from stages.kit.run import DATA
from stages.scene.__main__ import levels_of
from stages.scene.export import export
from stages.scene.measure import measure
from stages.scene.read import say_missing, scene_of
from stages.scene.rows import summary

SCENES = sorted((Path(__file__).parents[2] / "conf/scene").glob("*.yaml"))
COMMON = {"limit": 0, "hold": 2, "method": "enhanced-soft", "factors": [1.0], "msft_lod": True}


def settings_of(path, **changes):
    return check_section("scene", COMMON | yaml.safe_load(path.read_text())["scene"] | changes)


@pytest.fixture(scope="module")
def settings():
    placed = [{"name": name, "position": [x, 0.0, 0.0], "turn": 0.0, "size": 0.2}
              for name, x in (("one", -0.15), ("nothing", 0.0), ("two", 0.15))]  # fmt: skip
    camera = [{"eye": eye, "target": [0, 0, 0.1]} for eye in ([0, -3, 0.5], [0, -1, 0.4])]
    changes = {"frames": 4, "screen": [48, 64], "angle": 35.0, "tolerance": 1.0}
    return settings_of(SCENES[0], name="small", objects=placed, camera=camera, **changes)


@pytest.fixture(scope="module")
def root(meshes, tmp_path_factory):
    """A folder with data/meshes and data/salient_points of the two meshes."""
    root = tmp_path_factory.mktemp("root")
    for name, mesh in meshes.items():
        write_mesh(root / DATA / f"meshes/{name}.npz", mesh)
        saliency = np.linspace(0, 1, len(mesh.vertices)).astype(np.float32)
        found = {"enhanced.points": np.array([0, 5]), "enhanced.strong": np.int64(2), "enhanced.saliency": saliency}
        write_arrays(root / DATA / f"salient_points/{name}.npz", **found)
    return root


@pytest.fixture(scope="module")
def run(settings, root):
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(root)
        folder = Path("out")
        rows = [row for name in ("one", "two") for row in levels_of(name, folder, settings, 0)]
        factors = {"tolerance_1": 1.0, "tolerance_2": 2.0}
        for job in factors:
            rows += measure(job, folder, settings, factors, ["one", "two"], 0)
        export(folder, settings, ["one", "two"])
        yield root / folder, rows


@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.stem)
def test_every_scene_is_sound(path):
    settings = settings_of(path)
    names = {item.name for item in settings.objects}
    scene, missing = scene_of(settings, names)
    assert settings.name == path.stem and not missing
    assert len(scene.cameras) == settings.frames and all(0.02 < placed.size < 0.5 for placed in scene.objects)


def test_a_scene_goes_on_without_what_is_not_there_and_says_so(settings, capsys):
    scene, missing = scene_of(settings, ["one", "two"])
    say_missing(settings, scene, missing)
    assert [placed.name for placed in scene.objects] == ["one", "two"]
    assert "on without them; not in data/meshes: nothing" in capsys.readouterr().err


def test_other_meshes_stand_in_where_the_data_has_none_of_the_scene(settings, capsys):
    scene, missing = scene_of(settings, ["cube", "urn"])
    say_missing(settings, scene, missing)
    assert [placed.name for placed in scene.objects] == ["cube", "urn"]
    assert [placed.size for placed in scene.objects] == [item.size for item in settings.objects[:2]]
    assert "with cube, urn in their places" in capsys.readouterr().err


def test_a_scene_of_nothing_is_refused(settings):
    with pytest.raises(ValueError, match="scene small names no object"):
        scene_of(settings, [])


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"tolerance": 0.0}, "tolerance"),
        ({"tolerance": -2.0}, "tolerance"),
        ({"frames": 0}, "camera path"),
        ({"camera": []}, "camera path"),
        ({"screen": [48]}, "rows and columns"),
        ({"kind": "metres"}, "kind"),
    ],
)
def test_bad_settings_are_named(settings, change, reason):
    with pytest.raises(ValueError, match=reason):
        scene_of(dataclasses.replace(settings, **change), ["one", "two"])


def value(rows, method, metric, matched="", factor=1.0):
    found = [row["value"] for row in rows if (row["method"], row["metric"], row.get("matched"), row.get("factor")) ==
             (method, metric, matched, factor) and row["frame"] == "all" and not row["object"]]  # fmt: skip
    assert len(found) == 1, (method, metric, matched)
    return found[0]


def test_ours_holds_every_frame_with_fewer_faces_than_all(run):
    rows = run[1]
    assert value(rows, "ours", "held") == value(rows, "full", "held") == 1
    assert value(rows, "ours", "error_worst") <= 1.0 and value(rows, "full", "error") == 0
    assert value(rows, "ours", "step_worst") <= 1.0
    assert value(rows, "ours", "faces", factor=2.0) <= value(rows, "ours", "faces") < value(rows, "full", "faces") / 2


def test_rivals_have_no_smaller_error_than_ours_or_say_so(run):
    rows = run[1]
    for method in ("uniform", "uniform_size"):
        worse = value(rows, method, "error", "error") >= value(rows, "ours", "error")
        notes = {row["note"] for row in rows if row["method"] == method and row.get("matched") == "error"}
        assert worse or any("less error" in note for note in notes)
        assert value(rows, method, "error_worst", "held") <= 1.0


def test_without_curves_the_network_is_a_row_with_the_reason(run):
    rows = [row for row in run[1] if row["method"] == "network"]
    assert [(row["kind"], row["tolerance"]) for row in rows] == [("pixels", 1.0), ("pixels", 2.0)]
    assert all("curve.csv" in row["note"] for row in rows)


def test_frames_of_the_table_add_up(run):
    folder, rows = run
    plan = read_table(folder / "plan.csv")
    mean = plan[plan["in_view"]].groupby("frame")["faces"].sum().mean()
    assert mean == pytest.approx(value(rows, "ours", "faces"))
    of_frames = [row["value"] for row in rows if row["method"] == "ours" and row["metric"] == "faces"
                 and row["frame"] != "all"]  # fmt: skip
    assert np.mean(of_frames) == pytest.approx(mean) and len(of_frames) == 4


def test_pictures_show_the_full_frame_beside_the_others(run):
    stored = read_arrays(run[0] / "pictures.npz")
    assert stored["methods"].tolist()[0] == "full" and "ours" in stored["methods"]
    assert stored["rgb"].shape[1:] == (3, 48, 64, 3) and stored["rgb"][:, 0].max() > 100
    assert np.nanmax(stored["displacement"][:, 0]) == 0 < np.nanmax(stored["displacement"][:, -1])


def test_each_level_of_the_plan_is_exported_once(run):
    folder, _ = run
    plan = read_table(folder / "plan.csv").query("in_view")
    wanted = {f"{row.object}_{row.faces}.glb" for row in plan.itertuples()}
    names = {path.name for path in (folder / "export").glob("*.glb")}
    assert wanted | {"one.glb", "two.glb", "scene.glb"} == names


def test_the_summary_is_small_and_finite(run):
    found = summary(run[1])
    assert {"faces_ours", "faces_full", "held_ours", "error_uniform", "saved_uniform_error"} <= set(found)
    assert all(np.isfinite(number) for number in found.values())


def test_equal_runs_give_equal_files(run, settings, root, monkeypatch):
    monkeypatch.chdir(root)
    folder = Path("again")
    for name in ("one", "two"):
        levels_of(name, folder, settings, 0)
    measure("tolerance_1", folder, settings, {"tolerance_1": 1.0}, ["one", "two"], 0)
    export(folder, settings, ["one", "two"])
    for path in sorted(path for path in folder.rglob("*") if path.is_file()):
        assert path.read_bytes() == (run[0] / path.relative_to(folder)).read_bytes(), path


def test_the_network_is_asked_where_there_are_curves(run, settings, root, monkeypatch):
    monkeypatch.chdir(root)
    curve = pd.DataFrame({"faces": [25, 50, 100, 200, 400]})
    curve = curve.assign(object="third", method="itti", points=4, metric="metro_mean", value=2 / curve["faces"])
    write_table(root / DATA / "lod/third/curve.csv", curve)
    known = read_arrays(root / DATA / "salient_points/one.npz")
    for name in ("one", "two", "third"):
        more = {"itti.points": np.array([0, 5]), "itti.strong": np.int64(2)}
        write_arrays(root / DATA / f"salient_points/{name}.npz", **known | more)
    write_arrays(root / DATA / "meshes/third.npz", **read_arrays(root / DATA / "meshes/two.npz"))
    rows = measure("tolerance_2", run[0], settings, {"tolerance_2": 2.0}, ["one", "two", "third"], 0)
    assert value(rows, "network", "faces", "error", 2.0) > 0
