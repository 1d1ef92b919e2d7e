"""The registry of the thesis's claims: one entry a claim, in the order of the thesis."""

from . import (
    chapter_3_1_meshes,
    chapter_3_2_meshes,
    chapter_3_attention,
    chapter_3_fixation,
    chapter_4,
    chapter_4_exploration,
    chapter_4_glance,
    chapter_4_real,
    chapter_4_sensor,
    chapter_4_sequences,
    chapter_5,
    chapter_5_hybrid,
    chapter_5_real,
)

MESHES = [*chapter_3_1_meshes.CLAIMS, *chapter_3_2_meshes.CLAIMS]
CLAIMS = [
    *chapter_3_attention.CLAIMS,
    *chapter_3_fixation.CLAIMS,
    *MESHES,
    *chapter_4.CLAIMS,
    *chapter_4_exploration.CLAIMS,
    *chapter_4_glance.CLAIMS,
    *chapter_4_real.CLAIMS,
    *chapter_4_sensor.CLAIMS,
    *chapter_4_sequences.CLAIMS,
    *chapter_5.CLAIMS,
    *chapter_5_real.CLAIMS,
    *chapter_5_hybrid.CLAIMS,
]

__all__ = ["CLAIMS", "MESHES"]
