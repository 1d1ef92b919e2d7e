"""The errors of a simplified mesh beside plain quadric edge collapse, and the fewest faces within an error."""

from collections.abc import Callable, Sequence
from contextlib import suppress

import numpy as np

from haptic_glance.base.extras import MissingExtra
from haptic_glance.look.views import TWELVE
from haptic_glance.mesh.mesh import Mesh

from .errors import colour_error, metro, surface_errors
from .feasibility import InfeasibleTarget, SimplifyError
from .perceptual import picture_errors, take_pictures, within_frame
from .task import SimplificationTask

SIZE = (225, 300)  # rows, columns of the pictures, as in the pipeline
NAMES = {
    "mean": "Metro mean, % of the diagonal",
    "rms": "Metro rms, %",
    "max": "Metro max, %",
    "salient": "where people look, %",
    "colour": "colours, of 255",
    "ssim": "1 - SSIM of the pictures",
    "dlap": "Laplacian pyramid (DLap)",
    "dnor": "normalised Laplacian pyramid (DNor)",
}


def measure_meshes(
    task: SimplificationTask, meshes: Sequence[Mesh], seed: int = 0, report: Callable[[str], None] = lambda text: None
) -> list[dict[str, float | None]]:
    """[dict name -> error] of Meshes in the frame of the task, by the names of NAMES; colours of textures, or counted.

    Where a coarse mesh exceeds the picture, all are drawn smaller by one scale, so that the columns of a table compare;
    this is reported, since the errors are then smaller too. Errors of pictures that fail are None, with the reason
    reported; they are all None without OpenCV, and for a black mesh, which the black background hides.
    """
    (before, *framed), scale = within_frame([task.upright(mesh) for mesh in (task.mesh, *meshes)])
    if scale < 1:
        report(f"the pictures show all meshes at {100 * scale:.3g} % of their size, so that the coarsest fits in")
    pictures, rows = None, []
    try:
        pictures = take_pictures(before, TWELVE, SIZE)
        if not pictures.any():
            report("no errors of the pictures: the mesh is as black as their background")
            pictures = None
    except MissingExtra as error:
        report(f"no errors of the pictures: {error}")
    for mesh, picture in zip(meshes, framed, strict=True):
        errors = surface_errors(task.mesh, mesh, {"salient": task.saliency}, seed=seed)
        row: dict[str, float | None] = {name: 100 * value for name, value in errors.items()}
        if task.mesh.texture is not None or "colors" in task.attributes:
            row["colour"] = colour_error(task.mesh, mesh, seed=seed)
        row |= dict.fromkeys(("ssim", "dlap", "dnor"))
        try:
            if pictures is not None:
                row |= picture_errors(pictures, take_pictures(picture, TWELVE, SIZE))
        except ValueError as error:
            report(f"no errors of the pictures with {len(mesh.faces):,} faces: {error}")
        rows.append(row)
    return rows


def format_table(heads: Sequence[str], rows: Sequence[tuple]) -> str:
    """Lines of text: under the heads, rows of a name and one value per column, None as a dash."""
    texts = [(name, *(_text(value) for value in values)) for name, *values in rows]
    widths = [max(len(row[k]) for row in [("", *heads), *texts]) for k in range(len(heads) + 1)]
    lines = [("", *heads), *texts]
    return "\n".join(
        "".join(
            [row[0].ljust(widths[0]), *(text.rjust(width + 3) for text, width in zip(row[1:], widths[1:], strict=True))]
        )
        for row in lines
    )


def _text(value):
    if value is None:
        return "-"
    if isinstance(value, str):
        return value
    return f"{value:,}" if isinstance(value, int) else f"{value:.4g}"


CLOSE = 1.02  # the result has at most this many times the faces of a count that was too low


def fewest_faces(
    reference: Mesh, simplified: Callable[[int], Mesh], lowest: int, tolerance: float, seed: int = 0,
    report: Callable[[str], None] = lambda text: None,
) -> Mesh:  # fmt: skip
    """The Mesh of the fewest faces with a mean error of at most `tolerance`, a share of the diagonal.

    simplified(faces) -> Mesh. lowest: the lowest count to try. Bisection on the logarithm of the count: the error is
    monotone but for a few per cent, so that a mesh with a few per cent fewer faces may pass as well. A count without a
    sound mesh counts as too low. report(text) is called at each step. Returns the reference itself, with error 0, where
    no smaller mesh is within the tolerance. Raises ValueError for a tolerance that is negative or not finite.
    """
    if not 0 <= tolerance < np.inf:
        raise ValueError(f"the tolerance must be a share of the diagonal, 0 or more, got {tolerance}")
    best, low, high = reference, max(int(lowest), 1), len(reference.faces)
    count = low
    while count < high:
        mesh, value = None, np.inf
        with suppress(SimplifyError, InfeasibleTarget):
            mesh = simplified(count)
            value = metro(reference, mesh, seed=seed)["mean"]
        report(f"{count:,} faces: " + ("no sound mesh" if mesh is None else f"{100 * value:.4f} %"))
        if mesh is not None and value <= tolerance:
            best, high = mesh, count
        else:
            low = count
        if high <= low or high <= CLOSE * low:
            break
        count = int(np.sqrt(low * high))
        if count in (low, high):
            break
    return best
