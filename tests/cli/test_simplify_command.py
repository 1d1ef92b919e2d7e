"""`haptic-glance simplify MESH`: a person's own mesh, from file to file."""

from pathlib import Path

import numpy as np
import pytest
import trimesh
from PIL import Image

from haptic_glance.lod import colour_error, metro, simplify
from haptic_glance.lod.export import write_any
from haptic_glance.lod.feasibility import SimplifyError
from haptic_glance.lod.measures import fewest_faces
from haptic_glance.lod.perceptual import within_frame
from haptic_glance.lod.task import repaired
from haptic_glance.look.views import TWELVE, render
from haptic_glance.mesh import load
from haptic_glance.mesh.mesh import Mesh, Texture

from .conftest import PLACE, SIZE, bowl, bumpy

CHECKS = np.kron(np.indices((8, 8)).sum(axis=0) % 2, np.ones((8, 8), int))  # of 64 pixels


def rows(table):
    """dict first words -> last words of the lines of a table."""
    return {line[:32].strip(): line[32:].split() for line in table.splitlines()}


def textured():
    """The ball wrapped in a picture by its directions, as an OBJ with material and picture would hold it."""
    mesh = bumpy()
    away = mesh.vertices[mesh.faces] - PLACE
    uv = np.stack([0.5 + away[..., 0] / 100, 0.5 + away[..., 1] / 100], axis=-1)
    picture = np.dstack([255 * CHECKS, 0 * CHECKS, 255 - 255 * CHECKS, 0 * CHECKS + 255]).astype(np.uint8)
    return Mesh(mesh.vertices, mesh.faces, None, Texture(uv, np.zeros(len(mesh.faces)), (picture,)))


def test_result_has_the_faces_and_stands_where_the_mesh_stood_with_its_kept_places(simplified):
    mesh = bumpy()
    simple, table, messages = simplified("--faces", "40%", "--neighbourhood", "fixed", "--keep", 3, "--rings", 2)
    assert len(simple.faces) == 512 and simple.watertight and metro(mesh, simple)["mean"] < 0.005
    top = mesh.rings([mesh.vertices[:, 2].argmax()], 2)
    away = np.linalg.norm(simple.vertices[:, None] - mesh.vertices[top], axis=2).min(axis=0)
    assert away.max() < 1e-7 * SIZE
    assert rows(table)["faces"] == ["1,280", "512", "512"] and rows(table)["points kept"] == ["3", "3", "-"]
    assert all(value != "-" for value in rows(table)["1 - SSIM of the pictures"][1:])
    assert "z up, as the file says" in messages and "border" not in table


@pytest.mark.slow
def test_tolerance_gives_a_small_mesh_within_it_or_the_mesh_itself(simplified):
    simple, _, messages = simplified("--tolerance", "0.5%")
    assert metro(bumpy(), simple)["mean"] <= 0.005 and len(simple.faces) < 500
    assert "faces: " in messages and "simplifying to 0.5 % of the diagonal" in messages
    simple, table, messages = simplified("--tolerance", "1e-9")
    assert len(simple.faces) == 1280 and rows(table)["faces"][1] == "1,280"
    assert "no simplified mesh is within the tolerance" in messages


def test_attributes_that_count_come_out_closer(simplified, tmp_path):
    mesh = bumpy()
    colors = np.repeat(np.where(mesh.vertices[:, [2]] > PLACE[2] + 3, 255, 0), 3, axis=1)
    painted = Mesh(mesh.vertices, mesh.faces, colors)
    write_any(tmp_path / "painted.ply", painted)
    options = "--faces", 400, "--attributes", "colors=1"
    simple, table, _ = simplified(*options, source=tmp_path / "painted.ply", out="out.ply")
    ours, plain = map(float, rows(table)["colours, of 255"][1:])
    assert ours < plain / 3 and len(simple.faces) == 400
    assert colour_error(painted, simple) == pytest.approx(ours, rel=0.2)


@pytest.mark.parametrize("out", ["out.glb", "out.obj"])
def test_pictures_go_along(simplified, tmp_path, out):
    mesh = textured()
    write_any(tmp_path / "wrapped.obj", mesh)
    simple, table, messages = simplified("--faces", 500, source=tmp_path / "wrapped.obj", out=out)
    assert float(rows(table)["colours, of 255"][1]) > 0 and messages.count("--attributes uv=1") == 1
    assert len(simple.faces) == 500 and simple.watertight
    assert (simple.texture.images[0] == mesh.texture.images[0]).all()
    standing = simple.vertices * [1, -1, 1] if out == "out.obj" else simple.vertices[:, [0, 2, 1]]  # a GLB is y up
    want = 0.5 + (standing[simple.faces][..., :2] * [1, -1] - PLACE[:2]) / 100
    assert np.abs(simple.texture.uv - want).max() < 0.02


@pytest.mark.slow
def test_picture_shows_before_and_after(simplified, tmp_path):
    simplified("--faces", 300, "--picture", tmp_path / "seen.png")
    image = np.asarray(Image.open(tmp_path / "seen.png").convert("RGB")).astype(int)
    thirds = np.array_split(image, 3, axis=1)
    assert min((third < 200).any(axis=2).mean() for third in thirds) > 0.1
    coloured = [np.abs(third[..., 0] - third[..., 2]).mean() for third in thirds]
    assert coloured[0] > 2 * max(coloured[1:])


def test_without_options_the_saliency_weighs_nothing_is_frozen_and_equal_commands_give_equal_bytes(
    simplified, monkeypatch, tmp_path
):
    weights = []

    def watched(*arguments, weights=None, real=simplify, seen=weights, **options):
        seen.append(weights)
        return real(*arguments, weights=weights, **options)

    monkeypatch.setattr("haptic_glance.lod.task.simplify", watched)
    _, table, _ = simplified("--faces", 300, out="a.glb")
    ours, plain = weights
    assert plain is None and np.ptp(ours) > 0.5 and len(ours) == len(bumpy().vertices)
    assert "height-soft" in table and "plain QEM" in table and "points kept" not in table
    simplified("--faces", 300, out="b.glb")
    assert (tmp_path / "a.glb").read_bytes() == (tmp_path / "b.glb").read_bytes()
    assert "plain QEM" not in simplified("--faces", 300, "--method", "qem")[1]


def test_open_borders_that_stay_are_counted_with_what_they_allow(simplified, tmp_path):
    mesh, edges = bowl()
    write_any(tmp_path / "bowl.ply", mesh)
    _, table, _ = simplified("--faces", 400, source=tmp_path / "bowl.ply")
    assert rows(table)["border edges kept"] == [str(edges), str(edges), "-"]
    least = int(rows(table)["fewest faces that keep them"][1])
    simplified("--faces", least, source=tmp_path / "bowl.ply")
    with pytest.raises(ValueError, match=f"since {edges} boundary edges are frozen: ask for {least:,} faces or"):
        simplified("--faces", least - 1, source=tmp_path / "bowl.ply")


def test_borders_between_materials_that_are_given_up_are_counted(simplified, tmp_path):
    mesh = textured()
    plain = np.full((1, 1, 4), 255, dtype=np.uint8)
    upper = (mesh.vertices[mesh.faces].mean(axis=1)[:, 2] > PLACE[2]).astype(int)
    texture = Texture(mesh.texture.uv, upper, (*mesh.texture.images, plain))
    write_any(tmp_path / "two.glb", Mesh(mesh.vertices, mesh.faces, None, texture))
    _, table, _ = simplified("--faces", 500, source=tmp_path / "two.glb")
    edges = rows(table)["border edges kept"]
    assert int(edges[0]) > 20 and edges[0] == edges[1]
    few = int(rows(table)["fewest faces that keep them"][1]) // 2
    _, table, _ = simplified("--faces", few, source=tmp_path / "two.glb")
    assert int(rows(table)["border edges kept"][1]) < int(edges[1])


def test_a_soup_of_doubled_faces_is_joined_and_simplified(simplified, tmp_path):
    mesh = bumpy()
    corners = np.repeat(mesh.vertices[mesh.faces], 2, axis=0).reshape(-1, 3)
    write_any(tmp_path / "soup.ply", Mesh(corners, np.arange(len(corners)).reshape(-1, 3)))
    simple, table, messages = simplified("--faces", 300, source=tmp_path / "soup.ply")
    assert len(simple.faces) == 300 and simple.watertight and rows(table)["faces"][0] == "1,280"
    assert "1280 duplicate faces removed" in messages
    assert f"{6 * 1280 - len(mesh.vertices):,} coincident vertices merged" in messages


def test_vertices_are_joined_only_where_that_closes_edges():
    mesh = bumpy()
    assert repaired(mesh)[1] == []
    far = Mesh(np.r_[mesh.vertices, mesh.vertices], np.r_[mesh.faces, mesh.faces[:, ::-1] + len(mesh.vertices)])
    assert len(repaired(far)[0].vertices) == len(far.vertices)  # two closed surfaces in one place
    assert len(repaired(bowl()[0])[0].vertices) == len(mesh.vertices)


def smooth():
    ball = trimesh.creation.icosphere(subdivisions=3)
    return Mesh(0.5 * ball.vertices, ball.faces)


def test_meshes_within_the_frame_are_left_and_others_shrink_by_the_same():
    ball = smooth()
    fits = Mesh(1.04 * ball.vertices, ball.faces)
    same, scale = within_frame([ball, fits])
    assert scale == 1 and same[0] is ball and same[1] is fits
    (small, smaller), scale = within_frame([Mesh(3 * ball.vertices, ball.faces), ball])
    assert np.allclose(small.vertices, 3 * scale * ball.vertices)
    assert np.allclose(smaller.vertices, scale * ball.vertices)
    for viewpoint in TWELVE:
        assert render(small, viewpoint, (60, 80)).mask.any()  # render refuses what the picture would crop


def test_interrupted_writing_leaves_no_part_of_the_files(tmp_path, monkeypatch):
    written = []

    def interrupted(path, content, real=Path.write_bytes):
        written.append(path)
        if len(written) == 2:
            raise KeyboardInterrupt
        return real(path, content)

    monkeypatch.setattr(Path, "write_bytes", interrupted)
    with pytest.raises(KeyboardInterrupt):
        write_any(tmp_path / "wrapped.obj", textured())
    assert len(written) == 2 and not list(tmp_path.iterdir())


def test_smaller_neighbourhoods_make_the_target_feasible(simplified):
    simple, table, _ = simplified("--faces", 90, "--neighbourhood", "fixed", "--keep", 9, "--shrink")
    assert len(simple.faces) <= 90
    assert int(rows(table)["fewest faces that keep them"][1].replace(",", "")) > 90


@pytest.mark.slow
def test_fewest_faces_are_found_to_two_per_cent():
    mesh, errors = bumpy(), {}

    def moved(faces):  # a stand-in for simplification, whose error is one over the count
        shifted = Mesh(mesh.vertices + mesh.vertex_normals * mesh.diagonal / faces, mesh.faces)
        errors[faces] = metro(mesh, shifted)["mean"]
        return shifted

    fewest_faces(mesh, moved, 4, 0.01)
    passed, failed = ([n for n, e in errors.items() if (e <= 0.01) == wanted] for wanted in (True, False))
    assert max(failed) < min(passed) <= 1.02 * max(failed) + 1
    assert len(errors) < 20
    counts = []
    fewest_faces(mesh, lambda faces: counts.append(faces) or mesh, 40, 0.01)
    assert counts == [40]  # the lowest count at once, where it is good enough


def test_nothing_sound_means_the_mesh_itself():
    mesh = bumpy()

    def fails(faces):
        raise SimplifyError("folded")

    assert fewest_faces(mesh, fails, 4, 0.01) is mesh
    with pytest.raises(ValueError, match="tolerance"):
        fewest_faces(mesh, fails, 4, np.nan)


def test_small_units_keep_their_digits(tmp_path):
    mesh = bumpy()
    tiny = Mesh(1e-6 * (mesh.vertices - PLACE), mesh.faces)
    write_any(tmp_path / "tiny.obj", tiny)
    assert np.abs(load(tmp_path / "tiny.obj").vertices - tiny.vertices).max() < 1e-8 * tiny.diagonal
