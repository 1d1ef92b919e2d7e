"""One network for vision and touch, and what two senses are worth together (T5.5, T5.6)."""

from . import claims, figure_5_6, hybrid_senses, section_5_5

TABLES = {"section_5_5": section_5_5.build, "hybrid_senses": hybrid_senses.build}
FIGURES = {"figure_5_6": figure_5_6.build}
CHARTS = {"hybrid": section_5_5.chart}
CLAIMS = claims.CLAIMS
