"""The errors of a simplified mesh beside those of plain quadric edge collapse, as a person reads them."""

from stages.views import TWELVE

from .metro import surface_errors
from .perceptual import picture_errors, take_pictures

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


def measured(one, meshes, seed=0):
    """[dict name -> error] of Meshes in the frame of `one` (OneMesh), by the names of NAMES."""
    pictures = take_pictures(one.seen(one.mesh), TWELVE, SIZE)
    found = []
    for mesh in meshes:
        errors = surface_errors(one.mesh, mesh, {"salient": one.saliency}, seed=seed)
        errors = {name: 100 * value for name, value in errors.items()}
        try:
            errors |= picture_errors(pictures, take_pictures(one.seen(mesh), TWELVE, SIZE))
        except ValueError:  # so coarse that it leaves the frame
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
