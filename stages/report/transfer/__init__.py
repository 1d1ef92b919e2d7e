"""From vision to touch: what networks trained on photographs are worth on imprints (T5.4, T5.5)."""

from functools import partial

from stages.report.networks import COARSE, FINE

from . import figures, tables

TABLES = {
    "table_5_3": partial(tables.networks, data=COARSE),
    "table_5_4": partial(tables.networks, data=FINE),
    "table_5_6": tables.frozen_layers,
}
FIGURES = {
    "figure_5_3": figures.figure_5_3,
    "figure_5_4": figures.figure_5_4,
}
CHARTS = {"networks": figures.networks_chart}
