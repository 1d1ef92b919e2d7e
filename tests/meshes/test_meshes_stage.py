"""The stage on a person's own folder: good meshes pass, bad ones are named, nothing is lost; classes of objects."""

import numpy as np
import pytest
import trimesh

from haptic_glance.base.files import read_json, read_mesh, read_table, write_text
from haptic_glance.mesh import normalise
from haptic_glance.mesh.mesh import Mesh
from stages.engine.rows import read_rows
from stages.meshes import __main__ as stage
from stages.meshes.collect import chosen_objects, read_classes


@pytest.fixture
def start(tmp_path, make_workspace):
    """A function that runs the stage on a folder of four files, two of them of one name, one broken."""
    (tmp_path / "mine" / "sub folder").mkdir(parents=True)
    trimesh.creation.box((1, 2, 4)).export(tmp_path / "mine" / "Kiste à thé.stl")
    trimesh.creation.icosphere(2).export(tmp_path / "mine" / "sub folder" / "ball.ply")
    trimesh.creation.icosphere(1).export(tmp_path / "mine" / "sub folder" / "ball.off")
    (tmp_path / "mine" / "broken.obj").write_bytes(b"\0\1\2")
    (tmp_path / "mine/.Trash").mkdir()
    for name in ("._ball.stl", ".Trash/old.stl"):  # of macOS: no objects, and not counted as files of other formats
        (tmp_path / "mine" / name).write_bytes(b"\0")

    def start(**settings):
        section = {"source": "folder", "folder": str(tmp_path / "mine"), "up": "y", "unit": "mm", "objects": []}
        workspace = make_workspace({"meshes": section | {"strict": False, "classes": {}} | settings})
        stage.run(workspace)
        return workspace

    return start


def test_good_meshes_pass_and_bad_ones_are_named(start, capsys):
    workspace = start()
    printed = capsys.readouterr().err
    assert (
        "refused broken.obj: the file holds no geometry" in printed
        and "ignored" not in printed
        and "axes" not in printed
    )
    assert "sub folder/ball.ply is named sub folder__ball_ply, since sub folder/ball.off is sub folder__ball" in printed
    folder = workspace.data / "meshes"
    manifest = read_table(folder / "manifest.csv")
    assert sorted(manifest.object) == ["Kiste à thé", "sub folder__ball", "sub folder__ball_ply"]
    assert manifest.repairs.fillna("").str.contains("too few").tolist() == (manifest.faces < 20).tolist()
    assert manifest.watertight.all() and (manifest.unit == "mm").all() and manifest["size"].max() == 4
    assert read_table(folder / "refused.csv").reason.tolist() == ["the file holds no geometry"]
    mesh = read_mesh(folder / "Kiste à thé.npz")
    assert np.linalg.norm(mesh.vertices, axis=1).max() == pytest.approx(0.5)
    assert np.ptp(mesh.vertices, axis=0).argmin() == 1  # x was the shortest side; y up turns x to y
    rows = read_rows(workspace.measurements / "meshes.csv.gz").set_index("item")
    assert set(rows.metric) == {"faces"} and rows.value["Kiste à thé"] == 12 and np.isnan(rows.value["broken"])
    assert rows.note["broken"] == "the file holds no geometry" and rows.note.isna().sum() == 3
    assert read_json(workspace.metrics / "meshes.json") == {"objects": 3, "refused": 1, "watertight": 3}
    with pytest.raises(ValueError, match=r"classes\.csv is not there: name the classes .* meshes\.classes"):
        read_classes(folder)


@pytest.mark.slow
def test_only_a_changed_file_is_prepared_again(start, tmp_path, monkeypatch):
    prepared = []
    prepare = stage.prepare_mesh

    def noted(item, *settings):
        prepared.append(item.name)
        return prepare(item, *settings)

    monkeypatch.setattr(stage, "prepare_mesh", noted)
    start()
    assert len(prepared) == 4
    trimesh.creation.box((1, 1, 4)).export(tmp_path / "mine" / "broken.obj")
    start(strict=True)
    assert prepared[4:] == ["broken"]
    start(unit="m")
    assert len(prepared) == 5 + 4


def test_a_gltf_whose_buffer_changed_is_prepared_again(start, tmp_path):
    for height, suffix in ((2, ""), (8, ".bin")):
        for name, content in trimesh.Scene(trimesh.creation.box((1, height, 1))).export(file_type="gltf").items():
            if name.endswith(suffix):
                (tmp_path / "mine" / name).write_bytes(content)
        manifest = read_table(start().data / "meshes/manifest.csv").set_index("object")
        assert manifest["size"]["model"] == height


def test_strict_stops_at_the_first_refusal_and_keeps_the_earlier_result(start):
    workspace = start()
    for settings, words in (
        ({"strict": True}, "meshes.strict is set"),
        ({"folder": "yours"}, "meshes.folder='yours' is not a folder"),
    ):
        with pytest.raises(ValueError, match=words):
            start(**settings)
    assert len(read_table(workspace.data / "meshes" / "manifest.csv")) == 3


def test_axes_that_were_assumed_and_meshes_without_a_class_are_named(start, tmp_path, capsys):
    (tmp_path / "mine/broken.obj").unlink()
    trimesh.creation.box((1, 2, 4)).export(tmp_path / "mine/lamp.glb")  # of glTF y is up
    start(up="auto", classes={"round": ["sub folder__ball", "sub folder__ball_ply"], "flat": ["lamp"]})
    printed = capsys.readouterr().err
    assert "meshes: 1 of 4 are not in meshes.objects and meshes.classes: Kiste à thé" in printed
    assert "meshes: toys, up axes: z for 2, y for 1 (lamp)" in printed


def test_objects_of_classes_are_taken_and_small_classes_have_a_note(start):
    workspace = start(
        classes={"round": ["sub folder__ball", "sub folder__ball_ply"], "flat": ["broken", "Kiste à thé"]}
    )
    folder = workspace.data / "meshes"
    assert read_classes(folder) == {"round": ["sub folder__ball", "sub folder__ball_ply"], "flat": ["Kiste à thé"]}
    rows = read_rows(workspace.measurements / "meshes.csv.gz")
    small = rows[rows.metric == "objects"].iloc[0]
    assert (small.group, small.value) == ("flat", 1) and "has 1 of its 2 objects" in small.note
    assert len(rows[rows.metric == "faces"]) == 4
    assert set(read_table(folder / "manifest.csv").object) == {
        "Kiste à thé",
        "sub folder__ball",
        "sub folder__ball_ply",
    }


def test_normalise_ignores_vertices_that_no_face_uses():
    box = trimesh.creation.box((1, 2, 4))
    mesh = normalise(Mesh(np.vstack([box.vertices + 7, [(1000, 0, 0)]]), box.faces))
    used = mesh.vertices[:-1]
    np.testing.assert_allclose(used.min(axis=0) + used.max(axis=0), 0, atol=1e-12)
    assert np.linalg.norm(used, axis=1).max() == pytest.approx(0.5)


CLASSES = {"vase": ["urn", "jar"], "animal": ["dog", "61"]}


def test_classes_say_which_objects_are_taken_unless_objects_are_named():
    assert chosen_objects([], CLASSES) == ["urn", "jar", "dog", "61"]
    assert chosen_objects(["urn"], CLASSES) == ["urn"]
    assert chosen_objects([], {}) == []


def test_classes_are_read_in_their_order_and_names_stay_texts(tmp_path):
    write_text(tmp_path / "classes.csv", "class,object\nvase,urn\nanimal,dog\nanimal,61\nvase,jar\n")
    classes = read_classes(tmp_path)
    assert classes == CLASSES and list(classes) == ["vase", "animal"]
