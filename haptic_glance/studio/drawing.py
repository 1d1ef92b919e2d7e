"""The array on the object, in the scene of a window."""

import numpy as np

from haptic_glance.lod.pictures import viridis

from .feeling import Felt
from .scene import RED, Scene

THICK = 0.006  # units, of lines
DOT = 0.85  # of the pitch: a cell as it is drawn on the object


def draw_array(scene: Scene, name: str, felt: Felt) -> None:
    """The outline of the array in its pose, and its cells where they met the object, in the colours of the grid."""
    draw_line(scene, f"{name}/outline", np.concatenate([felt.corners, felt.corners[:1]]))
    draw_cells(scene, f"{name}/cells", felt)


def draw_cells(scene: Scene, name: str, felt: Felt) -> None:
    """The cells alone, where they met the object."""
    places, values = felt.contacts
    if not len(places):
        scene.clear(name)
        return
    scene.api.add_point_cloud(
        name, places, viridis(values), point_size=DOT * felt.pitch, point_shape="square", precision="float32",
        point_shading="flat",
    )  # fmt: skip


def draw_line(scene: Scene, name: str, places: np.ndarray) -> None:
    """A line through places (k, 3)."""
    lines = np.stack([places[:-1], places[1:]], axis=1).astype(np.float32)
    scene.api.add_line_segments(name, lines, RED, thickness=THICK)
