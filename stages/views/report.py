"""The share of the surface that the views see (T3.2.4)."""

from . import coverage_figure

PAGE = "attention"
TABLES = {}
FIGURES = {
    "views_seen": coverage_figure.views_seen,
}
CHARTS = {}
