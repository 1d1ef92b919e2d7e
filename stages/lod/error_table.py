"""The errors of a simplified mesh beside those of plain quadric edge collapse, as a table of text."""

from collections.abc import Callable, Sequence

from stages.kit import Mesh
from stages.views import TWELVE

from .colour_error import colour_error
from .metro import surface_errors
from .perceptual import picture_errors, take_pictures
from .task import SimplificationTask
from .within_frame import within_frame

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
    """[dict name -> error] of Meshes in the frame of the task, by the names of NAMES; colours where they count.

    Where a coarse mesh exceeds the picture, all are drawn smaller by one scale, so that the columns of a table compare;
    this is reported, since the errors are then smaller too. Errors of pictures that fail are None, with the reason
    reported.
    """
    (before, *shown), scale = within_frame([task.upright(mesh) for mesh in (task.mesh, *meshes)])
    if scale < 1:
        report(f"the pictures show all meshes at {100 * scale:.3g} % of their size, so that the coarsest fits in")
    pictures = take_pictures(before, TWELVE, SIZE)
    rows = []
    for mesh, picture in zip(meshes, shown, strict=True):
        errors = surface_errors(task.mesh, mesh, {"salient": task.saliency}, seed=seed)
        row: dict[str, float | None] = {name: 100 * value for name, value in errors.items()}
        if "colors" in task.attributes or "uv" in task.attributes:
            row["colour"] = colour_error(task.mesh, mesh, seed=seed)
        try:
            row |= picture_errors(pictures, take_pictures(picture, TWELVE, SIZE))
        except ValueError as error:
            report(f"no errors of the pictures with {len(mesh.faces):,} faces: {error}")
            row |= dict.fromkeys(("ssim", "dlap", "dnor"))
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
