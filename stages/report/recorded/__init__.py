"""Recorded touches: selection, networks and simulation on sensors of others (T4.2.4, T5.4)."""

from functools import partial

from . import claims_networks, claims_touches, grasps, real_networks, simulated_to_real, table_4_4

TABLES = {
    "table_4_4": table_4_4.build,
    "grasps": grasps.build,
    "simulated_to_real": simulated_to_real.build_table,
    "real_networks": real_networks.build,
    "table_5_1": partial(real_networks.printed, "vt60", "table_5_1_vt60_bathtip"),
    "table_5_2": partial(real_networks.printed, "vitac", "table_5_2_vitac_gelsight"),
    "table_5_5": partial(real_networks.printed, "bigs", "table_5_5_bigs_barrett"),
}
FIGURES = {"real_touches": simulated_to_real.build_figure}
CHARTS = {"network_sizes": real_networks.chart}
CLAIMS = [*claims_touches.CLAIMS, *claims_networks.CLAIMS]
