"""The stability of methods: the disturbance and severity at which each breaks."""

from . import breaking_report

PAGE = "stability"
TABLES = {
    "stability": breaking_report.points_table,
}
FIGURES = {
    "stability": breaking_report.points_figure,
}
CHARTS = {}
