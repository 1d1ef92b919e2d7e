"""Simplified meshes: what keeping salient neighbourhoods does to the errors, and at which cost (T3.1.3 to T3.2.9)."""

from . import backends, backends_chart, dataset, error_measures, figure_3_8, lod_claims, simplification, table_3_2
from .claims import CLAIMS as CLAIMS
from .detectors import combinations, every_detector
from .dots import figure_3_4, figure_3_5
from .pictures import figure_3_6, figure_3_7, figure_3_21, figure_3_22

TABLES = {
    "dataset": dataset.build,
    "table_3_1_5_combinations": combinations,
    "lod_detectors": every_detector,
    "table_3_2": table_3_2.table,
    "lod_claims": lod_claims.build,
    "backends": backends.build,
}
FIGURES = {
    "figure_3_4": figure_3_4, "figure_3_5": figure_3_5, "figure_3_6": figure_3_6, "figure_3_7": figure_3_7,
    "figure_3_8": figure_3_8.build, "figure_3_21": figure_3_21, "figure_3_22": figure_3_22,
    "figure_3_23": table_3_2.figure,
}  # fmt: skip
CHARTS = {
    "simplification": simplification.build,
    "backends": backends_chart.build,
    "error_samples": error_measures.samples,
    "error_views": error_measures.views,
}
