"""Contours: recognising classes of objects by following them (T4.4)."""

from functools import partial

from stages.report.kept import as_printed

from . import charts, claims, contours, tables

TABLES = {"table_4_7": tables.table_4_7, "table_4_9": tables.table_4_9}
FIGURES = {
    "figure_4_14": partial(as_printed, contours.figure_4_14, charts.THESIS_CLASSES, stage="contours"),
    "figure_4_15": contours.figure_4_15,
    "figure_4_19": charts.figure_4_19,
}
CHARTS = {"sequences": charts.chart}
CLAIMS = claims.CLAIMS
