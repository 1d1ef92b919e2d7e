"""The meshes that the page gets: other readers find the same geometry and colours in them."""

import io
import json

import numpy as np
import pytest
import trimesh

from haptic_glance.mesh.srgb import encoded
from haptic_glance.studio.scene import escaped, glb


@pytest.mark.parametrize("flat", [False, True])
def test_another_reader_finds_the_same_mesh(mesh, flat):
    colors = np.random.default_rng(0).integers(0, 256, (len(mesh.vertices), 3)).astype(np.uint8)
    content = glb(mesh, colors, flat)
    (solid,) = trimesh.load(io.BytesIO(content), file_type="glb", process=False).geometry.values()
    assert np.allclose(solid.vertices, mesh.vertices, atol=1e-6) and np.array_equal(solid.faces, mesh.faces)
    assert ("vertex_normals" in solid._cache.cache) is not flat
    if not flat:
        assert np.allclose(solid.vertex_normals, mesh.vertex_normals, atol=1e-5)


def test_colours_come_back_under_the_encoding_of_the_display(mesh):
    colors = np.tile([[0, 60, 255]], (len(mesh.vertices), 1)).astype(np.uint8)
    content = glb(mesh, colors)
    header = json.loads(content[20 : 20 + int.from_bytes(content[12:16], "little")])
    accessor = header["accessors"][header["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"]]
    start = header["bufferViews"][accessor["bufferView"]]["byteOffset"]
    stored = np.frombuffer(content, "<u2", 4, content.index(b"BIN\0") + 4 + start)
    assert accessor["normalized"]
    assert np.allclose(255 * encoded(stored / 65535), [0, 60, 255, 255], atol=0.1)


def test_what_a_files_name_holds_is_not_run_as_markdown():
    assert escaped("a{b}<img src=x>_c_[d](e)") == r"a\{b\}\<img src\=x\>\_c\_\[d\]\(e\)"
    assert escaped("9,000 faces") == "9,000 faces"
