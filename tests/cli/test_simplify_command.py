"""`haptic-glance simplify MESH`: a person's own mesh, from file to file."""

import functools
import os
import re
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import trimesh
from PIL import Image

from haptic_glance.base.extras import MissingExtra
from haptic_glance.cli import simplify as command
from haptic_glance.cli.simplify import parser, run, share
from haptic_glance.lod import colour_error, measures, metro, simplify
from haptic_glance.lod.export import FORMATS, to_trimesh, write_any
from haptic_glance.lod.feasibility import SimplifyError
from haptic_glance.lod.measures import fewest_faces
from haptic_glance.lod.perceptual import within_frame
from haptic_glance.lod.pictures import write_picture
from haptic_glance.lod.task import repaired
from haptic_glance.look.views import TWELVE, render
from haptic_glance.mesh import load
from haptic_glance.mesh.files import load_unnamed
from haptic_glance.mesh.mesh import Mesh, Texture

PLACE, SIZE = np.array([120.0, -40.0, 7.0]), 25.0
CHECKS = np.kron(np.indices((8, 8)).sum(axis=0) % 2, np.ones((8, 8), int))  # of 64 pixels


def bumpy():
    """A closed ball with bumps, of 1,280 faces, far from the origin and some fifty units wide."""
    ball = trimesh.creation.icosphere(subdivisions=3)
    x, y, z = ball.vertices.T
    radius = 1 + 0.08 * np.sin(5 * x) * np.cos(4 * y) + 0.15 * np.exp(-8 * ((z - 1) ** 2 + x**2))
    return Mesh(PLACE + SIZE * radius[:, None] * ball.vertices, ball.faces)


@pytest.fixture
def file(tmp_path):
    write_any(tmp_path / "ball.obj", bumpy())
    return tmp_path / "ball.obj"


@pytest.fixture
def simplified(file, tmp_path, capsys):
    """Function: runs the command with options and returns (Mesh that it wrote, what it said, what it reported)."""

    def work(*options, source=file, out="out.obj"):
        run([str(source), "--method", "height", "--out", str(tmp_path / out), *map(str, options)])
        said = capsys.readouterr()
        return load(tmp_path / out), said.out, said.err

    return work


def rows(table):
    """dict first words -> last words of the lines of a table."""
    return {line[:32].strip(): line[32:].split() for line in table.splitlines()}


@pytest.mark.slow
def test_result_has_the_faces_and_stands_where_the_mesh_stood(simplified):
    found, said, _ = simplified("--faces", 500, "--neighbourhood", "fixed", "--keep", 3)
    assert len(found.faces) == 500
    assert found.watertight
    assert metro(bumpy(), found)["mean"] < 0.005
    assert rows(said)["faces"] == ["1,280", "500", "500"]
    assert rows(said)["points kept"] == ["3", "3", "-"]
    assert all(value != "-" for value in rows(said)["1 - SSIM of the pictures"][1:])


@pytest.mark.slow
def test_kept_neighbourhoods_come_through(simplified):
    mesh = bumpy()
    found, _, _ = simplified("--faces", "40%", "--neighbourhood", "fixed", "--keep", 1, "--rings", 2)
    top = mesh.rings([mesh.vertices[:, 2].argmax()], 2)
    away = np.linalg.norm(found.vertices[:, None] - mesh.vertices[top], axis=2).min(axis=0)
    assert away.max() < 1e-7 * SIZE


@pytest.mark.slow
def test_tolerance_gives_a_small_mesh_within_it(simplified):
    found, _, said = simplified("--tolerance", "0.5%")
    assert metro(bumpy(), found)["mean"] <= 0.005
    assert len(found.faces) < 500
    assert "faces: " in said and "simplifying to 0.5 % of the diagonal" in said


@pytest.mark.slow
def test_colours_go_along(simplified, tmp_path):
    mesh = bumpy()
    height = (mesh.vertices[:, 2] - PLACE[2]) / SIZE
    colors = np.column_stack([100 + 60 * height, 90 - 40 * height, 30 + 0 * height]).round().astype(np.uint8)
    write_any(tmp_path / "painted.ply", Mesh(mesh.vertices, mesh.faces, colors))
    found, _, _ = simplified("--faces", 400, source=tmp_path / "painted.ply", out="out.ply")
    want = 100 + 60 * (found.vertices[:, 2] - PLACE[2]) / SIZE
    assert np.abs(found.colors[:, 0] - want).max() < 4


@pytest.mark.slow
def test_attributes_that_count_come_out_closer(simplified, tmp_path):
    mesh = bumpy()
    colors = np.repeat(np.where(mesh.vertices[:, [2]] > PLACE[2] + 3, 255, 0), 3, axis=1)
    painted = Mesh(mesh.vertices, mesh.faces, colors)
    write_any(tmp_path / "painted.ply", painted)
    options = "--faces", 400, "--attributes", "colors=1"
    found, said, _ = simplified(*options, source=tmp_path / "painted.ply", out="out.ply")
    assert len(found.faces) == 400
    ours, plain = map(float, rows(said)["colours, of 255"][1:])
    assert ours < plain / 3
    assert colour_error(painted, found) == pytest.approx(ours, rel=0.2)


@pytest.mark.parametrize(
    ("options", "message"),
    [(["colors=1"], "the mesh has no colors"), (["weight=1"], "unknown attribute 'weight'"),
     (["normals=0.1", "--backend", "pymeshlab"], "has no effect with --backend pymeshlab")],
)  # fmt: skip
def test_attributes_without_meaning_are_refused_before_the_work(simplified, options, message):
    with pytest.raises(ValueError, match=message):
        simplified("--faces", 500, "--attributes", *options)


def test_attributes_are_names_and_numbers(capsys):
    chosen = parser("x").parse_args(["in.stl", "--faces", "9", "--out", "o.stl", "--attributes", "uv=1, colors=.5"])
    assert chosen.attributes == {"uv": 1.0, "colors": 0.5}
    for wrong in ("uv", "uv=much", "uv=1=2", ""):
        with pytest.raises(SystemExit):
            parser("x").parse_args(["in.stl", "--faces", "9", "--out", "o.stl", "--attributes", wrong])
        assert "write names and weights such as" in capsys.readouterr().err


def textured():
    """The ball wrapped in a picture by its directions, as an OBJ with material and picture would hold it."""
    mesh = bumpy()
    away = mesh.vertices[mesh.faces] - PLACE
    uv = np.stack([0.5 + away[..., 0] / 100, 0.5 + away[..., 1] / 100], axis=-1)
    picture = np.dstack([255 * CHECKS, 0 * CHECKS, 255 - 255 * CHECKS, 0 * CHECKS + 255]).astype(np.uint8)
    return Mesh(mesh.vertices, mesh.faces, None, Texture(uv, np.zeros(len(mesh.faces)), (picture,)))


@pytest.mark.slow
@pytest.mark.parametrize("out", ["out.glb", "out.obj"])
def test_pictures_go_along(simplified, tmp_path, out):
    mesh = textured()
    write_any(tmp_path / "wrapped.obj", mesh)
    found, said, told = simplified("--faces", 500, source=tmp_path / "wrapped.obj", out=out)
    assert float(rows(said)["colours, of 255"][1]) > 0 and told.count("--attributes uv=1") == 1
    assert len(found.faces) == 500 and found.watertight
    assert (found.texture.images[0] == mesh.texture.images[0]).all()
    standing = found.vertices * [1, -1, 1] if out == "out.obj" else found.vertices[:, [0, 2, 1]]  # a GLB is y up
    want = 0.5 + (standing[found.faces][..., :2] * [1, -1] - PLACE[:2]) / 100
    assert np.abs(found.texture.uv - want).max() < 0.02


@pytest.mark.parametrize("suffix", [".glb", ".obj"])
def test_one_plain_material_is_kept(tmp_path, suffix):
    mesh = bumpy()
    red = np.array([[[200, 30, 30, 255]]], dtype=np.uint8)
    plain = Texture(np.zeros((len(mesh.faces), 3, 2)), np.zeros(len(mesh.faces)), (red,))
    write_any(tmp_path / f"red{suffix}", Mesh(mesh.vertices, mesh.faces, None, plain))
    assert (load(tmp_path / f"red{suffix}").texture.images[0] == red).all()


@pytest.mark.slow
def test_format_without_colours_says_so(simplified, tmp_path):
    write_any(tmp_path / "wrapped.obj", textured())
    _, _, said = simplified("--faces", 500, source=tmp_path / "wrapped.obj", out="out.stl")
    assert ".stl files have no colours" in said


@pytest.mark.slow
def test_picture_shows_before_and_after(simplified, tmp_path):
    simplified("--faces", 300, "--picture", tmp_path / "seen.png")
    image = np.asarray(Image.open(tmp_path / "seen.png").convert("RGB")).astype(int)
    thirds = np.array_split(image, 3, axis=1)
    ink = [(third < 200).any(axis=2).mean() for third in thirds]
    assert min(ink) > 0.1
    coloured = [np.abs(third[..., 0] - third[..., 2]).mean() for third in thirds]
    assert coloured[0] > 2 * max(coloured[1:])


@pytest.mark.slow
def test_equal_commands_give_equal_bytes(simplified, tmp_path):
    for out in ("a.glb", "b.glb"):
        simplified("--faces", 300, out=out)
    assert (tmp_path / "a.glb").read_bytes() == (tmp_path / "b.glb").read_bytes()


@pytest.mark.slow
def test_without_options_the_saliency_weighs_and_nothing_is_frozen(simplified, monkeypatch):
    weights = []

    def watched(*arguments, weights=None, real=simplify, seen=weights, **options):
        seen.append(weights)
        return real(*arguments, weights=weights, **options)

    monkeypatch.setattr("haptic_glance.lod.task.simplify", watched)
    _, said, _ = simplified("--faces", 300)
    ours, plain = weights
    assert plain is None and np.ptp(ours) > 0.5 and len(ours) == len(bumpy().vertices)
    assert "height-soft" in said and "points kept" not in said


@pytest.mark.slow
def test_plain_has_no_plain_beside_it(simplified):
    _, said, _ = simplified("--faces", 300, "--method", "qem")
    assert "plain QEM" not in said


def bowl():
    """The ball open at its lower third, and the number of its open edges."""
    mesh = bumpy()
    mesh = Mesh(mesh.vertices, mesh.faces[(mesh.vertices[mesh.faces][..., 2] > PLACE[2] - SIZE / 3).all(axis=1)])
    return mesh, int((mesh.edge_counts[1] == 1).sum())


@pytest.mark.slow
def test_open_borders_that_stay_are_counted_with_what_they_allow(simplified, tmp_path):
    mesh, edges = bowl()
    write_any(tmp_path / "bowl.ply", mesh)
    _, said, _ = simplified("--faces", 400, source=tmp_path / "bowl.ply")
    assert rows(said)["border edges kept"] == [str(edges), str(edges), "-"]
    least = int(rows(said)["fewest faces that keep them"][1])
    simplified("--faces", least, source=tmp_path / "bowl.ply")
    with pytest.raises(ValueError, match=f"since {edges} boundary edges are frozen: ask for {least:,} faces or"):
        simplified("--faces", least - 1, source=tmp_path / "bowl.ply")


@pytest.mark.slow
def test_the_axis_taken_as_up_is_reported(simplified):
    assert "z up, as the file says" in simplified("--faces", 300)[2]
    assert "x up\n" in simplified("--faces", 300, "--up", "x")[2]


@pytest.mark.slow
def test_closed_mesh_says_nothing_of_borders(simplified):
    assert "border" not in simplified("--faces", 300)[1]


@pytest.mark.slow
def test_borders_between_materials_that_are_given_up_are_counted(simplified, tmp_path):
    mesh = textured()
    plain = np.full((1, 1, 4), 255, dtype=np.uint8)
    upper = (mesh.vertices[mesh.faces].mean(axis=1)[:, 2] > PLACE[2]).astype(int)
    both = Texture(mesh.texture.uv, upper, (*mesh.texture.images, plain))
    write_any(tmp_path / "two.glb", Mesh(mesh.vertices, mesh.faces, None, both))
    _, said, _ = simplified("--faces", 500, source=tmp_path / "two.glb")
    edges = rows(said)["border edges kept"]
    assert int(edges[0]) > 20 and edges[0] == edges[1]
    few = int(rows(said)["fewest faces that keep them"][1]) // 2
    _, said, _ = simplified("--faces", few, source=tmp_path / "two.glb")
    assert int(rows(said)["border edges kept"][1]) < int(edges[1])


def soup(mesh):
    """Each face twice, and each with corners of its own."""
    corners = np.repeat(mesh.vertices[mesh.faces], 2, axis=0).reshape(-1, 3)
    return Mesh(corners, np.arange(len(corners)).reshape(-1, 3))


@pytest.mark.slow
def test_a_soup_of_doubled_faces_is_joined_and_simplified(simplified, tmp_path):
    mesh = bumpy()
    write_any(tmp_path / "soup.ply", soup(mesh))
    found, said, told = simplified("--faces", 300, source=tmp_path / "soup.ply")
    assert len(found.faces) == 300 and found.watertight
    assert rows(said)["faces"][0] == "1,280"
    assert "1280 duplicate faces removed" in told
    assert f"{6 * 1280 - len(mesh.vertices):,} coincident vertices merged" in told


def test_vertices_are_joined_only_where_that_closes_edges():
    mesh = bumpy()
    assert repaired(mesh)[1] == []
    far = Mesh(np.r_[mesh.vertices, mesh.vertices], np.r_[mesh.faces, mesh.faces[:, ::-1] + len(mesh.vertices)])
    assert len(repaired(far)[0].vertices) == len(far.vertices)  # two closed surfaces in one place
    assert len(repaired(bowl()[0])[0].vertices) == len(mesh.vertices)


def test_components_that_share_nothing_are_refused_with_what_to_do(simplified, tmp_path):
    generator = np.random.default_rng(0)
    corners = (generator.random((200, 1, 3)) + 0.1 * generator.random((200, 3, 3))).reshape(-1, 3)
    write_any(tmp_path / "shards.ply", Mesh(corners, np.arange(600).reshape(-1, 3)))
    with pytest.raises(
        ValueError,
        match="shards.ply: 50 faces are infeasible, since 600 boundary edges .*: join its connected components",
    ):
        simplified("--faces", 50, source=tmp_path / "shards.ply")


@pytest.mark.slow
def test_picture_of_a_mesh_that_reaches_beyond_its_original(tmp_path):
    mesh = Mesh(0.5 * (bumpy().vertices - PLACE) / SIZE / 1.4, bumpy().faces)
    write_picture(tmp_path / "x.png", mesh, Mesh(1.5 * mesh.vertices, mesh.faces), mesh.vertices[:, 2] + 0.5, [3])
    image = np.asarray(Image.open(tmp_path / "x.png").convert("RGB"))[150:-20]
    first, _, last = ((third < 200).any(axis=2).sum() for third in np.array_split(image, 3, axis=1))
    assert last > 1.5 * first  # both smaller by the same


@pytest.mark.slow
def test_a_tolerance_that_nothing_meets_gives_the_mesh_itself_and_says_so(simplified):
    found, said, told = simplified("--tolerance", "1e-9")
    assert len(found.faces) == 1280 and rows(said)["faces"][1] == "1,280"
    assert "no simplified mesh is within the tolerance" in told


@pytest.mark.parametrize("link", ["same", "relative", "symlink", "of a symlink"])
def test_the_mesh_itself_is_never_written_over(file, tmp_path, monkeypatch, link):
    monkeypatch.setattr(command, "read", lambda path: pytest.fail("it was read before it was refused"))
    (tmp_path / "link.obj").symlink_to(file)
    mesh, out = {
        "same": (file, file), "relative": (file, os.path.relpath(file)), "symlink": (file, tmp_path / "link.obj"),
        "of a symlink": (tmp_path / "link.obj", file),
    }[link]  # fmt: skip
    content = file.read_bytes()
    with pytest.raises(ValueError, match="is the mesh itself"):
        run([str(mesh), "--faces", "300", "--out", str(out)])
    assert file.read_bytes() == content


HARD = ("--neighbourhood", "fixed")


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        (["--faces", "300", "--out", "x.dae"], r"written as \.glb"),
        (["--faces", "9000", "--out", "x.glb"], "ball.obj: --faces 9000: the mesh has only 1,280 faces"),
        (["--faces", "many", "--out", "x.glb"], "^--faces='many' is not a face count"),
        (["--faces", "0", "--out", "x.glb"], "^--faces='0' must be 1 or more"),
        (["--faces", "100%", "--out", "x.glb"], "^--faces='100%' must lie between"),
        (["--faces", "300", "--out", "missing/x.glb"], "no such folder"),
        (["--faces", "300", "--out", "folder.glb"], "is a folder"),
        (["--faces", "300", "--out", "x.glb", "--picture", "x.txt"], "pictures are written as"),
        (
            ["--faces", "300", "--out", "x.glb", "--method", "guess"],
            "there is no such method; choose one of qem, glance",
        ),
        (["--faces", "300", "--out", "x.glb", "--keep", "3"], "--keep has no effect where no faces are frozen"),
        (["--faces", "300", "--out", "x.glb", "--rings", "-1"], "--rings has no effect where no faces are frozen"),
        (["--faces", "300", "--out", "x.glb", "--shrink"], "add --neighbourhood fixed or adaptive or area"),
        (["--faces", "300", "--out", "x.glb", "--method", "qem", "--shrink"], "--shrink has no effect with"),
        (["--faces", "300", "--out", "x.glb", "--method", "qem", *HARD], "--neighbourhood has no effect with --method"),
        (["--faces", "300", "--out", "x.glb", "--neighbourhood", "area", "--rings", "2"], "it is for fixed"),
        (["--faces", "300", "--out", "x.glb", *HARD, "--rings", "-1"], "--rings -1: give 0"),
        (["--faces", "300", "--out", "x.glb", *HARD, "--keep", "0"], "--keep 0: give 1 or more points"),
        (["--faces", "90", "--out", "x.glb", *HARD, "--keep", "9"], r"ask for \d+ faces or more.* let them --shrink"),
    ],
)
def test_what_cannot_be_done_is_said_before_anything_is_written(file, tmp_path, options, reason):
    (tmp_path / "folder.glb").mkdir()
    before = sorted(tmp_path.iterdir())
    with pytest.raises(ValueError, match=reason):
        run([str(file), "--method", "height", *(str(tmp_path / word) if "." in word else word for word in options)])
    assert sorted(tmp_path.iterdir()) == before


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        (["--method", "nosuch"], "--method nosuch: there is no such method"),
        (["--method", "random"], "--method random: it has no saliency"),
        (["--method", "svm"], "--method svm: its weights are learned in the pipeline"),
        (["--seed", "-1"], "--seed -1: give 0 or more"),
    ],
)
def test_options_are_refused_before_the_mesh_is_read(file, tmp_path, monkeypatch, options, reason):
    monkeypatch.setattr(command, "read", lambda path: pytest.fail("it was read before they were refused"))
    with pytest.raises(ValueError, match=reason):
        run([str(file), "--faces", "300", "--out", str(tmp_path / "x.glb"), *options])


def test_a_mesh_full_of_holes_is_told_what_is_feasible(simplified, tmp_path):
    ball = bumpy()
    apart = np.arange(len(ball.faces)) % 9 > 0  # triangles are missing all over it
    write_any(tmp_path / "net.ply", Mesh(ball.vertices, ball.faces[apart]))
    with pytest.raises(ValueError, match=r"--free-borders, or close its \d+ holes first"):
        simplified("--faces", 300, source=tmp_path / "net.ply")
    with pytest.raises(ValueError, match=r"ask for (\d+) faces or more") as refused:
        simplified("--faces", 300, "--free-borders", source=tmp_path / "net.ply")
    least = re.search(r"ask for (\d+) faces", str(refused.value))[1]
    simplified("--faces", least, "--free-borders", source=tmp_path / "net.ply")


def test_a_file_that_needs_an_extra_does_not_stop_a_folder(file, tmp_path, monkeypatch, capsys):
    def no_clouds(path):
        if path.stem == "cloud":
            raise MissingExtra("pymeshlab is not installed")
        return load_unnamed(path)

    monkeypatch.setattr(command, "load_unnamed", no_clouds)
    folder = tmp_path / "scans"
    folder.mkdir()
    (folder / "cloud.ply").touch()
    shutil.copy(file, folder / "solid.obj")
    assert run([str(folder), "--levels", "30%", "--out", str(tmp_path / "levels")]) == 1
    assert "cloud.ply: pymeshlab is not installed" in capsys.readouterr().err
    assert [path.name for path in (tmp_path / "levels").iterdir()] == ["solid_30pct.obj"]
    with pytest.raises(MissingExtra, match=r"cloud.ply: pymeshlab is not installed"):
        run([str(folder / "cloud.ply"), "--faces", "300", "--out", str(tmp_path / "x.glb")])


def test_frozen_faces_that_leave_nothing_are_blamed_and_not_the_components(simplified):
    with pytest.raises(ValueError, match="1,280 faces around 642 points are frozen") as refused:
        simplified("--faces", 100, *HARD, "--keep", 100000, "--rings", 50)
    remedies = str(refused.value).split(": ", 2)[-1]
    assert remedies.startswith("--keep fewer points, or take fewer --rings, or let them --shrink")
    assert "join" not in remedies and "ask for" not in remedies


def test_what_no_option_can_change_is_not_blamed_on_the_frozen_faces(simplified, tmp_path):
    corners = np.eye(3)[None] + 5 * np.arange(9)[:, None, None]
    write_any(tmp_path / "shards.ply", Mesh(corners.reshape(-1, 3), np.arange(27).reshape(-1, 3)))
    with pytest.raises(ValueError, match="boundary edges are frozen: join its connected components first$"):
        simplified("--faces", 4, *HARD, "--keep", 2, source=tmp_path / "shards.ply")
    write_any(
        tmp_path / "least.ply", Mesh(np.r_[np.eye(3), -np.ones((1, 3))], [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]])
    )
    with pytest.raises(ValueError, match="3 faces are infeasible: the mesh cannot be simplified further$"):
        simplified("--faces", 3, source=tmp_path / "least.ply")


def test_one_face_is_one_face(tmp_path, capsys):
    write_any(tmp_path / "one.ply", Mesh(np.eye(3), [[0, 1, 2]]))
    with pytest.raises(ValueError, match="has only 1 face, there is nothing"):
        run([str(tmp_path / "one.ply"), "--faces", "9", "--out", str(tmp_path / "x.glb")])
    assert "simplify: 1 face; z up" in capsys.readouterr().err


def test_a_mesh_too_small_for_its_digits_is_refused_with_the_reason(tmp_path):
    ball = bumpy()
    lines = [f"v {x * 1e-30:.8f} {y * 1e-30:.8f} {z * 1e-30:.8f}" for x, y, z in ball.vertices]
    lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in ball.faces]
    (tmp_path / "tiny.obj").write_text("\n".join(lines))
    with pytest.raises(ValueError, match="tiny.obj: its extent is 0: export it in smaller units, or with more digits"):
        run([str(tmp_path / "tiny.obj"), "--faces", "9", "--out", str(tmp_path / "x.glb")])


@pytest.mark.slow
def test_a_small_ball_with_all_its_digits_is_simplified(simplified, tmp_path):
    write_any(tmp_path / "tiny.ply", Mesh(1e-30 * (bumpy().vertices - PLACE), bumpy().faces))
    assert len(simplified("--faces", 300, source=tmp_path / "tiny.ply", out="out.ply")[0].faces) == 300


def smooth():
    ball = trimesh.creation.icosphere(subdivisions=3)
    return Mesh(SIZE * ball.vertices, ball.faces)


@pytest.mark.slow
def test_pictures_of_a_mesh_beyond_the_frame_are_compared_smaller_and_that_is_said(simplified, tmp_path):
    write_any(tmp_path / "smooth.ply", smooth())
    _, said, told = simplified("--faces", 60, source=tmp_path / "smooth.ply")
    assert "the pictures show all meshes at 9" in told
    pictures = [line.split()[-2:] for line in said.splitlines() if "SSIM" in line or "pyramid" in line]
    assert len(pictures) == 3 and all(0 < float(value) < 1 for values in pictures for value in values)
    assert "the pictures show" not in simplified("--faces", 600, source=tmp_path / "smooth.ply")[2]


@pytest.mark.slow
def test_meshes_within_the_frame_are_left_and_others_shrink_by_the_same():
    ball = Mesh(0.5 * smooth().vertices / SIZE, smooth().faces)
    fits = Mesh(1.04 * ball.vertices, ball.faces)
    same, scale = within_frame([ball, fits])
    assert scale == 1 and same[0] is ball and same[1] is fits
    (small, smaller), scale = within_frame([Mesh(3 * ball.vertices, ball.faces), ball])
    assert np.allclose(small.vertices, 3 * scale * ball.vertices) and np.allclose(
        smaller.vertices, scale * ball.vertices
    )
    for viewpoint in TWELVE:
        assert render(small, viewpoint, (225, 300)).mask.any()  # render refuses what the picture would crop


@pytest.mark.slow
def test_pictures_that_fail_leave_dashes_and_the_reason(simplified, monkeypatch):
    def fails(reference, pictures):
        raise ValueError("no light")

    monkeypatch.setattr(measures, "picture_errors", fails)
    _, said, told = simplified("--faces", 300)
    assert rows(said)["1 - SSIM of the pictures"] == ["-", "-", "-"]
    assert told.count("no errors of the pictures with 300 faces: no light") == 2


@pytest.mark.slow
def test_interrupted_it_says_one_line_and_leaves_nothing(file, tmp_path):
    before = sorted(tmp_path.iterdir())
    words = [str(file), "--faces", "300", "--out", "x.glb", "--picture", "x.png"]
    ours = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])}
    command_line = [sys.executable, "-m", "haptic_glance", "simplify", *words]
    heard = functools.partial(signal.signal, signal.SIGINT, signal.SIG_DFL)  # what runs in the background ignores it
    work = subprocess.Popen(command_line, cwd=tmp_path, env=ours, stderr=subprocess.PIPE, text=True, preexec_fn=heard)
    while "looking at it" not in (line := work.stderr.readline()):
        assert line, "it ended before it could be interrupted"
    work.send_signal(signal.SIGINT)
    assert work.stderr.read().splitlines()[-1] == "simplify: stopped"
    assert work.wait() == -signal.SIGINT  # which a shell reports as 130
    assert sorted(tmp_path.iterdir()) == before


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


@pytest.mark.slow
def test_smaller_neighbourhoods_make_the_target_feasible(simplified):
    found, said, _ = simplified("--faces", 90, *HARD, "--keep", 9, "--shrink")
    assert len(found.faces) <= 90
    assert int(rows(said)["fewest faces that keep them"][1].replace(",", "")) > 90


@pytest.mark.parametrize(("content", "reason"), [(b"not a mesh", "truncated"), (b"", "empty"), (None, "no such file")])
def test_unreadable_mesh_is_named(tmp_path, content, reason):
    if content is not None:
        (tmp_path / "bad.stl").write_bytes(content)
    with pytest.raises(ValueError, match=f"bad.stl: .*{reason}"):
        run([str(tmp_path / "bad.stl"), "--faces", "100", "--out", str(tmp_path / "x.glb")])
    assert not (tmp_path / "x.glb").exists()


@pytest.mark.parametrize(("text", "value"), [("0.2%", 0.002), ("0.002", 0.002), ("1e-4", 1e-4), (".5%", 0.005)])
def test_tolerance_is_a_share_of_the_diagonal(text, value):
    assert share(text) == pytest.approx(value)


@pytest.mark.parametrize(
    ("text", "ways"), [("0.2", "20%, 0.2%"), ("0.01", "1%, 0.01%"), ("2", "2%"), (".5", "50%, .5%")]
)
def test_tolerance_that_may_be_percent_needs_its_sign(text, ways, capsys):
    with pytest.raises(SystemExit):
        parser("").parse_args(["x.stl", "--out", "x.glb", "--tolerance", text])
    assert f"{text!r}: write {ways} or " in capsys.readouterr().err


@pytest.mark.parametrize("text", ["0", "0%", "0.00"])
def test_tolerance_of_nothing_is_refused_with_the_reason(text, capsys):
    with pytest.raises(SystemExit):
        parser("").parse_args(["x.stl", "--out", "x.glb", "--tolerance", text])
    assert "rounding alone exceeds 0" in capsys.readouterr().err


@pytest.mark.parametrize("text", ["-1", "-0", "150%", "much", "nan", ""])
def test_tolerance_that_is_no_share_is_refused(text, capsys):
    with pytest.raises(SystemExit):
        parser("").parse_args(["x.stl", "--out", "x.glb", f"--tolerance={text}"])
    assert "not a share of the diagonal" in capsys.readouterr().err


def test_help_shows_how(capsys):
    with pytest.raises(SystemExit):
        run(["--help"])
    said = capsys.readouterr().out
    assert "haptic-glance simplify bunny.stl --faces 1500 --out small.glb" in said


@pytest.mark.slow
def test_fewest_faces_are_found_to_two_per_cent():
    mesh, errors = bumpy(), {}

    def moved(faces):  # a stand-in for simplification, whose error is one over the count
        found = Mesh(mesh.vertices + mesh.vertex_normals * mesh.diagonal / faces, mesh.faces)
        errors[faces] = metro(mesh, found)["mean"]
        return found

    fewest_faces(mesh, moved, 4, 0.01)
    passed, failed = ([n for n, e in errors.items() if (e <= 0.01) == wanted] for wanted in (True, False))
    assert max(failed) < min(passed) <= 1.02 * max(failed) + 1
    assert len(errors) < 20


def test_lowest_count_is_taken_at_once_where_it_is_good_enough():
    mesh = bumpy()
    asked = []
    fewest_faces(mesh, lambda faces: asked.append(faces) or mesh, 40, 0.01)
    assert asked == [40]


def test_nothing_sound_means_the_mesh_itself():
    mesh = bumpy()

    def fails(faces):
        raise SimplifyError("folded")

    assert fewest_faces(mesh, fails, 4, 0.01) is mesh
    with pytest.raises(ValueError, match="tolerance"):
        fewest_faces(mesh, fails, 4, np.nan)


@pytest.mark.parametrize("suffix", FORMATS)
def test_every_format_that_is_written_reads_back(tmp_path, suffix):
    mesh = textured()
    write_any(tmp_path / f"my ball{suffix}", mesh)
    found = load(tmp_path / f"my ball{suffix}")
    assert len(found.faces) == len(mesh.faces) and found.watertight
    assert metro(mesh, found)["max"] < 1e-6
    assert (found.texture is not None) == (suffix in (".glb", ".obj"))


def test_small_units_keep_their_digits(tmp_path):
    mesh = bumpy()
    tiny = Mesh(1e-6 * (mesh.vertices - PLACE), mesh.faces)
    write_any(tmp_path / "tiny.obj", tiny)
    assert np.abs(load(tmp_path / "tiny.obj").vertices - tiny.vertices).max() < 1e-8 * tiny.diagonal


def test_seams_double_vertices_and_only_they():
    mesh = textured()
    half = mesh.texture.uv.copy()
    half[mesh.vertices[mesh.faces][:, :, 2].mean(axis=1) > PLACE[2]] += 3
    split = Mesh(mesh.vertices, mesh.faces, None, Texture(half, mesh.texture.image, mesh.texture.images))
    whole, cut = (next(iter(to_trimesh(one).geometry.values())) for one in (mesh, split))
    assert len(whole.vertices) == len(mesh.vertices)
    assert len(mesh.vertices) < len(cut.vertices) < 1.2 * len(mesh.vertices)


def test_a_free_boundary_is_simplified_and_what_forbids_it_is_named(tmp_path, capsys):
    side = np.linspace(0, 10, 21)
    x, y = (axis.ravel() for axis in np.meshgrid(side, side))
    ids = np.arange(441).reshape(21, 21)
    a, b, c, d = (part.ravel() for part in (ids[:-1, :-1], ids[:-1, 1:], ids[1:, 1:], ids[1:, :-1]))
    sheet = Mesh(np.c_[x, y, np.sin(x)], np.concatenate([np.c_[a, b, c], np.c_[a, c, d]]))
    write_any(tmp_path / "sheet.obj", sheet)
    given = [str(tmp_path / "sheet.obj"), "--method", "qem", "--out", str(tmp_path / "out.obj"), "--faces", "100"]
    with pytest.raises(ValueError, match="80 boundary edges are frozen: .*--free-borders"):
        run(given)
    with pytest.raises(ValueError, match="--free-borders has no effect with --backend pymeshlab"):
        run([*given, "--free-borders", "--backend", "pymeshlab"])
    assert run([*given, "--free-borders"]) == 0
    assert len(load(tmp_path / "out.obj").faces) <= 100 and "border edges kept" not in capsys.readouterr().out
