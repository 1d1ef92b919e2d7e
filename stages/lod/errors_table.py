"""The errors of a simplified mesh beside those of plain quadric edge collapse, as a person reads them."""

from stages.views import TWELVE

from .metro import surface_errors
from .perceptual import picture_errors, take_pictures
from .within_frame import within_frame

SIZE = (225, 300)  # rows, columns of the pictures, as in the pipeline
NAMES = {
    "mean": "Metro mean, % of the diagonal",
    "rms": "Metro rms, %",
    "max": "Metro max, %",
    "salient": "where people look, %",
    "ssim": "1 - SSIM of the pictures",
    "dlap": "Laplacian pyramid (DLap)",
    "dnor": "normalised Laplacian pyramid (DNor)",
}


def measured(one, meshes, seed=0, say=lambda text: None):
    """[dict name -> error] of Meshes in the frame of `one` (OneMesh), by the names of NAMES.

    Where a coarse mesh reaches beyond the picture all are drawn smaller by the same, so that the columns of one table
    compare; say(text) hears of it, since the errors are then smaller too. Pictures that fail leave None and say why.
    """
    (before, *shown), scale = within_frame([one.seen(mesh) for mesh in (one.mesh, *meshes)])
    if scale < 1:
        say(f"the pictures show all meshes at {100 * scale:.3g} % of their size, for the coarsest to fit in")
    pictures = take_pictures(before, TWELVE, SIZE)
    found = []
    for mesh, picture in zip(meshes, shown, strict=True):
        errors = surface_errors(one.mesh, mesh, {"salient": one.saliency}, seed=seed)
        errors = {name: 100 * value for name, value in errors.items()}
        try:
            errors |= picture_errors(pictures, take_pictures(picture, TWELVE, SIZE))
        except ValueError as error:
            say(f"no errors of the pictures with {len(mesh.faces):,} faces: {error}")
            errors |= dict.fromkeys(("ssim", "dlap", "dnor"))
        found.append(errors)
    return found


def table(heads, rows):
    """Lines of text: rows of a name and a value a column, None as a dash, under the heads."""
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
