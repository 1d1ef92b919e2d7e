"""Where people look: models of attention against human gaze and marks (T3.1, T3.2)."""

from . import agreement, annotations, charts, claims, learned, maps, nested, views_seen

TABLES = {
    "attention_gaze": agreement.against_gaze,
    "attention_nested": nested.build,
    "attention_clouds": agreement.against_clouds,
    "attention_marks": agreement.against_marks,
    "annotations": annotations.build,
    "table_3_1": learned.table_3_1,
    "section_3_2_3": learned.section_3_2_3,
}
FIGURES = {
    "figure_3_3": maps.figure_3_3,
    "figure_3_10": maps.figure_3_10,
    "figure_3_12": maps.figure_3_12,
    "figure_3_13": maps.figure_3_13,
    "saliency": maps.saliency,
    "views_seen": views_seen.build,
}
CHARTS = {"attention": charts.by_method}
CLAIMS = claims.CLAIMS
