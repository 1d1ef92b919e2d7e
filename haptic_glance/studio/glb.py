"""A coloured mesh as a GLB for the page: matte, its colours without the encoding of sRGB, as glTF has them."""

import json
import struct

import numpy as np

from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.srgb import decoded

FLOAT, UNSIGNED, SHORT = 5126, 5125, 5123  # component types of glTF 2.0, section 3.6.2
VERTICES, INDICES = 34962, 34963  # what a part of the buffer is for
MATERIAL = {"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.8}, "doubleSided": True}


def glb(mesh: Mesh, colors: np.ndarray, flat: bool = False) -> bytes:
    """The GLB of a Mesh with colours (n, 3) u1; flat: without normals, so that every face is lit by its own."""
    rgb = np.full((len(colors), 4), 2**16 - 1, dtype=np.uint16)  # 16 bits: eight would lose the dark ones
    rgb[:, :3] = np.rint(decoded(colors / 255) * (2**16 - 1))
    parts = {"POSITION": mesh.vertices.astype("<f4"), "COLOR_0": rgb.astype("<u2")}
    if not flat:
        parts["NORMAL"] = mesh.vertex_normals.astype("<f4")
    arrays = [*parts.values(), mesh.faces.astype("<u4").ravel()]
    attributes = {name: number for number, name in enumerate(parts)}
    primitive = {"attributes": attributes, "indices": len(parts), "material": 0}
    ends = np.cumsum([0, *(array.nbytes for array in arrays)])
    header = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [primitive]}], "materials": [MATERIAL],
        "buffers": [{"byteLength": int(ends[-1])}],
        "bufferViews": [
            {
                "buffer": 0, "byteOffset": int(start), "byteLength": array.nbytes,
                "target": VERTICES if array.ndim == 2 else INDICES,
            }
            for array, start in zip(arrays, ends[:-1], strict=True)
        ],
        "accessors": [_accessor(number, array) for number, array in enumerate(arrays)],
    }  # fmt: skip
    text = json.dumps(header).encode()
    text += b" " * (-len(text) % 4)
    body = b"".join(array.tobytes() for array in arrays)  # each a multiple of four bytes
    head = struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(body), len(text), 0x4E4F534A)
    return head + text + struct.pack("<II", len(body), 0x004E4942) + body


def _accessor(number, array):
    kinds = {"f": FLOAT, "u": UNSIGNED if array.itemsize == 4 else SHORT}
    width = array.shape[1] if array.ndim == 2 else 1
    accessor = {
        "bufferView": number, "componentType": kinds[array.dtype.kind], "count": len(array),
        "type": {1: "SCALAR", 3: "VEC3", 4: "VEC4"}[width],
    }  # fmt: skip
    if array.itemsize == 2:
        accessor["normalized"] = True
    if number == 0:  # glTF asks for the bounds of the positions
        accessor |= {"min": array.min(axis=0).tolist(), "max": array.max(axis=0).tolist()}
    return accessor
