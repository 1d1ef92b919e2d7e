"""The recorded touches that networks are tested on, and how each is read."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from stages.classification.recorded import read_grasps, read_pressure_images
from stages.kit.split import Split
from stages.transfer.recorded import Recorded, grasp_images, pressure_images, read_bigs, read_vitac, read_vt60


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
    return {"bigs": Recording(read_bigs(path), (Split.RANDOM, Split.OBJECTS), False)}


# {kind of recording: reader of {what is recognised: Recording}}, whose images are the same whatever is recognised.
SOURCES: dict[str, Callable[[Path], dict[str, Recording]]] = {
    "pressure_images": _pressure, "biotac_grasps": _grasps, "vitac": _vitac, "vt60": _vt60, "bigs": _bigs,
}  # fmt: skip
