"""Requests that `haptic-glance simplify` refuses: the reason, the remedy, and nothing written."""

import json
import os
import re

import numpy as np
import pytest

from haptic_glance.cli import simplify as command
from haptic_glance.cli.simplify import check_outputs, parser, run, share
from haptic_glance.lod.export import write_any
from haptic_glance.mesh.mesh import Mesh

from .conftest import bumpy

HARD = ["--neighbourhood", "fixed"]
GLB = ["--faces", "300", "--out", "x.glb"]


@pytest.mark.parametrize("link", ["relative", "of a symlink"])
def test_the_mesh_itself_is_never_written_over(file, tmp_path, monkeypatch, link):
    monkeypatch.setattr(command, "read", lambda path: pytest.fail("it was read before it was refused"))
    (tmp_path / "link.obj").symlink_to(file)
    mesh, out = (file, os.path.relpath(file)) if link == "relative" else (tmp_path / "link.obj", file)
    content = file.read_bytes()
    with pytest.raises(ValueError, match="is the mesh itself"):
        run([str(mesh), "--faces", "300", "--out", str(out)])
    assert file.read_bytes() == content


@pytest.mark.slow
@pytest.mark.parametrize("name", ["other.mtl", "other_0.png"])
def test_materials_of_another_mesh_are_never_written_over(file, tmp_path, name):
    (tmp_path / name).write_text("mine")
    with pytest.raises(ValueError, match=f"{name} is not of this mesh"):
        run([str(file), "--faces", "300", "--out", str(tmp_path / "other.obj")])
    (tmp_path / "other.obj").write_text("an earlier result")
    run([str(file), "--faces", "300", "--out", str(tmp_path / "other.obj")])


@pytest.mark.parametrize(
    ("out", "name"),
    [
        (["--out", "small.obj"], "small.mtl"),
        (["--out", "small.obj"], "small_0.png"),
        (["--out", "small.obj"], "small_11.png"),
        (["--out", "x.glb", "--picture", "look.png"], "look.png"),
        (["--levels", "50%", "--out", "results", "--format", "obj"], "results/wrapped_50pct.mtl"),
    ],
)
@pytest.mark.parametrize("kind", ["obj", "gltf"])
def test_files_that_the_mesh_refers_to_are_never_written_over(file, tmp_path, monkeypatch, out, name, kind):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(command, "read", lambda *_: pytest.fail("it was read before it was refused"))
    (tmp_path / "results").mkdir()
    for result in ("small.obj", "results/wrapped_50pct.obj"):  # of an earlier run, which had these materials
        (tmp_path / result).write_text("an earlier result")
    if kind == "gltf":
        (tmp_path / "wrapped.gltf").write_text(json.dumps({"images": [{"uri": name}]}))
    else:
        material = name if name.endswith(".mtl") else "a b.txt"
        (tmp_path / "wrapped.obj").write_text(f"mtllib {material}\n" + file.read_text())
        (tmp_path / material).write_text(f"newmtl a\nmap_Kd -clamp on {name}\n")
    (tmp_path / name).touch()
    content = (tmp_path / name).read_bytes()
    faces = [] if "--levels" in out else ["--faces", "300"]
    with pytest.raises(ValueError, match=f"{name} belongs to wrapped.{kind}, and would be overwritten"):
        run([f"wrapped.{kind}", *faces, *out])
    assert (tmp_path / name).read_bytes() == content


@pytest.mark.parametrize("name", ["scan.depth", "external.glb", "painted.ply"])
def test_the_picture_that_a_mesh_is_made_of_is_never_written_over(tmp_path, name):
    tree = json.dumps({"image": "a.png", "images": [{"uri": "a.png"}]}).encode()
    content = {
        "scan.depth": tree,
        "external.glb": b"glTF" + b"\0" * 8 + len(tree).to_bytes(4, "little") + b"JSON" + tree,
        "painted.ply": b"ply\nformat ascii 1.0\ncomment TextureFile a.png\nend_header\n",
    }
    (tmp_path / name).write_bytes(content[name])
    (tmp_path / "a.png").write_bytes(b"a picture")
    with pytest.raises(ValueError, match=f"a.png belongs to {name}, and would be overwritten"):
        check_outputs(tmp_path / name, tmp_path / "a.png")


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        (["--faces", "300", "--out", "x.dae"], r"written as \.glb"),
        (["--faces", "9000", "--out", "x.glb"], "ball.obj: --faces 9000: the mesh has only 1,280 faces"),
        (["--faces", "many", "--out", "x.glb"], "^--faces='many' is not a face count"),
        (["--faces", "100%", "--out", "x.glb"], "^--faces='100%' must lie between"),
        (["--faces", "300", "--out", "ball.obj/x.glb"], "ball.obj is a file: name a folder"),
        (["--faces", "300", "--out", "folder.glb"], "is a folder"),
        ([*GLB, "--picture", "x.txt"], "pictures are written as"),
        ([*GLB, "--method", "guess"], "there is no such method; choose one of qem, glance"),
        ([*GLB, "--keep", "3"], "--keep has no effect where no faces are frozen"),
        ([*GLB, "--method", "qem", "--shrink"], "--shrink has no effect with"),
        (["--faces", "90", "--out", "x.glb", *HARD, "--keep", "9"], r"ask for \d+ faces or more.* let them --shrink"),
        ([*GLB, "--attributes", "colors=1"], "the mesh has no colors"),
        ([*GLB, "--attributes", "normals=0.1", "--backend", "pymeshlab"], "has no effect with --backend pymeshlab"),
    ],
)
def test_what_cannot_be_done_is_said_before_anything_is_written(file, tmp_path, options, reason):
    (tmp_path / "folder.glb").mkdir()
    before = sorted(tmp_path.iterdir())
    in_folder = [str(tmp_path / word) if re.search(r"\.[a-z]", word) else word for word in options]
    with pytest.raises(ValueError, match=reason):
        run([str(file), "--method", "height", *in_folder])
    assert sorted(tmp_path.iterdir()) == before


def test_a_mesh_full_of_holes_is_told_what_is_feasible(simplified, tmp_path):
    ball = bumpy()
    apart = np.arange(len(ball.faces)) % 9 > 0  # triangles are missing all over it
    write_any(tmp_path / "net.ply", Mesh(ball.vertices, ball.faces[apart]))
    with pytest.raises(ValueError, match=r"--free-borders, or close its \d+ holes first"):
        simplified("--faces", 300, source=tmp_path / "net.ply")
    _, table, _ = simplified("--faces", 300, "--free-borders", source=tmp_path / "net.ply")
    assert "border edges kept" not in table


def shards(count):
    """Triangles that share no vertex."""
    corners = np.eye(3)[None] + 0.1 * np.arange(count)[:, None, None]
    return Mesh(corners.reshape(-1, 3), np.arange(3 * count).reshape(-1, 3))


def tetrahedron():
    return Mesh(np.r_[np.eye(3), -np.ones((1, 3))], [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]])


@pytest.mark.parametrize(
    ("mesh", "options", "reason"),
    [
        (shards(200), ["50"], "50 faces are infeasible, since 600 boundary edges .*: join its connected components"),
        (shards(9), ["4", *HARD, "--keep", "2"], "edges are frozen: join its connected components first$"),
        (tetrahedron(), ["3"], "3 faces are infeasible: the mesh cannot be simplified further$"),
        (Mesh(np.eye(3), [[0, 1, 2]]), ["9"], "has only 1 face, there is nothing"),
    ],
)
def test_a_mesh_that_cannot_be_simplified_is_named_with_the_reason(simplified, tmp_path, mesh, options, reason):
    write_any(tmp_path / "odd.ply", mesh)
    with pytest.raises(ValueError, match=f"odd.ply: .*{reason}"):
        simplified("--faces", *options, source=tmp_path / "odd.ply")


PERCENT = "not a share of the diagonal"


@pytest.mark.parametrize(
    ("option", "reason"),
    [
        ("--tolerance=0.2", "'0.2': write 20%, 0.2% or "), ("--tolerance=0.01", "'0.01': write 1%, 0.01% or "),
        ("--tolerance=2", "'2': write 2% or "), ("--tolerance=0", "rounding alone exceeds 0"),
        ("--tolerance=-1", PERCENT), 
        ("--attributes=uv", "such as"), 
        ("--levels=", "--levels="), 
    ],
)  # fmt: skip
def test_a_value_that_cannot_be_read_is_named_with_its_form(option, reason, capsys):
    target = [] if option.startswith(("--tolerance", "--levels")) else ["--faces", "9"]
    with pytest.raises(SystemExit):
        parser().parse_args(["x.stl", "--out", "x.glb", *target, option])
    assert reason in capsys.readouterr().err


def test_values_are_read_as_shares_and_weights():
    assert [share(text) for text in ("0.2%", "0.002", "1e-4", ".5%")] == pytest.approx([0.002, 0.002, 1e-4, 0.005])
    chosen = parser().parse_args(["in.stl", "--faces", "9", "--out", "o.stl", "--attributes", "uv=1, colors=.5"])
    assert chosen.attributes == {"uv": 1.0, "colors": 0.5}
