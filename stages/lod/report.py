"""Simplified meshes: what keeping salient neighbourhoods does to the errors, and at which cost (T3.1.3 to T3.2.9)."""

from functools import partial

from stages.charts.datasets import SECTION_3_1, SECTION_3_2
from stages.charts.items import as_printed

from . import backend_report, error_figures, error_tables, flip_report, level_pictures

PAGE = "simplify"
TABLES = {
    "table_3_1_5_combinations": error_tables.combinations,
    "lod_detectors": error_tables.every_detector,
    "table_3_2": error_tables.table_3_2,
    "flip": flip_report.flip_table,
    "backends": backend_report.backends_table,
}
FIGURES = {
    "figure_3_4": error_figures.figure_3_4,
    "figure_3_5": error_figures.figure_3_5,
    "figure_3_6": partial(as_printed, level_pictures.figure_3_6, SECTION_3_1),
    "figure_3_7": partial(as_printed, level_pictures.figure_3_7, SECTION_3_1),
    "figure_3_8": partial(as_printed, level_pictures.figure_3_8, SECTION_3_1),
    "figure_3_21": partial(as_printed, level_pictures.figure_3_21, SECTION_3_2),
    "figure_3_22": partial(as_printed, level_pictures.figure_3_22, SECTION_3_2),
    "figure_3_23": error_figures.figure_3_23,
}
CHARTS = {
    "simplification": error_figures.simplification,
}
