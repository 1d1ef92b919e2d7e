"""One network for vision and touch, and what two senses are worth together (T5.5, T5.6)."""

from . import claims, hybrid_senses, section_5_5

TABLES = {"section_5_5": section_5_5.section_5_5_table, "hybrid_senses": hybrid_senses.build}
FIGURES = {"figure_5_6": section_5_5.figure_5_6}
CHARTS = {"hybrid": section_5_5.chart}
CLAIMS = claims.CLAIMS
