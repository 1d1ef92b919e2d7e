"""
Saliency as weights in other tools
==================================

Many tools simplify a mesh with weights per vertex that a person paints by hand. Haptic Glance predicts these weights.
This tutorial writes them for Blender, glTF, OpenUSD and meshoptimizer. On the command line, the same is
``haptic-glance saliency MESH --weights FILE`` with a file that ends in ``.ply``, ``.glb``, ``.usda`` or ``.npz``.

Needs ``pip install 'haptic-glance[pictures]'``; runs without a network.
"""

import json
import struct
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import trimesh

from haptic_glance import load, saliency
from haptic_glance.gallery.demo import sample
from haptic_glance.lod import write_weights
from haptic_glance.lod.mesh_pictures import look

mesh = load(sample())
weights = saliency(mesh)
folder = tempfile.TemporaryDirectory()
files = {suffix: Path(folder.name) / f"weights.{suffix}" for suffix in ("ply", "glb", "usda", "npz")}
for file in files.values():
    write_weights(file, mesh, weights)

figure, axes = plt.subplots(figsize=(5, 4))
axes.imshow(look(mesh, weights, np.zeros(0, dtype=np.int64))[90:530, 60:560])
axes.axis("off")
plt.show()

# %%
# Blender
# -------
#
# Blender imports the vertex property of a PLY file as the attribute ``saliency`` of the mesh. USD gives the same
# attribute, GLB gives ``_SALIENCY``. A PLY file does not say which axis points up: choose Y when you import this one.
#
# The Decimate modifier reads a vertex group. This script makes the group and the modifier; run it in Blender's text
# editor with the imported mesh selected. Vertices of weight 1 in the group are simplified most, so the script stores
# one minus the saliency. In Blender 4.5 and 5.0, a tenth of the faces of the sample keeps all 25 vertices whose
# saliency is above a half; without the group, it keeps 6. ``tests/lod/test_weights_in_blender.py`` runs the script in
# Blender.

properties = trimesh.load(files["ply"], process=False).metadata["_ply_raw"]["vertex"]["properties"]
print("properties of a vertex:", ", ".join(properties))

BLENDER = """
import bpy

mesh_object = bpy.context.object
attributes = mesh_object.data.attributes
saliency = attributes.get("saliency") or attributes["_SALIENCY"]
group = mesh_object.vertex_groups.new(name="not salient")
for vertex, value in enumerate(saliency.data):
    group.add([vertex], 1 - value.value, "REPLACE")
modifier = mesh_object.modifiers.new("Decimate", "DECIMATE")
modifier.ratio = 0.1
modifier.vertex_group = group.name
"""
script = compile(BLENDER, "blender.py", "exec")  # its grammar is right

# %%
# glTF
# ----
#
# glTF asks that attributes of an application begin with an underscore. The GLB has ``_SALIENCY`` beside the positions,
# the normals and the texture coordinates, or without a texture the colours; three.js shows it as
# ``geometry.attributes._saliency``.

data = files["glb"].read_bytes()
header = json.loads(data[20 : 20 + struct.unpack("<I", data[12:16])[0]])
print("attributes:", ", ".join(header["meshes"][0]["primitives"][0]["attributes"]))

# %%
# OpenUSD
# -------
#
# The USD file holds one mesh with a primvar per vertex. In Python with ``usd-core``:
# ``UsdGeom.PrimvarsAPI(stage.GetDefaultPrim()).GetPrimvar("saliency").Get()``.

lines = files["usda"].read_text().splitlines()
print(next(line.strip()[:40] for line in lines if "primvars" in line))

# %%
# meshoptimizer
# -------------
#
# ``meshopt_simplifyWithAttributes`` takes attributes with weights, and one lock a vertex. The most salient vertices are
# locked here. In JavaScript, ``MeshoptSimplifier.simplifyWithAttributes(indices, vertices, 3, attributes, 1, [weight],
# lock, target, error)`` takes the same arrays.

arrays = np.load(files["npz"])
lock = (arrays["saliency"] >= np.quantile(arrays["saliency"], 0.95)).astype(np.uint8)
print(f"{len(arrays['indices']) // 3:,} faces, {lock.sum()} of {len(lock):,} vertices locked")
folder.cleanup()
