"""A picture of one simplification: the saliency, and the faces before and after."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from stages.kit import Mesh
from stages.kit.files import whole_file

from .look import coloured, draw, visible_points, with_axis
from .within_frame import within_frame


def write_picture(
    path: Path, before: Mesh, after: Mesh, saliency: np.ndarray, points: np.ndarray, up: str = "z"
) -> None:
    """Writes a picture of three panels: saliency (n,) and points (k,), and the wireframes before and after.

    before, after: Meshes in the frame of stages.meshes.normalise, +z up; where a coarse one exceeds it, both are drawn
    smaller; up: which axis that was before they were turned. The format follows the suffix of the path; ValueError for
    an unknown one (`check_picture`).
    """
    check_picture(path)
    (before, after), _ = within_frame([before, after])
    figure = Figure(figsize=(12, 4.4), layout="constrained")
    axes = figure.subplots(1, 3)
    axes[0].imshow(with_axis(draw(coloured(before, saliency)), up))
    rows, columns = visible_points(before, points)
    axes[0].plot(columns, rows, "o", color="#D81B1B", ms=5, mec="white", mew=0.8)
    kept = f", {len(points)} point{'' if len(points) == 1 else 's'} kept" if len(points) else ""
    axes[0].set_title(f"saliency{kept}")
    for panel, mesh, word in ((axes[1], before, "before"), (axes[2], after, "after")):
        panel.imshow(draw(Mesh(mesh.vertices, mesh.faces), wires=True))
        panel.set_title(f"{word}: {len(mesh.faces):,} faces")
    for panel in axes:
        panel.set_axis_off()
    with whole_file(path) as part:
        figure.savefig(part, dpi=130, format=path.suffix.lower()[1:])


def check_picture(path: Path) -> None:
    """Raises ValueError where matplotlib cannot write the format of the path's suffix."""
    kinds = Figure().canvas.get_supported_filetypes()
    if path.suffix.lower()[1:] not in kinds:
        raise ValueError(f"{path.name}: pictures are written as {', '.join(sorted(kinds))}")
