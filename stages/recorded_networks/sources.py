"""The recorded touches that networks are tested on, and how each is read."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from haptic_glance.know.split import Split
from stages.classification.recorded import read_grasps, read_pressure_images
from stages.transfer.recorded import (
    Recorded,
    grasp_images,
    pressure_images,
    read_bigs,
    read_schunk,
    read_vitac,
    read_vt60,
)
from stages.transfer.recorded.schunk import BIGS


@dataclass(frozen=True)
class Recording:
    """Recorded touches, how they are split, and whether training may reflect, move and scale their images.

    test_objects: names of the objects that the publisher keeps for testing.
    """

    touches: Recorded
    splits: tuple[Split, ...]
    augmented: bool
    test_objects: tuple[str, ...] = ()


def _pressure(path: Path) -> dict[str, Recording]:
    touches = pressure_images(read_pressure_images(path))
    return {"pressure": Recording(touches, (Split.RANDOM, Split.BLOCKS), True)}


def _grasps(path: Path) -> dict[str, Recording]:
    # A reflected fingertip is another finger's and a moved one none, so grasps are not augmented.
    grasps = read_grasps(path)
    kept = tuple(np.unique(grasps.objects[grasps.test]).tolist())
    return {
        "grasps_object": Recording(grasp_images(grasps, "objects"), (Split.RANDOM, Split.BLOCKS), False),
        "grasps_slip": Recording(grasp_images(grasps, "slipped"), (Split.TEST_OBJECTS,), False, kept),
    }


def _vitac(path: Path) -> dict[str, Recording]:
    return {"vitac": Recording(read_vitac(path), (Split.RANDOM, Split.OBJECTS), True)}


def _vt60(path: Path) -> dict[str, Recording]:
    return {"vt60": Recording(read_vt60(path), (Split.RANDOM, Split.OBJECTS), True)}


def _bigs(path: Path) -> dict[str, Recording]:
    kinds = {"bigs": read_bigs(path), "bigs_instant": read_bigs(path, instant=True)}
    return {name: Recording(touches, (Split.RANDOM, Split.OBJECTS), False) for name, touches in kinds.items()}


def _schunk(path: Path) -> dict[str, Recording]:
    cells = {"schunk": None, "schunk_instant": (27, 6), "schunk_coarse": BIGS}
    kinds = {name: read_schunk(path, number) for name, number in cells.items()}
    return {name: Recording(touches, (Split.RANDOM, Split.OBJECTS), False) for name, touches in kinds.items()}


# {kind of recording: reader of {what is recognised: Recording}}
SOURCES: dict[str, Callable[[Path], dict[str, Recording]]] = {
    "pressure_images": _pressure, "biotac_grasps": _grasps, "vitac": _vitac, "vt60": _vt60, "bigs": _bigs,
    "schunk": _schunk,
}  # fmt: skip
