"""Where networks look: Grad-CAM attention against human gaze (T3.3)."""

from . import agreement, claims, detectors, figure_3_28, figure_3_31, figure_3_32, fixation_chart, maps

TABLES = {"fixation": agreement.build}
FIGURES = {
    "figure_3_28": figure_3_28.build,
    "figure_3_29": maps.figure_3_29,
    "figure_3_29_gaze": maps.on_gaze(maps.figure_3_29, "figure_3_29_gaze"),
    "figure_3_30": maps.figure_3_30,
    "figure_3_30_gaze": maps.on_gaze(maps.figure_3_30, "figure_3_30_gaze"),
    "figure_3_31": figure_3_31.build,
    "figure_3_32": figure_3_32.build,
    "figure_3_34": maps.figure_3_34,
    "figure_3_34_gaze": maps.on_gaze(maps.figure_3_34, "figure_3_34_gaze"),
    "figure_3_35": detectors.figure_3_35,
    "figure_3_36": detectors.figure_3_36,
}
CHARTS = {"fixation": fixation_chart.build}
CLAIMS = claims.CLAIMS
