"""GLB files: what goes out comes back, and the Khronos validator has no error to tell."""

import json
import os
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import trimesh

from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.srgb import decoded
from stages.scene.level_files import (
    check_glb,
    describe,
    metres_per_unit,
    read_lod,
    to_gltf,
    write_glb,
    write_lod,
    write_scene,
)

VALIDATE = """
const validator = require('gltf-validator'), fs = require('fs');
validator.validateBytes(new Uint8Array(fs.readFileSync(process.argv[1]))).then(
  report => console.log(JSON.stringify(report.issues)), error => { console.error(error); process.exit(1); });
"""


@pytest.fixture(scope="module")
def painted(chains):
    """Levels of a mesh with a colour a vertex."""
    levels = chains["two"][2:5]
    for level in levels:
        colors = np.random.default_rng(0).integers(256, size=level.mesh.vertices.shape)
        object.__setattr__(level.mesh, "colors", colors.astype(np.uint8))
    yield levels
    for level in levels:
        object.__setattr__(level.mesh, "colors", None)


def rows_of(levels, scene):
    return [describe("two", level, metres_per_unit(level.mesh, 0.2), scene) for level in levels]


def nodes(path):
    content = path.read_bytes()
    return json.loads(content[20 : 20 + int.from_bytes(content[12:16], "little")])


def test_a_level_comes_back_with_its_faces_places_and_colours(painted, tmp_path):
    mesh = to_gltf(painted[0].mesh, 0.2)
    write_glb(tmp_path / "a.glb", [mesh], ["a"])
    loaded = trimesh.load(tmp_path / "a.glb", process=False, force="mesh")
    assert len(loaded.faces) == painted[0].faces
    assert np.allclose(loaded.vertices, mesh.vertices, atol=1e-6) and np.array_equal(loaded.faces, mesh.faces)
    assert np.array_equal(loaded.visual.vertex_colors[:, :3], np.rint(255 * decoded(mesh.colors / 255)))


def test_up_is_y_and_sides_are_not_mirrored(chains):
    mesh = chains["two"][0].mesh
    turned = to_gltf(mesh)
    assert np.allclose(turned.vertices[:, 1], mesh.vertices[:, 2])
    volume = [trimesh.Trimesh(shape.vertices, shape.faces, process=False).volume for shape in (mesh, turned)]
    assert volume[0] == pytest.approx(volume[1]) and volume[0] > 0


def test_all_levels_hang_on_the_finest_by_msft_lod(painted, make_scene, tmp_path):
    scene = make_scene()
    write_lod(tmp_path / "lod.glb", painted, rows_of(painted, scene), 60)
    tree = nodes(tmp_path / "lod.glb")
    assert read_lod(tmp_path / "lod.glb") == [f"two_{level.faces}" for level in painted]
    assert tree["extensionsUsed"] == ["MSFT_lod"] and tree["scenes"][0]["nodes"] == [0]
    counts = [tree["accessors"][tree["meshes"][node["mesh"]]["primitives"][0]["indices"]]["count"] // 3
              for node in tree["nodes"]]  # fmt: skip
    assert counts == [level.faces for level in painted]
    shares = tree["nodes"][0]["extras"]["MSFT_screencoverage"]
    assert len(shares) == 3 and shares == sorted(shares, reverse=True) and shares[-1] == 0


def test_the_manifest_tells_up_to_which_size_a_level_is_enough(chains, make_scene):
    scene, level = make_scene(tolerance=2.0), chains["two"][5]
    row = describe("two", level, metres_per_unit(level.mesh, 0.2), scene)
    assert row["size"] == pytest.approx(0.2) and row["faces"] == level.faces
    assert row["error"] * row["enough_up_to"] / row["size"] == pytest.approx(2.0, rel=1e-4)
    assert describe("two", chains["two"][0], 1.0, scene)["enough_up_to"] is None


def test_a_file_that_comes_back_otherwise_is_named(painted, tmp_path):
    mesh, path = to_gltf(painted[0].mesh, 0.2), tmp_path / "a.glb"
    write_glb(path, [mesh], ["a"])
    others = {
        "faces": Mesh(mesh.vertices, mesh.faces[::-1], mesh.colors),
        "positions": Mesh(mesh.vertices * 1.001, mesh.faces, mesh.colors),
        "colours": Mesh(mesh.vertices, mesh.faces, mesh.colors // 2),
    }
    for part, other in others.items():
        with pytest.raises(ValueError, match=rf"a\.glb: a came back with other {part}"):
            check_glb(path, [other], ["a"])
    with pytest.raises(ValueError, match=r"a\.glb came back with a in place of b"):
        check_glb(path, [mesh], ["b"])
    path.write_bytes(path.read_bytes()[:100])
    with pytest.raises(ValueError, match=r"a\.glb cannot be loaded back"):
        check_glb(path, [mesh], ["a"])


def test_equal_meshes_give_equal_bytes(chains, tmp_path):
    for name in "ab":
        write_glb(tmp_path / f"{name}.glb", [to_gltf(chains["two"][3].mesh)], ["x"])
    assert (tmp_path / "a.glb").read_bytes() == (tmp_path / "b.glb").read_bytes()


def test_one_level_alone_needs_no_extension_and_a_join_that_goes_wrong_is_named(
    painted, make_scene, tmp_path, monkeypatch
):
    write_lod(tmp_path / "one.glb", painted[:1], rows_of(painted[:1], make_scene()), 60)
    assert "extensionsUsed" not in nodes(tmp_path / "one.glb")
    with pytest.raises(ValueError, match="no MSFT_lod"):
        read_lod(tmp_path / "one.glb")
    monkeypatch.setattr("stages.scene.level_files.read_lod", lambda path: ["two_1"])
    with pytest.raises(ValueError, match=r"lod\.glb: MSFT_lod came back as two_1"):
        write_lod(tmp_path / "lod.glb", painted, rows_of(painted, make_scene()), 60)


def validator():
    """The folder of node modules that holds gltf-validator, or None."""
    places = [os.environ.get("NODE_PATH"), "node_modules", str(Path.home() / "node_modules")]
    return next((place for place in places if place and (Path(place) / "gltf-validator").is_dir()), None)


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("node") is None, reason="no node here")
@pytest.mark.skipif(validator() is None, reason="no gltf-validator: `npm install gltf-validator@2.0.0-dev.3.10`")
def test_the_khronos_validator_finds_no_fault(painted, chains, meshes, make_scene, tmp_path):
    scene = make_scene()
    write_glb(tmp_path / "level.glb", [to_gltf(painted[0].mesh)], ["level"])
    write_lod(tmp_path / "lod.glb", painted, rows_of(painted, scene), 60)
    plan = pd.DataFrame([{"place": k, "faces": 1, "level": 2, "in_view": True} for k in range(3)])
    write_scene(tmp_path / "scene.glb", scene, meshes, chains, plan)
    for path in sorted(tmp_path.glob("*.glb")):
        process = subprocess.run(["node", "-e", VALIDATE, path], capture_output=True, text=True, check=True,
                              env=os.environ | {"NODE_PATH": str(Path(validator()).resolve())})  # fmt: skip
        issues = json.loads(process.stdout)
        assert issues["numErrors"] == 0 and issues["numWarnings"] == 0, (path.name, issues["messages"][:3])
