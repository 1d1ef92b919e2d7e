"""Models of attention against human gaze and marks (T3.1, T3.2)."""

from . import claims, learned, maps

TABLES = {
    "attention_gaze": claims.against_gaze,
    "attention_clouds": claims.against_clouds,
    "attention_marks": claims.against_marks,
    "table_3_1": learned.table_3_1,
    "section_3_2_3": learned.section_3_2_3,
}
FIGURES = {
    "figure_3_3": maps.figure_3_3,
    "figure_3_10": maps.figure_3_10,
    "figure_3_12": maps.figure_3_12,
    "figure_3_13": maps.figure_3_13,
    "views_seen": maps.build,
}
CHARTS = {"attention": maps.by_method}
