"""How many faces each object of a scene needs (T3.1.3)."""

from . import budget_report, counts_report

PAGE = "scene"
TABLES = {
    "scene": budget_report.scene_table,
    "face_counts": counts_report.counts_table,
}
FIGURES = {
    "scene": counts_report.frames,
}
CHARTS = {
    "scene": budget_report.chart,
}
