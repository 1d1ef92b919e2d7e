"""Contours: recognising classes of objects by following them (T4.4)."""

from . import claims, contours, figure_4_19, sequences_chart, table_4_7, table_4_9

TABLES = {"table_4_7": table_4_7.build, "table_4_9": table_4_9.build}
FIGURES = {
    "figure_4_14": contours.build_contours,
    "figure_4_15": contours.build_felt,
    "figure_4_19": figure_4_19.build,
}
CHARTS = {"sequences": sequences_chart.build}
CLAIMS = claims.CLAIMS
