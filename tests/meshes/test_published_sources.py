"""The published collections as sources of meshes: names, up axis, vertices as stored, a remedy where one is absent."""

import io
import pickle
import zipfile
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import trimesh
from scipy.io import savemat

from haptic_glance.base.fetch import FetchError
from haptic_glance.mesh import MeshError
from haptic_glance.mesh.files import parse
from stages.meshes.sources import SOURCES, Content

ROOT = Path(__file__).parents[2]
SHARED = ROOT / "../shared/data"
BALL = trimesh.creation.icosphere(1)


def items(source, folder, objects=()):
    return SOURCES[source](SimpleNamespace(folder=str(folder), objects=list(objects), up="x"))


def off(mesh):
    return mesh.export(file_type="off")


@pytest.fixture
def archives(tmp_path):
    with zipfile.ZipFile(tmp_path / "gaze.zip", "w") as archive:
        archive.writestr("Models_3D/", "")
        archive.writestr("Models_3D/bunny.obj", BALL.export(file_type="obj"))
        archive.writestr("dataset_train/bunny.txt", "")
    with zipfile.ZipFile(tmp_path / "princeton.zip", "w") as archive:
        archive.writestr("LabeledDB_new/Airplane/61.off", off(BALL))
        archive.writestr("LabeledDB_new/Ant/81.off", off(BALL))
        archive.writestr("__MACOSX/LabeledDB_new/Ant/._81.off", "")
    stream = io.BytesIO()
    savemat(stream, {"V": BALL.vertices / 3, "F": BALL.faces + 1.0})
    with zipfile.ZipFile(tmp_path / "interest_points.zip", "w") as archive:
        archive.writestr("3DInterestPoint/MODEL_DATASET/ant.mat", stream.getvalue())
        archive.writestr("3DInterestPoint/IP_BENCHMARK/OUTPUT_DATA/GROUND_TRUTH_B/ant.mat", b"")
    return tmp_path


@pytest.mark.parametrize(
    ("source", "names", "up"),
    [("gaze", ["bunny"], "y"), ("princeton", ["Airplane_61", "Ant_81"], "y"), ("interest_points", ["ant"], "x")],
)
def test_a_zip_and_its_folder_give_the_same_readable_items(archives, source, names, up):
    with zipfile.ZipFile(archives / f"{source}.zip") as archive:
        archive.extractall(archives / source)
    for place in (archives / f"{source}.zip", archives / source):
        files = items(source, place)
        assert [item.name for item in files] == names and {item.up for item in files} == {up}
        mesh = parse(files[0].content(), files[0].suffix)
        assert (mesh.faces == BALL.faces).all()
        np.testing.assert_allclose(mesh.vertices * (3 if source == "interest_points" else 1), BALL.vertices, atol=1e-7)


def test_matlab_models_keep_every_digit_and_duplicate_vertex(tmp_path):
    vertices = np.random.default_rng(0).normal(size=(6, 3)) * 1e-3
    vertices[5] = vertices[0]
    (tmp_path / "MODEL_DATASET").mkdir()
    savemat(tmp_path / "MODEL_DATASET/x.mat", {"V": vertices, "F": [[1, 2, 3], [4, 5, 6]]})
    (item,) = items("interest_points", tmp_path)
    mesh = parse(item.content(), item.suffix)
    np.testing.assert_array_equal(mesh.vertices, vertices)
    assert mesh.faces.tolist() == [[0, 1, 2], [3, 4, 5]]


def test_a_file_that_is_sent_to_another_machine_takes_its_content_along(tmp_path):
    (tmp_path / "a.obj").write_bytes(b"v 0 0 0")
    (tmp_path / "b.obj").write_bytes(b"gone")
    first, second = (Content((tmp_path / name).read_bytes) for name in ("a.obj", "b.obj"))
    (tmp_path / "b.obj").unlink()
    sent, unreadable = pickle.loads(pickle.dumps([first, second]))
    (tmp_path / "a.obj").unlink()
    assert sent() == b"v 0 0 0"
    with pytest.raises(FileNotFoundError):
        unreadable()


def test_a_file_that_is_no_model_is_refused_with_its_reason(tmp_path):
    (tmp_path / "MODEL_DATASET").mkdir()
    (tmp_path / "MODEL_DATASET/x.mat").write_bytes(b"nothing")
    savemat(tmp_path / "MODEL_DATASET/y.mat", {"V": np.eye(3)})
    savemat(tmp_path / "MODEL_DATASET/z.mat", {"V": np.eye(3), "F": "none"})
    first, second, third = items("interest_points", tmp_path)
    with pytest.raises(MeshError, match="unreadable as a MATLAB file"):
        first.content()
    with pytest.raises(MeshError, match="has no variable F"):
        second.content()
    with pytest.raises(MeshError, match="V and F must be numeric"):
        third.content()


@pytest.mark.parametrize(
    ("source", "place"),
    [
        ("gaze", "GitHub: FandosA/3D_Mesh_Saliency"),
        ("princeton", "https://segeval"),
        ("interest_points", "https://www.itl.nist"),
    ],
)
def test_an_absent_or_foreign_archive_is_named_with_the_remedy(archives, source, place):
    for folder in ("", archives / "gone.zip"):
        with pytest.raises(FetchError, match=f"not hold the {source} data: get .* from {place}.*set meshes.folder"):
            items(source, folder)
    (archives / "other").mkdir()
    (archives / "other/readme.txt").write_text("")
    with pytest.raises(FetchError, match="none of the 1 files is called .*: is it the published archive"):
        items(source, archives / "other")


@pytest.mark.skipif(not (SHARED / "psb.zip").exists(), reason="../shared/data is not there")
def test_the_published_archives_hold_what_the_sources_promise():
    meshes = items("princeton", SHARED / "psb.zip")
    assert len(meshes) == 114 and len({item.name for item in meshes}) == 114
    assert len(items("gaze", SHARED / "gaze.zip")) == 19
