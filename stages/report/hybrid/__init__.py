"""One network for vision and touch, and what two senses are worth together (T5.5, T5.6)."""

from . import section_5_5

TABLES = {"section_5_5": section_5_5.section_5_5_table, "hybrid_senses": section_5_5.hybrid_senses}
FIGURES = {"figure_5_6": section_5_5.figure_5_6}
CHARTS = {"hybrid": section_5_5.chart}
CLAIMS = section_5_5.CLAIMS
