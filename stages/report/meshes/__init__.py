"""Simplified meshes: what keeping salient neighbourhoods does to the errors, and at which cost (T3.1.3 to T3.2.9)."""

from . import backends, backends_chart, error_measures, lod_claims, simplification
from .claims import CLAIMS as CLAIMS
from .errors import figure_3_4, figure_3_5, figure_3_23
from .pictures import figure_3_6, figure_3_7, figure_3_8, figure_3_21, figure_3_22
from .tables import combinations, dataset, every_detector, table_3_2

TABLES = {
    "dataset": dataset,
    "table_3_1_5_combinations": combinations,
    "lod_detectors": every_detector,
    "table_3_2": table_3_2,
    "lod_claims": lod_claims.build,
    "backends": backends.build,
}
FIGURES = {
    "figure_3_4": figure_3_4, "figure_3_5": figure_3_5, "figure_3_6": figure_3_6, "figure_3_7": figure_3_7,
    "figure_3_8": figure_3_8, "figure_3_21": figure_3_21, "figure_3_22": figure_3_22, "figure_3_23": figure_3_23,
}  # fmt: skip
CHARTS = {
    "simplification": simplification.build,
    "backends": backends_chart.build,
    "error_samples": error_measures.samples,
    "error_views": error_measures.views,
}
