"""
Meshes for other programs
=========================

:func:`haptic_glance.write_any` writes GLB, OBJ, PLY, STL and OFF, with colours and textures in GLB, OBJ and PLY.
:func:`haptic_glance.to_trimesh` converts a mesh for programs that use trimesh. Functions accept all of these forms as a
mesh.
"""

import tempfile
from pathlib import Path

import matplotlib.pyplot as plt

from haptic_glance import load, metro, normalise, saliency, simplify, to_trimesh, write_any
from haptic_glance.gallery.demo import sample
from haptic_glance.lod.mesh_pictures import coloured
from haptic_glance.mesh import rotate_to_z_up

mesh = normalise(rotate_to_z_up(load(sample())))
small = simplify(mesh, 2000, weights=saliency(mesh))
seen = coloured(small, saliency(small))
print(to_trimesh(seen))

kinds, sizes = ["glb", "obj", "ply", "stl", "off"], []
with tempfile.TemporaryDirectory() as folder:
    for kind in kinds:
        path = Path(folder) / f"dromedary.{kind}"
        write_any(path, seen)
        again = load(path)
        sizes.append(path.stat().st_size / 1024)
        print(
            f"{kind}: {sizes[-1]:4.0f} KiB, colours {again.colors is not None or again.texture is not None}, "
            f"moved by {metro(seen, again)['max']:.1g} of the diagonal"
        )

plt.bar(kinds, sizes)
plt.ylabel("KiB of 2,000 faces")
plt.show()
