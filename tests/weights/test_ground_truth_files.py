"""Published files of attention (gaze, fixation maps, interest points): read, matched with the mesh, damage named."""

import io
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
from haptic_glance.mesh.mesh import Mesh
from stages.meshes.sources import FIXATION_MAPS, SOURCES, collection_files, match_files
from stages.weights.gaze import fixation_files, fixations_on_vertices, gaze_on_vertices, match_rows, read_gaze
from stages.weights.ground_truth import ground_truth_amounts, published_files, read_interest_points

ARCHIVE = Path(__file__).parents[2] / "../shared/data/gaze.zip"
BALL = trimesh.creation.icosphere(2)
MESH = Mesh(BALL.vertices, BALL.faces)
TRIANGLE = Mesh(np.eye(3), np.array([[0, 1, 2]]))


def table(positions, seconds):
    """A file of gaze in the published layout, its rows shuffled."""
    rows = np.c_[positions, positions, seconds, np.asarray(seconds) > 1]
    stream = io.BytesIO()
    np.savetxt(stream, np.random.default_rng(0).permutation(rows), fmt="%.18e")
    return stream.getvalue()


def test_shuffled_rows_come_back_on_their_vertices(tmp_path):
    seconds = np.random.default_rng(1).exponential(size=len(MESH.vertices))
    (tmp_path / "a.txt").write_bytes(table(MESH.vertices, seconds))
    for source in (table(MESH.vertices, seconds), tmp_path / "a.txt"):
        positions, normals, read = read_gaze(source)
        assert positions.shape == normals.shape == (len(seconds), 3)
        np.testing.assert_array_equal(gaze_on_vertices(MESH, positions, read), seconds)


def test_tables_of_other_programs_are_read():
    plain = b"".join(b"%.3f %d 2.5 0 0 1 0.25 0\n" % (i / 8, i) for i in range(5))
    header = b"X Y Z nx ny nz Duration label\n"
    for content in (
        b"\xef\xbb\xbf" + plain,
        plain.decode().encode("utf-16"),
        header + plain,
        header.replace(b"X Y Z", b"pos_x pos_y pos_z") + plain,
        plain.replace(b" ", b", "),
        plain.replace(b".", b","),
        (header + plain.replace(b".", b",")).replace(b" ", b";"),
    ):
        for expected, values in zip(read_gaze(plain), read_gaze(content), strict=True):
            assert np.array_equal(values, expected)


def test_rows_that_a_program_has_rounded_are_of_the_nearest_vertex(tmp_path):
    (tmp_path / "Models_3D").mkdir()
    (tmp_path / "dataset_x").mkdir()
    (tmp_path / "Models_3D/ball.obj").write_text(BALL.export(file_type="obj", digits=17))
    (tmp_path / "dataset_x/ball.txt").write_bytes(table(MESH.vertices.round(3), np.arange(162)))
    files = published_files("gaze", tmp_path)["ball"]
    assert ground_truth_amounts("ball", "gaze", MESH, files).tolist() == list(range(162))
    (tmp_path / "dataset_x/ball.txt").write_bytes(table(MESH.vertices * 25.4, np.arange(162)))
    with pytest.raises(ValueError, match=r"^dataset_x/ball.txt: 162 of 162 .* The rows are 25.4 times as large"):
        ground_truth_amounts("ball", "gaze", MESH, files)


def test_readmes_and_licences_are_no_objects():
    names = "dataset_a/README.txt", "dataset_a/ball.txt", "dataset_b/read_me.txt", "dataset_b/License.txt"
    assert list(match_files(dict.fromkeys(names, bytes), r"dataset_[^/]+/([^/]+)\.txt")) == ["ball"]


def test_rows_at_one_place_add_up_and_its_vertices_share_them():
    doubled = Mesh(np.r_[MESH.vertices, MESH.vertices[:1]], MESH.faces)
    rows = np.r_[MESH.vertices, MESH.vertices[:1]]
    amounts = gaze_on_vertices(doubled, rows, np.ones(len(rows)))
    assert amounts[0] == amounts[-1] == 1 and amounts.sum() == len(rows)


def test_made_up_rows_are_left_out_and_rounded_ones_are_taken_in_by_tolerance():
    middles = (MESH.vertices[MESH.faces[:40, 0]] + MESH.vertices[MESH.faces[:40, 1]]) / 2
    positions, seconds = np.r_[MESH.vertices, middles], np.ones(len(MESH.vertices) + 40)
    vertex, distance = match_rows(MESH, positions)
    assert (vertex[:162] == np.arange(162)).all() and (vertex[162:] == -1).all() and distance[162:].min() > 0.1
    assert gaze_on_vertices(MESH, positions, seconds).sum() == 162
    assert gaze_on_vertices(MESH, MESH.vertices.round(6), np.ones(162), tolerance=1e-5).sum() == 162


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: gaze_on_vertices(MESH, MESH.vertices.round(6) + 3e-6, np.ones(162)), "match no vertex"),
        (
            lambda: gaze_on_vertices(MESH, MESH.vertices * 3, np.ones(162)),
            r"162 of 162 gaze rows match no vertex and 162 are off .* row \d+: 57\.7",
        ),
        (
            lambda: gaze_on_vertices(
                MESH, np.r_[MESH.vertices[:100], 2 * MESH.vertices[100:101], MESH.vertices[101:]], np.ones(162)
            ),
            r"1 of 162 .* 1 are off the mesh.* row 101: ",
        ),
        (lambda: read_gaze(b"1 2 3\n"), "8 columns, got 1 rows of 3"),
        (lambda: read_gaze(b" \n"), "is empty"),
        (lambda: read_gaze(b"?0 0 0 0 0 1 1 0\n0 0 0 0 0 1 1 0\n"), "line 1 is no row of numbers, and no header: "),
        (lambda: gaze_on_vertices(MESH, np.empty((0, 3)), np.empty(0)), "no row of gaze"),
        (lambda: read_gaze(b"a b c d e f g h\n"), "not a gaze file of numbers"),
        (lambda: read_gaze(b"0 0 0 0 0 1 1 0\n0 0 0 0 0 1 nan 0\n"), "line 2"),
        (lambda: read_gaze(b"0 0 0 0 0 1 -1 0\n"), "negative seconds"),
        (lambda: read_gaze(b"1 1 1 1 1 1 1 1\n1 1\n"), "not a gaze file of numbers"),
        (lambda: read_gaze(b"x,y,z,nx,ny,nz,label,Duration_ms\n0,0,0,0,0,1,1,250\n"), "order them as x y z nx ny nz"),
        (lambda: read_gaze(b"# x y z nx ny nz label seconds\n0 0 0 0 0 1 1 0\n"), "its columns are x y z nx ny nz lab"),
        (lambda: read_gaze(b"x y z nx ny nz s l\n0 0 0 0 0 1 nan 0\n"), "the first in line 2: remove them, or write 0"),
        (lambda: gaze_on_vertices(MESH, MESH.vertices * 1000, np.ones(162)), "The rows are 1000 times as large as the"),
        (lambda: gaze_on_vertices(MESH, MESH.vertices, np.full(162, np.nan)), "positions must be finite, and sec"),
    ],
)
def test_wrong_arguments_are_named_with_what_is_right(call, words):
    with pytest.raises(ValueError, match=words):
        call()


@pytest.mark.slow
@pytest.mark.skipif(not ARCHIVE.exists(), reason="../shared/data/gaze.zip is not there")
@pytest.mark.parametrize(("member", "count"), [("test/jessi", 20000), ("train/meca", 15000)])  # sub-sampled, and padded
def test_published_files_match_their_meshes_digit_by_digit(member, count):
    with zipfile.ZipFile(ARCHIVE) as archive:
        positions, _, seconds = read_gaze(archive.read(f"dataset_{member}.txt"))
        mesh = parse(archive.read(f"Models_3D/{member.split('/')[1]}.obj"), ".obj")
    matched = match_rows(mesh, positions)[0] >= 0
    assert matched.sum() == count
    assert gaze_on_vertices(mesh, positions, seconds).sum() == pytest.approx(seconds[matched].sum())


DENSITIES = {"300": [0.0, 1.5, 8.25], "413": [2.0, 0.0, 0.0], "599": [0.0, 0.0, 3e-3]}


@pytest.fixture
def folder(tmp_path):
    """Lavoue's fixation density maps of one object from three views, in files of the published layout."""
    (tmp_path / "FixationMaps").mkdir()
    (tmp_path / "CentricityAndVisibilityMaps").mkdir()
    for view, density in DENSITIES.items():
        lines = "\n".join(map(str, density))
        (tmp_path / f"FixationMaps/car-vasa_{view}norm.txt").write_text(lines + "\n")
        seen = "\r\n".join(str(int(value > 0)) for value in density)
        (tmp_path / f"CentricityAndVisibilityMaps/car-vasa_{view}_visibility.txt").write_text(seen)
        centre = tmp_path / f"CentricityAndVisibilityMaps/car-vasa_{view}_100_CentricityObject_NewCalculation.txt"
        centre.write_text("1\n1\n1\n")
    return tmp_path


def looked(path, mesh=TRIANGLE):
    return fixations_on_vertices(fixation_files(collection_files(path, *FIXATION_MAPS))["car-vasa"], mesh)


def test_a_vertex_has_the_mean_of_the_views_that_see_it_by_its_area(folder):
    expected = np.array([2.0, 1.5, (8.25 + 3e-3) / 2]) * TRIANGLE.vertex_areas
    np.testing.assert_allclose(looked(folder), expected)
    with zipfile.ZipFile(folder / "all.zip", "w") as archive:
        for path in folder.rglob("*.txt"):
            archive.write(path, f"3DVA/{path.relative_to(folder)}")
    assert looked(folder / "all.zip").tolist() == looked(folder).tolist()
    for view in DENSITIES:
        (folder / f"CentricityAndVisibilityMaps/car-vasa_{view}_visibility.txt").write_text("1\n0\n1\n")
    assert looked(folder)[1] == 0 and looked(folder)[0] > 0  # no view sees the second


@pytest.mark.parametrize(
    ("text", "mesh", "says"),
    [
        ("1\nx\n2\n", TRIANGLE, "car-vasa_300norm.txt.*one number"),
        ("1\nnan\n2", TRIANGLE, "car-vasa_300norm.txt.*NaN"),
        ("1\n-1\n2", TRIANGLE, "car-vasa_300norm.txt.*neg"),
        ("1\n1\n2", Mesh(np.eye(4)[:, :3], TRIANGLE.faces), "car-vasa_300norm.txt has 3 values for 4 vertices"),
    ],
)
def test_a_damaged_or_absent_map_is_named(folder, text, mesh, says):
    (folder / "FixationMaps/car-vasa_300norm.txt").write_text(text)
    with pytest.raises(ValueError, match=says):
        looked(folder, mesh)
    (folder / "CentricityAndVisibilityMaps/car-vasa_599_visibility.txt").unlink()
    with pytest.raises(ValueError, match="no CentricityAndVisibilityMaps/car-vasa_599_visibility.txt"):
        looked(folder)


def test_the_set_reads_its_meshes_and_their_truth(folder):
    (folder / "3DModels-Simplif").mkdir()
    (folder / "3DModels-Simplif/car-vasa.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    (file,) = SOURCES["fixation_maps"](SimpleNamespace(folder=str(folder), objects=[], up="y"))
    assert (file.name, file.up, file.suffix) == ("car-vasa", "y", ".obj") and file.content().startswith(b"v 0 0 0")
    published = published_files("fixation_maps", folder)["car-vasa"]
    amounts = ground_truth_amounts("car-vasa", "fixation_maps", TRIANGLE, published)
    np.testing.assert_array_equal(amounts, looked(folder))
    with pytest.raises(FetchError, match="nowhere.*FixationMaps.zip.*https://perso.liris.cnrs.fr") as caught:
        looked(folder / "nowhere")
    assert "\n" not in str(caught.value)


def interest_points(most=16):
    """GT_MODEL of NIST: at radius r and least users n the points are r + n + 1..., the marks n and n + 1."""
    cells = np.empty((10, most - 1, 2), dtype=object)
    for radius in range(10):
        for users in range(2, most + 1):
            clusters = np.empty((1, 2), dtype=object)
            clusters[0] = ["  ".join(["7"] * users), "  ".join(["123"] * (users + 1))]
            cells[radius, users - 2] = np.array([[radius + users + 1, radius + users + 101]], dtype=float), clusters
    return cells


def stored(**variables):
    stream = io.BytesIO()
    savemat(stream, variables)
    return stream.getvalue()


def test_points_and_marks_of_a_radius_and_number_of_users(tmp_path):
    (tmp_path / "ant.mat").write_bytes(stored(GT_MODEL=interest_points()))
    for sigma, users in ((0.03, 8), (0.01, 2), (0.1, 16)):
        vertices, marks = read_interest_points(tmp_path / "ant.mat", sigma, users)
        radius = round(sigma * 100) - 1
        assert vertices.tolist() == [radius + users, radius + users + 100]  # counted from 0, where MATLAB counts from 1
        assert marks.tolist() == [users, users + 1] and vertices.dtype == marks.dtype == np.int64


def test_one_point_or_none_that_enough_users_marked_are_no_error():
    cells, cluster = interest_points(), np.empty((1, 1), dtype=object)
    cells[2, 6] = np.zeros((0, 0)), np.empty((0, 0), dtype=object)
    assert [len(part) for part in read_interest_points(stored(GT_MODEL=cells))] == [0, 0]
    cluster[0, 0] = "12  13  14"
    cells[2, 6] = np.array([[12.0]]), cluster
    assert [part.tolist() for part in read_interest_points(stored(GT_MODEL=cells))] == [[11], [3]]


def test_other_files_and_settings_are_refused_with_the_reason():
    odd = interest_points()
    odd[2, 6, 0] = np.array([[4.0]])
    small = stored(GT_MODEL=interest_points(most=5))
    for content, settings, error, message in (
        (b"\x89HDF\r\n\x1a\n" + b"\0" * 600, (), MeshError, "unreadable as a MATLAB file"),
        (stored(V=np.eye(3)), (), MeshError, "no variable GT_MODEL"),
        (stored(GT_MODEL=np.eye(3)), (), ValueError, "10 radii by users"),
        (stored(GT_MODEL=odd), (), ValueError, "1 points.* 2 clusters"),
        (small, (0.035, 3), ValueError, "sigma 0.035 is not one of 0.01, 0.02"),
        (small, (0.03, 6), ValueError, r"2\.\.5.* got 6"),
    ):
        with pytest.raises(error, match=message):
            read_interest_points(content, *settings)
