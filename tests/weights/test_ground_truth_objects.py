"""The truth of an object by its collection, our own marks checked against the mesh, and the truth in views of it."""

import io
import zipfile
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import trimesh
from scipy.io import savemat

from haptic_glance.mesh import clean, normalise
from haptic_glance.mesh.files import parse
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.repair import rotate_to_z_up
from stages.meshes.sources import SOURCES
from stages.weights.ground_truth import digest, ground_truth_amounts, ground_truth_files

BALL = trimesh.creation.icosphere(2)
MESH = normalise(Mesh(BALL.vertices, BALL.faces))
SMALL = Mesh(np.eye(3), [(0, 1, 2)])


def marks(path, rows, shift=0.0):
    lines = ["annotator,time,vertex,x,y,z"]
    for annotator, vertex in rows:
        place = MESH.vertices[vertex] + (shift, 0, 0)
        lines.append(f"{annotator},2026-11-20T10:00:00.000Z,{vertex}," + ",".join(f"{x:.6f}" for x in place))
    path.write_text("\n".join(lines) + "\n")


def amounts_of(name, source, mesh, folder):
    return ground_truth_amounts(name, source, mesh, files_of([name], source, folder, mesh).get(name, []))


def files_of(names, source, folder, mesh=MESH):
    return ground_truth_files(((name, mesh) for name in names), source, folder, folder)


def test_marks_count_the_annotators_at_each_vertex(tmp_path):
    assert amounts_of("ball", "household", MESH, tmp_path) is None
    marks(tmp_path / "ball.csv", [("a", 3), ("b", 3), ("c", 70)])
    amounts = amounts_of("ball", "household", MESH, tmp_path)
    assert amounts.dtype == np.float64 and np.flatnonzero(amounts).tolist() == [3, 70]
    assert amounts[3] == 2 and amounts[70] == 1


def test_marks_off_the_mesh_are_named_with_file_rows_and_distances(tmp_path):
    marks(tmp_path / "ball.csv", [("a", 3), ("b", 3)], shift=0.01 * MESH.diagonal - 1e-4)
    assert amounts_of("ball", "household", MESH, tmp_path).sum() == 2
    marks(tmp_path / "ball.csv", [("a", 3), ("b", 3)], shift=0.02 * MESH.diagonal)
    with pytest.raises(ValueError, match=r"ball\.csv: 2 of 2 marks are off .* row 1: 2\.00%, row 2: 2\.00%"):
        amounts_of("ball", "household", MESH, tmp_path)
    marks(tmp_path / "ball.csv", [("a", 3), ("a", 70)])
    with pytest.raises(ValueError, match=r"ball\.csv, row 2: vertex 70 is not in 0\.\.49"):
        amounts_of("ball", "household", Mesh(MESH.vertices[:50], [(0, 1, 2)]), tmp_path)


def test_marks_belong_to_the_mesh_that_they_fit_whatever_it_is_called(tmp_path):
    marks(tmp_path / "ball.csv", [("a", 3), ("a", 70)])
    turned = Mesh(MESH.vertices[::-1], MESH.faces)  # another mesh of the same name
    files = ground_truth_files([("scan", MESH), ("ball", turned), ("cube", turned)], "household", tmp_path, tmp_path)
    assert list(files) == ["scan"] and Path(files["scan"][0][0]).name == "ball.csv"
    assert ground_truth_amounts("scan", "household", MESH, files["scan"]).sum() == 2
    assert list(files_of(["ball", "scan"], "household", tmp_path)) == ["ball", "scan"]  # copies of one mesh
    marks(tmp_path / "ball.csv", [("a", 3)], shift=0.2)  # they fit no mesh, and are kept to be named
    assert list(files_of(["ball", "cube"], "household", tmp_path)) == ["ball"]


@pytest.mark.slow
def test_gaze_on_a_cloud_counts_where_its_surface_is_nearest(tmp_path):
    ball = trimesh.creation.icosphere(3)
    seconds = np.where(ball.vertices[:, 1] > 0.9, 1.0, 0.0)  # +y is up
    rows = "\n".join(" ".join(f"{x:.9f}" for x in row) for row in np.c_[ball.vertices, ball.vertices, seconds])
    with zipfile.ZipFile(tmp_path / "clouds.zip", "w") as archive:
        archive.writestr("ball.txt", rows)
        archive.writestr("broken.txt", rows.replace(" 1.000000000\n", " -1\n"))
    (item,) = SOURCES["gaze_clouds"](SimpleNamespace(folder=str(tmp_path / "clouds.zip"), objects=["ball"], up="z"))
    mesh = normalise(rotate_to_z_up(clean(parse(item.content(), item.suffix))[0], item.up))
    amounts = amounts_of("ball", "gaze_clouds", mesh, tmp_path / "clouds.zip")
    assert amounts.sum() == seconds.sum() > 0
    assert mesh.vertices[amounts > 0, 2].min() > 0.43
    with pytest.raises(ValueError, match=r"broken\.txt: .* negative seconds"):
        amounts_of("broken", "gaze_clouds", mesh, tmp_path / "clouds.zip")


def gaze_archive(path, names=("ball",)):
    """A zip in the published layout: a mesh standing with +y up, its rows shuffled, one made-up row."""
    turned = MESH.vertices[:, [1, 2, 0]].round(6)
    rows = np.c_[turned, turned, np.arange(162), np.zeros(162)]
    rows = np.r_[np.random.default_rng(0).permutation(rows), [[*turned[:2].mean(axis=0), 0, 0, 0, 50, 0]]]
    with zipfile.ZipFile(path, "w") as archive:
        for name in names:
            archive.writestr(f"Models_3D/{name}.obj", trimesh.Trimesh(turned, MESH.faces).export(file_type="obj"))
            archive.writestr(f"dataset_train/{name}.txt", "\n".join(" ".join(f"{x:.18e}" for x in row) for row in rows))
        archive.writestr("Models_3D/unseen.obj", archive.read("Models_3D/ball.obj"))
    return path


def test_gaze_follows_the_vertices_of_the_mesh_that_the_source_gives(tmp_path, capsys):
    archive = gaze_archive(tmp_path / "gaze.zip")
    (item,) = SOURCES["gaze"](SimpleNamespace(folder=str(archive), objects=["ball"], up="z"))
    mesh = normalise(rotate_to_z_up(clean(parse(item.content(), item.suffix))[0], item.up))
    np.testing.assert_allclose(mesh.vertices, MESH.vertices, atol=1e-5)  # the same vertices, turned to +z up
    assert amounts_of("ball", "gaze", mesh, archive).tolist() == list(range(162))
    assert "1 of 163 rows match no vertex and are left out, with 50 of 13091 s" in capsys.readouterr().err
    assert amounts_of("unseen", "gaze", mesh, archive) is None
    with pytest.raises(ValueError, match="162 vertices, this one 3"):
        amounts_of("ball", "gaze", SMALL, archive)


def test_a_digest_stands_for_the_gaze_and_the_mesh_of_an_object(tmp_path):
    def digests(path, names=("ball",)):
        return {name: digest(files) for name, files in files_of(names, "gaze", path).items()}

    before = digests(gaze_archive(tmp_path / "a.zip"), ["ball", "unseen", "cube"])
    assert list(before) == ["ball"]
    assert before == digests(gaze_archive(tmp_path / "b.zip", ["ball", "other"]))
    for file in ("Models_3D/ball.obj", "dataset_train/ball.txt"):
        with zipfile.ZipFile(tmp_path / "a.zip") as whole, zipfile.ZipFile(tmp_path / "c.zip", "w") as changed:
            for name in whole.namelist():
                changed.writestr(name, whole.read(name) + (b"\n" if name == file else b""))
        assert before != digests(tmp_path / "c.zip")


def test_interest_points_weigh_as_many_users_as_marked_them(tmp_path):
    cells, clusters = np.empty((10, 15, 2), dtype=object), np.empty((1, 2), dtype=object)
    clusters[0] = ["5  5  6", "9  9  9  9"]
    for radius in range(10):
        for users in range(15):
            cells[radius, users] = np.array([[6.0, 10.0]]), clusters
    stream = io.BytesIO()
    savemat(stream, {"GT_MODEL": cells})
    folder = tmp_path / "IP_BENCHMARK/OUTPUT_DATA/GROUND_TRUTH_B"
    folder.mkdir(parents=True)
    (folder / "ant.mat").write_bytes(stream.getvalue())
    amounts = amounts_of("ant", "interest_points", MESH, tmp_path)
    assert np.flatnonzero(amounts).tolist() == [5, 9] and amounts[[5, 9]].tolist() == [3, 4]
    assert amounts_of("cup", "interest_points", MESH, tmp_path) is None
    with pytest.raises(ValueError, match=r"GROUND_TRUTH_B/ant.mat names vertex 9, the mesh has 3"):
        amounts_of("ant", "interest_points", SMALL, tmp_path)
