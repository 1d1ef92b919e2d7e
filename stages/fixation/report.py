"""Grad-CAM attention against human gaze (T3.3)."""

from functools import partial

from . import agreement_report, attention_pictures

PAGE = "look"

TABLES = {"fixation": agreement_report.build}
FIGURES = {
    "figure_3_28": agreement_report.figure_3_28,
    "figure_3_29": attention_pictures.figure_3_29,
    "figure_3_30": attention_pictures.figure_3_30,
    "figure_3_30_gaze": partial(attention_pictures.on_gaze, attention_pictures.figure_3_30),
    "figure_3_31": agreement_report.figure_3_31,
    "figure_3_32": agreement_report.figure_3_32,
    "figure_3_34": attention_pictures.figure_3_34,
    "figure_3_34_gaze": partial(attention_pictures.on_gaze, attention_pictures.figure_3_34),
    "figure_3_35": agreement_report.figure_3_35,
    "figure_3_36": agreement_report.figure_3_36,
}
CHARTS = {"fixation": agreement_report.chart}
