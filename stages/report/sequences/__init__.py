"""Contours: recognising classes of objects by following them (T4.4)."""

from functools import partial

from stages.charts.items import as_printed

from . import contours, tables

TABLES = {"table_4_7": tables.table_4_7, "table_4_9": tables.table_4_9}
FIGURES = {
    "figure_4_14": partial(as_printed, contours.figure_4_14, contours.THESIS_CLASSES, stage="contours"),
    "figure_4_15": contours.figure_4_15,
    "figure_4_19": contours.figure_4_19,
}
CHARTS = {"sequences": contours.chart}
