"""Recorded touches: selection, networks and simulation on sensors of others (T4.2.4, T5.4)."""

from functools import partial

from . import networks, tables

TABLES = {
    "table_4_4": tables.table_4_4,
    "simulated_to_real": networks.build_table,
    "real_networks": networks.build,
    "table_5_1": partial(networks.printed, "vt60", "table_5_1_vt60_bathtip"),
    "table_5_2": partial(networks.printed, "vitac", "table_5_2_vitac_gelsight"),
    "table_5_5": partial(networks.printed, "bigs", "table_5_5_bigs_barrett"),
}
FIGURES = {}
CHARTS = {"network_sizes": networks.chart}
