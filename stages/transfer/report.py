"""From vision to touch: networks for photographs on imprints, and one network for both senses (T5.4 to T5.6)."""

from functools import partial

from . import hybrid_report, network_figures, network_tables
from .network_rows import COARSE, FINE

PAGE = "know"
TABLES = {
    "table_5_3": partial(network_tables.networks, data=COARSE),
    "table_5_4": partial(network_tables.networks, data=FINE),
    "table_5_6": network_tables.frozen_layers,
    "section_5_5": hybrid_report.section_5_5_table,
    "hybrid_senses": hybrid_report.hybrid_senses,
}
FIGURES = {
    "figure_5_3": network_figures.figure_5_3,
    "figure_5_4": network_figures.figure_5_4,
    "figure_5_6": hybrid_report.figure_5_6,
}
CHARTS = {
    "networks": network_figures.networks_chart,
}
