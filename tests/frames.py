"""Rows of frames and pictures that several tests of the report look at."""

from PIL import Image

SHADES = 20  # a chart has more, for the rims of its letters


def only(frame, **where):
    """The one row of a frame with these values."""
    for column, value in where.items():
        frame = frame[frame[column] == value]
    assert len(frame) == 1
    return frame.iloc[0]


def has_ink(figure):
    """Whether the picture of a figure was written and is not blank."""
    with Image.open(figure.paths[0]) as image:
        return len(image.convert("L").getcolors()) > SHADES
