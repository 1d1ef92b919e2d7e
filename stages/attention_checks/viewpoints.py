"""How well the thesis's equal weights predict gaze from a set of viewpoints (T3.2.4)."""

from collections.abc import Callable, Sequence
from pathlib import Path

import cv2
import numpy as np

from haptic_glance.base.files import read_arrays, read_mesh
from haptic_glance.base.timing import Stopwatch
from haptic_glance.look.agreement import GroundTruth, auc, nss
from haptic_glance.look.camera import Viewpoint
from haptic_glance.look.channels import CHANNELS
from haptic_glance.look.points import best_viewpoints, compute_maps
from haptic_glance.look.views import FOUR, TWELVE
from haptic_glance.mesh.mesh import Mesh
from stages.kit.run import Rows

VIEWS: dict[str, Callable[[Mesh], Sequence[Viewpoint]]] = {
    "best": best_viewpoints,
    "four": lambda _: FOUR,
    "twelve": lambda _: TWELVE,
}


def check_views(names: Sequence[str]) -> None:
    """Raises ValueError for the name of a set of viewpoints that does not exist."""
    for name in names:
        if name not in VIEWS:
            raise ValueError(f"attention_checks.views: {name!r} is not one of {', '.join(VIEWS)}")


def process(name: str, folder: Path, data: Path, views: Sequence[str]) -> Rows:
    """Rows of NSS and AUC of one object: the plain average of all nine channels, from each set of viewpoints."""
    cv2.setNumThreads(1)  # a worker is one core, and `seconds` are of one core
    mesh = read_mesh(data / "meshes" / f"{name}.npz")
    gaze = read_arrays(data / "weights/ground_truth" / f"{name}.npz")
    truth = GroundTruth(gaze["amounts"], gaze["density"], gaze["areas"])
    rows = []
    for one in views:
        viewpoints = VIEWS[one](mesh)
        with Stopwatch() as watch:
            maps = compute_maps(mesh, CHANNELS, viewpoints, "raster")
            assert maps is not None  # there are channels
            saliency = np.add.reduce([maps.vertex_values(maps.maps[channel]) for channel in CHANNELS])
        rows += [
            {"item": name, "views": one, "method": "equal", "metric": metric.__name__, "seconds": watch.seconds}
            | {"value": float(metric(saliency, truth))}
            for metric in (nss, auc)
        ]
    return rows
