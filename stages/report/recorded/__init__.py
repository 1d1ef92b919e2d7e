"""Recorded touches: selection, networks and simulation on sensors of others (T4.2.4, T5.4)."""

from functools import partial

from . import (
    claims_networks,
    claims_series,
    claims_touches,
    grasp_series,
    grasps,
    real_networks,
    simulated_to_real,
    table_4_4,
    touch_events,
)

TABLES = {
    "table_4_4": table_4_4.build,
    "grasps": grasps.build,
    "touch_events": touch_events.build,
    "touch_events_conditions": touch_events.conditions,
    "grasp_series": grasp_series.build,
    "simulated_to_real": simulated_to_real.build_table,
    "real_networks": real_networks.build,
    "table_5_1": partial(real_networks.printed, "vt60", "table_5_1_vt60_bathtip"),
    "table_5_2": partial(real_networks.printed, "vitac", "table_5_2_vitac_gelsight"),
    "table_5_5": partial(real_networks.printed, "bigs", "table_5_5_bigs_barrett"),
}
FIGURES = {"real_touches": simulated_to_real.build_figure}
CHARTS = {"network_sizes": real_networks.chart, "touch_events_heard": touch_events.chart}
CLAIMS = [*claims_touches.CLAIMS, *claims_networks.CLAIMS, *claims_series.CLAIMS]
