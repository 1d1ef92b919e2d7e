"""Grad-CAM attention against human gaze (T3.3)."""

from functools import partial

from . import agreement, maps

TABLES = {"fixation": agreement.build}
FIGURES = {
    "figure_3_28": agreement.figure_3_28,
    "figure_3_29": maps.figure_3_29,
    "figure_3_30": maps.figure_3_30,
    "figure_3_30_gaze": partial(maps.on_gaze, maps.figure_3_30),
    "figure_3_31": agreement.figure_3_31,
    "figure_3_32": agreement.figure_3_32,
    "figure_3_34": maps.figure_3_34,
    "figure_3_34_gaze": partial(maps.on_gaze, maps.figure_3_34),
    "figure_3_35": agreement.figure_3_35,
    "figure_3_36": agreement.figure_3_36,
}
CHARTS = {"fixation": agreement.chart}
