"""Simplified meshes: what keeping salient neighbourhoods does to the errors, and at which cost (T3.1.3 to T3.2.9)."""

from functools import partial

from stages.charts.datasets import SECTION_3_1, SECTION_3_2
from stages.charts.items import as_printed

from . import backends, errors
from .errors import figure_3_4, figure_3_5, figure_3_23
from .pictures import figure_3_6, figure_3_7, figure_3_8, figure_3_21, figure_3_22
from .tables import combinations, dataset, every_detector, table_3_2

TABLES = {
    "dataset": dataset,
    "table_3_1_5_combinations": combinations,
    "lod_detectors": every_detector,
    "table_3_2": table_3_2,
    "backends": backends.backends_table,
}
FIGURES = {
    "figure_3_4": figure_3_4,
    "figure_3_5": figure_3_5,
    "figure_3_6": partial(as_printed, figure_3_6, SECTION_3_1),
    "figure_3_7": partial(as_printed, figure_3_7, SECTION_3_1),
    "figure_3_8": partial(as_printed, figure_3_8, SECTION_3_1),
    "figure_3_21": partial(as_printed, figure_3_21, SECTION_3_2),
    "figure_3_22": partial(as_printed, figure_3_22, SECTION_3_2),
    "figure_3_23": figure_3_23,
}
CHARTS = {
    "simplification": errors.simplification,
    "backends": backends.backends_chart,
}
