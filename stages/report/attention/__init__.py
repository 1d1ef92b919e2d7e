"""Where people look: models of attention against human gaze and marks (T3.1, T3.2)."""

from . import (
    agreement,
    annotations,
    charts,
    claims,
    figure_3_3,
    figure_3_10,
    figure_3_13,
    section_3_2_3,
    surfaces,
    table_3_1,
    views_seen,
)  # fmt: skip

TABLES = {
    "attention_gaze": agreement.against_gaze,
    "attention_marks": agreement.against_marks,
    "annotations": annotations.build,
    "table_3_1": table_3_1.build,
    "section_3_2_3": section_3_2_3.build,
}
FIGURES = {
    "figure_3_3": figure_3_3.build,
    "figure_3_10": figure_3_10.build,
    "figure_3_12": surfaces.figure_3_12,
    "figure_3_13": figure_3_13.build,
    "saliency": surfaces.saliency,
    "views_seen": views_seen.build,
}
CHARTS = {"attention": charts.by_method, "attention_settings": charts.by_setting}
CLAIMS = claims.CLAIMS
