"""Simplified meshes: what keeping salient neighbourhoods does to the errors, and at which cost (T3.1.3 to T3.2.9)."""

from . import (
    backends,
    backends_chart,
    dataset,
    error_samples,
    error_views,
    figure_3_4,
    figure_3_5,
    figure_3_6,
    figure_3_7,
    figure_3_8,
    figure_3_21,
    figure_3_22,
    figure_3_23,
    lod_claims,
    lod_detectors,
    simplification,
    table_3_1_5_combinations,
    table_3_2,
)

TABLES = {
    "dataset": dataset.build,
    "table_3_1_5_combinations": table_3_1_5_combinations.build,
    "lod_detectors": lod_detectors.build,
    "table_3_2": table_3_2.build,
    "lod_claims": lod_claims.build,
    "backends": backends.build,
}
FIGURES = {
    "figure_3_4": figure_3_4.build,
    "figure_3_5": figure_3_5.build,
    "figure_3_6": figure_3_6.build,
    "figure_3_7": figure_3_7.build,
    "figure_3_8": figure_3_8.build,
    "figure_3_21": figure_3_21.build,
    "figure_3_22": figure_3_22.build,
    "figure_3_23": figure_3_23.build,
}
CHARTS = {
    "simplification": simplification.build,
    "backends": backends_chart.build,
    "error_samples": error_samples.build,
    "error_views": error_views.build,
}
CLAIMS = lod_claims.CLAIMS
