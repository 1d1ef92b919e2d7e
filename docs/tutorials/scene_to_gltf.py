"""
Levels of detail for a scene, in a glTF viewer
==============================================

A scene shows an object near and far. This tutorial plans how many faces it needs in each frame. It writes the levels
of the plan to one GLB with the extension ``MSFT_lod``, which viewers and engines read.

Needs a clone and ``pip install '.[pipeline]'``; runs without a network.
"""

import json
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt

from haptic_glance import Placed, Scene, budget, fly, load, saliency, simplify
from haptic_glance.gallery.demo import sample
from haptic_glance.lod.mesh_pictures import draw
from haptic_glance.lod.scene import build_lod_chain
from haptic_glance.mesh import normalise, rotate_to_z_up
from stages.scene.level_files import describe, metres_per_unit, read_lod, write_lod

SIZE = 2.0  # metres, the longest side of the animal

mesh = simplify(rotate_to_z_up(load(sample())), 4000)
chain = build_lod_chain(mesh, weights=saliency(mesh))
print("levels:", ", ".join(f"{level.faces:,}" for level in chain))

# %%
# The scene
# ---------
#
# Three animals stand along the path of the camera. The tolerance is one pixel of a screen of 270 rows: in every frame,
# 99 % of the visible pixels of an object must be displaced by no more than one pixel.

places = [((0.0, 0.0, 0.0), 40), ((5.0, 6.0, 0.0), 200), ((-7.0, 16.0, 0.0), 100)]
scene = Scene(
    objects=tuple(Placed("dromedary", position, turn, SIZE) for position, turn in places),
    cameras=tuple(fly([[-2, -18, 2], [-1, -4, 1.6]], [[0, 4, 1], [0, 0, 1]], frames=6, angle=50, size=(270, 480))),
    tolerance=1.0,
)
plan = budget({"dromedary": mesh}, scene, chains={"dromedary": chain})
for frame, (faces, error) in enumerate(zip(plan.faces, plan.errors, strict=True)):
    print(f"frame {frame}: {' + '.join(str(count) for count in faces):18} faces, error {error:.2f} pixels")

# %%
# The levels that the plan uses
# -----------------------------

used = sorted(set(plan.levels[plan.frames.in_view].tolist()))
levels = [chain[k] for k in used]

fig, axes = plt.subplots(1, len(levels), figsize=(2.6 * len(levels), 2.6), layout="constrained", squeeze=False)
for axis, level in zip(axes.flat, levels, strict=True):
    axis.imshow(draw(normalise(level.mesh), wires=True)[90:530, 60:560])
    axis.set_title(f"{level.faces:,} faces", fontsize=10)
    axis.axis("off")
plt.show()

# %%
# One GLB with all of them
# ------------------------
#
# ``MSFT_lod`` is a vendor extension in Khronos's registry. The first node is the finest level and names the others;
# ``MSFT_screencoverage`` lists, for each level, the share of the screen's height below which the next coarser level is
# enough. A viewer without the extension shows the finest level. ``write_lod`` reads the file back and compares the
# names of its levels.

metres = metres_per_unit(mesh, SIZE)
rows = [describe("dromedary", level, metres, scene) for level in levels]
path = Path(tempfile.mkdtemp()) / "dromedary.glb"
write_lod(path, levels, rows, screen_rows=270)
print(f"{path.name}: {path.stat().st_size / 1024:.0f} KiB, levels {', '.join(read_lod(path))}")

content = path.read_bytes()
tree = json.loads(content[20 : 20 + int.from_bytes(content[12:16], "little")])
print(json.dumps(tree["nodes"][0], indent=1))

# %%
# For scenes of a data set, the stage ``scene`` does all of this: ``python -m stages.scene`` writes a GLB per level, one
# per object with ``MSFT_lod``, one of the fullest frame, and a manifest to ``data/SET/scene/export``.
