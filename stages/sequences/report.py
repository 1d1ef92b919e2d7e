"""Contours: recognising classes of objects by following them (T4.4)."""

from functools import partial

from stages.charts.items import as_printed

from . import contour_figures, sequence_tables

PAGE = "sequences"
TABLES = {
    "table_4_7": sequence_tables.table_4_7,
    "table_4_9": sequence_tables.table_4_9,
}
FIGURES = {
    "figure_4_14": partial(as_printed, contour_figures.figure_4_14, contour_figures.THESIS_CLASSES, stage="contours"),
    "figure_4_15": contour_figures.figure_4_15,
    "figure_4_19": contour_figures.figure_4_19,
}
CHARTS = {
    "sequences": contour_figures.chart,
}
