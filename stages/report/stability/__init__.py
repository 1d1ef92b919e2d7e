"""The stability of methods: the perturbation and severity at which each breaks; and the time of each kernel."""

from . import breaking, costs, touch

TABLES = {"stability": breaking.points_table, "touch_stability": touch.table}
FIGURES = {"stability": breaking.points_figure, "touch_stability": touch.figure, "kernels": costs.kernels}
CHARTS = {}
