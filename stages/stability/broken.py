"""Meshes as they should not be: what scanners, modellers and file formats do to a surface, each made from a sound mesh.

To add one, add a function (mesh, generator) -> Mesh and an entry in BROKEN. Draws come from the generator alone.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

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
    needles,
    pin_holes,
    repeated_index,
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
class Broken:
    """A way to break a mesh. make(mesh, generator) -> Mesh; moved: how far off it puts the surface, in diagonals."""

    make: Callable
    moved: float = 0.0


BROKEN = {
    "sound": Broken(lambda mesh, _: mesh),
    "pin_holes": Broken(pin_holes),
    "wide_holes": Broken(wide_holes),
    "half": Broken(half),
    "fins": Broken(fins),
    "burrs": Broken(burrs),
    "interpenetrating": Broken(interpenetrating),
    "duplicate_faces": Broken(duplicate_faces),
    "double_layer": Broken(double_layer),
    "zero_area": Broken(zero_area),
    "needles": Broken(needles),
    "repeated_index": Broken(repeated_index),
    "islands": Broken(islands),
    "mixed_winding": Broken(mixed_winding),
    "unreferenced": Broken(unreferenced),
    "soup": Broken(soup),
    "seam": Broken(seam),
    "squashed": Broken(squashed),
    "snapped": Broken(snapped, moved=0.0125),
    "spikes": Broken(spikes),
    "noise_0.001": Broken(partial(noisy, 0.001), moved=0.001),
    "noise_0.003": Broken(partial(noisy, 0.003), moved=0.003),
    "noise_0.01": Broken(partial(noisy, 0.01), moved=0.01),
    "noise_0.03": Broken(partial(noisy, 0.03), moved=0.03),
    "tiny": Broken(partial(placed, 1e-12, 0.0)),
    "huge": Broken(partial(placed, 1e12, 0.0)),
    "far": Broken(partial(placed, 1.0, 1e6)),
    "flat_sheet": Broken(flat_sheet),
    "moebius": Broken(moebius),
    "everything": Broken(everything),
    "one_triangle": Broken(one_triangle),
}
