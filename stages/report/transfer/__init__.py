"""From vision to touch: what networks trained on photographs are worth on imprints (T5.4, T5.5)."""

from functools import partial

from stages.report.networks import COARSE, FINE

from . import claims, coarse_imprints, figure_5_3, figure_5_4, network_tables, networks_chart, training_curves

TABLES = {
    "table_5_3": partial(network_tables.networks, data=COARSE),
    "table_5_4": partial(network_tables.networks, data=FINE),
    "table_5_6": network_tables.frozen_layers,
    "coarse_imprints": coarse_imprints.build,
}
FIGURES = {
    "figure_5_3": figure_5_3.build,
    "figure_5_4": figure_5_4.build,
    "training_curves": training_curves.build,
}
CHARTS = {"networks": networks_chart.build}
CLAIMS = claims.CLAIMS
