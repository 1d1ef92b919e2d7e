"""The weights of the tutorial `weights_elsewhere` in Blender itself.

`BLENDER=PYTHON pytest tests/slow/test_blender.py`, where PYTHON is a Python that has the package `bpy` (300 MB, with
numpy of its own), or `BLENDER='blender -b -P'`.
"""

import json
import os
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest

from haptic_glance import load, saliency
from haptic_glance.gallery.demo import sample
from haptic_glance.lod import write_weights

TUTORIAL = Path(__file__).parents[2] / "docs/tutorials/weights_elsewhere.py"
FACES, SALIENT = 900, 0.5
IMPORTS = {
    "ply": "bpy.ops.wm.ply_import(filepath={!r}, up_axis='Y', forward_axis='NEGATIVE_Z')",
    "glb": "bpy.ops.import_scene.gltf(filepath={!r})",
    "usda": "bpy.ops.wm.usd_import(filepath={!r})",
}
BEFORE = """
import bpy
bpy.ops.wm.read_factory_settings(use_empty=True)
{}
bpy.context.view_layer.objects.active = next(item for item in bpy.data.objects if item.type == "MESH")
"""
AFTER = """
import json
bpy.context.view_layer.update()
size = [max(axis) - min(axis) for axis in zip(*(mesh_object.matrix_world @ v.co for v in mesh_object.data.vertices))]
kept = []
for name in (group.name, ""):
    modifier.vertex_group = name
    graph = bpy.context.evaluated_depsgraph_get()
    graph.update()
    data = mesh_object.evaluated_get(graph).to_mesh()
    kept.append([len(data.polygons), [list(mesh_object.matrix_world @ v.co) for v in data.vertices]])
print("found", json.dumps([size, kept]))
"""


@pytest.mark.parametrize("suffix", IMPORTS)
def test_decimation_by_the_group_keeps_the_salient_vertices(tmp_path, suffix):
    blender = os.environ.get("BLENDER")
    if blender is None:
        pytest.skip("no Blender: set BLENDER to a command that runs a Python file in it")
    mesh = load(sample())
    values = saliency(mesh)
    write_weights(tmp_path / f"weights.{suffix}", mesh, values)
    script = re.search(r'BLENDER = """(.*?)"""', TUTORIAL.read_text(), re.DOTALL)[1]
    steps = BEFORE.format(IMPORTS[suffix].format(str(tmp_path / f"weights.{suffix}"))), script, AFTER
    (tmp_path / "steps.py").write_text("".join(steps))
    printed = subprocess.run([*blender.split(), tmp_path / "steps.py"], capture_output=True, text=True, check=True)
    size, kept = json.loads(re.search(r"^found (.*)$", printed.stdout, re.MULTILINE)[1])
    x, y, z = np.ptp(mesh.vertices, axis=0)
    assert mesh.up == "y" and size == pytest.approx([x, z, y], rel=1e-3)  # it stands upright
    salient = mesh.vertices[values >= SALIENT] @ [[1, 0, 0], [0, 0, 1], [0, -1, 0]]
    shares = []
    for faces, vertices in kept:
        assert faces == pytest.approx(FACES, abs=2)
        apart = np.linalg.norm(salient[:, None] - np.array(vertices)[None], axis=2).min(axis=1)
        shares.append((apart < 1e-4).mean())
    with_group, without = shares
    assert len(salient) == 25 and with_group == 1 and without < 0.5
