"""The registry of damages: what scanners, modellers and file formats do to a mesh, each applied to a sound one.

To add one, add a function (mesh, generator) -> Mesh and an entry in DAMAGES. Random numbers come from the generator
alone.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from haptic_glance.mesh.mesh import Mesh

from .broken_faces import (
    burrs,
    double_layer,
    duplicate_faces,
    everything,
    fins,
    half,
    interpenetrating,
    islands,
    mixed_winding,
    pin_holes,
    repeated_index,
    slivers,
    wide_holes,
    zero_area,
)
from .broken_places import (
    noisy,
    placed,
    seam,
    snapped,
    soup,
    spikes,
    squashed,
    unreferenced,
)
from .broken_shapes import (
    flat_sheet,
    moebius,
    one_triangle,
)


@dataclass(frozen=True)
class Damage:
    """A way to break a mesh: make(mesh, generator) -> Mesh.

    moved: how far the damage itself moves the surface, in diagonals.
    """

    make: Callable[[Mesh, np.random.Generator], Mesh]
    moved: float = 0.0


DAMAGES = {
    "sound": Damage(lambda mesh, _: mesh),
    "pin_holes": Damage(pin_holes),
    "wide_holes": Damage(wide_holes),
    "half": Damage(half),
    "fins": Damage(fins),
    "burrs": Damage(burrs),
    "interpenetrating": Damage(interpenetrating),
    "duplicate_faces": Damage(duplicate_faces),
    "double_layer": Damage(double_layer),
    "zero_area": Damage(zero_area),
    "needles": Damage(slivers),
    "repeated_index": Damage(repeated_index),
    "islands": Damage(islands),
    "mixed_winding": Damage(mixed_winding),
    "unreferenced": Damage(unreferenced),
    "soup": Damage(soup),
    "seam": Damage(seam),
    "squashed": Damage(squashed),
    "snapped": Damage(snapped, moved=0.0125),
    "spikes": Damage(spikes),
    "noise_0.001": Damage(partial(noisy, 0.001), moved=0.001),
    "noise_0.003": Damage(partial(noisy, 0.003), moved=0.003),
    "noise_0.01": Damage(partial(noisy, 0.01), moved=0.01),
    "noise_0.03": Damage(partial(noisy, 0.03), moved=0.03),
    "tiny": Damage(partial(placed, 1e-12, 0.0)),
    "huge": Damage(partial(placed, 1e12, 0.0)),
    "far": Damage(partial(placed, 1.0, 1e6)),
    "flat_sheet": Damage(flat_sheet),
    "moebius": Damage(moebius),
    "everything": Damage(everything),
    "one_triangle": Damage(one_triangle),
}
