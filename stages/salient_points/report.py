"""Models of attention against human gaze and marks (T3.1, T3.2)."""

from . import agreement_tables, attention_figures

PAGE = "attention"
TABLES = {
    "attention_gaze": agreement_tables.against_gaze,
    "attention_clouds": agreement_tables.against_clouds,
    "attention_marks": agreement_tables.against_marks,
}
FIGURES = {
    "figure_3_3": attention_figures.figure_3_3,
    "figure_3_10": attention_figures.figure_3_10,
    "figure_3_12": attention_figures.figure_3_12,
    "figure_3_13": attention_figures.figure_3_13,
}
CHARTS = {
    "attention": attention_figures.by_method,
}
