"""The published gaze files: read, matched with the mesh by coordinates, foreign ones refused with their distances."""

import io
import zipfile
from pathlib import Path

import numpy as np
import pytest
import trimesh

from haptic_glance.mesh.files import parse
from haptic_glance.mesh.mesh import Mesh
from stages.weights.gaze import gaze_on_vertices, match_rows, read_gaze

ARCHIVE = Path(__file__).parents[2] / "../shared/data/gaze.zip"
BALL = trimesh.creation.icosphere(2)
MESH = Mesh(BALL.vertices, BALL.faces)
# What the rows of each published file match: alien2, car and jessi are sub-sampled, MaxPlanck, meca and sofa padded.
MATCHED = {"MaxPlanck": 19999, "meca": 15000, "sofa": 15162}


def table(positions, seconds):
    """A file in the published layout, its rows shuffled."""
    rows = np.c_[positions, positions, seconds, np.asarray(seconds) > 1]
    stream = io.BytesIO()
    np.savetxt(stream, np.random.default_rng(0).permutation(rows), fmt="%.18e")
    return stream.getvalue()


def test_shuffled_rows_come_back_on_their_vertices():
    seconds = np.random.default_rng(1).exponential(size=len(MESH.vertices))
    positions, normals, read = read_gaze(table(MESH.vertices, seconds))
    assert positions.shape == normals.shape == (len(seconds), 3)
    np.testing.assert_array_equal(gaze_on_vertices(MESH, positions, read), seconds)


def test_a_path_reads_like_bytes(tmp_path):
    (tmp_path / "a.txt").write_bytes(table(MESH.vertices, np.ones(162)))
    np.testing.assert_array_equal(read_gaze(tmp_path / "a.txt")[0], read_gaze(table(MESH.vertices, np.ones(162)))[0])


def test_rows_at_one_place_add_up_and_its_vertices_share_them():
    doubled = Mesh(np.r_[MESH.vertices, MESH.vertices[:1]], MESH.faces)
    rows = np.r_[MESH.vertices, MESH.vertices[:1]]
    amounts = gaze_on_vertices(doubled, rows, np.ones(len(rows)))
    assert amounts[0] == amounts[-1] == 1 and amounts.sum() == len(rows)


def test_made_up_rows_are_left_out_and_named():
    middles = (MESH.vertices[MESH.faces[:40, 0]] + MESH.vertices[MESH.faces[:40, 1]]) / 2
    positions, seconds = np.r_[MESH.vertices, middles], np.ones(len(MESH.vertices) + 40)
    vertex, distance = match_rows(MESH, positions)
    assert (vertex[:162] == np.arange(162)).all() and (vertex[162:] == -1).all() and distance[162:].min() > 0.1
    assert gaze_on_vertices(MESH, positions, seconds).sum() == 162


def test_tolerance_takes_rounded_rows_in():
    rounded = MESH.vertices.round(6)
    assert gaze_on_vertices(MESH, rounded, np.ones(162), tolerance=1e-5).sum() == 162
    with pytest.raises(ValueError, match="match no vertex"):
        gaze_on_vertices(MESH, rounded + 3e-6, np.ones(162))


def test_gaze_of_another_mesh_is_refused_with_its_distances():
    with pytest.raises(ValueError, match=r"162 of 162 gaze rows match no vertex and 162 are off .* line \d+: 57\.7"):
        gaze_on_vertices(MESH, MESH.vertices * 3, np.ones(162))


def test_one_row_far_off_is_named():
    rows = MESH.vertices.copy()
    rows[100] *= 2
    with pytest.raises(ValueError, match=r"1 of 162 .* 1 are off the mesh.* line 101: "):
        gaze_on_vertices(MESH, rows, np.ones(162))


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (b"1 2 3\n", "8 columns, got 1 rows of 3"),
        (b" \n", "is empty"),
        (b"a b c d e f g h\n", "not a gaze file of numbers"),
        (b"0 0 0 0 0 1 1 0\n0 0 0 0 0 1 nan 0\n", "line 2"),
        (b"0 0 0 0 0 1 -1 0\n", "negative seconds"),
        (b"1 1 1 1 1 1 1 1\n1 1\n", "not a gaze file of numbers"),
    ],
)
def test_a_damaged_file_is_named(content, reason):
    with pytest.raises(ValueError, match=reason):
        read_gaze(content)


@pytest.mark.slow
@pytest.mark.skipif(not ARCHIVE.exists(), reason="../shared/data/gaze.zip is not there")
@pytest.mark.parametrize("member", ["test/jessi", "train/meca", "train/sofa", "train/bunny"])
def test_published_files_match_their_meshes_digit_by_digit(member):
    name = member.split("/")[1]
    with zipfile.ZipFile(ARCHIVE) as archive:
        positions, _, seconds = read_gaze(archive.read(f"dataset_{member}.txt"))
        mesh = parse(archive.read(f"Models_3D/{name}.obj"), ".obj")
    matched = match_rows(mesh, positions)[0] >= 0
    assert matched.sum() == MATCHED.get(name, 20000)
    assert gaze_on_vertices(mesh, positions, seconds).sum() == pytest.approx(seconds[matched].sum())
