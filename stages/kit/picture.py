"""Pictures of others: decoded whole, or refused with the name of the file."""

import io
from pathlib import Path

from PIL import Image

MAX_PIXELS = 2**25  # twice what a camera of 16 megapixels takes; a header may state more than memory holds


def open_picture(content: bytes, name: str | Path) -> Image.Image:
    """The picture in the bytes of a file; ValueError that names it where they are none, or state too many pixels."""
    try:
        image = Image.open(io.BytesIO(content))
        if image.width * image.height <= MAX_PIXELS:
            image.load()
            return image
        reason = f"{image.width} x {image.height} pixels are more than {MAX_PIXELS}"
    except Exception as error:  # Pillow raises many types
        reason = " ".join(str(error).split()) or type(error).__name__
    raise ValueError(f"{name} is not a readable picture: download or unpack its archive again ({reason})")
