"""The registry of the thesis's claims: one entry a claim, in the order of the thesis."""

from . import chapter_3, chapter_4, chapter_5

CLAIMS = [*chapter_3.CLAIMS, *chapter_4.CLAIMS, *chapter_5.CLAIMS]

__all__ = ["CLAIMS"]
