"""Recorded touches: selection, networks and simulation on sensors of others (T4.2.4, T5.4)."""

from . import (
    claims_networks,
    claims_touches,
    grasps,
    network_sizes,
    real_networks,
    real_touches,
    simulated_to_real,
    table_4_4,
    table_5_1,
    table_5_2,
    table_5_5,
)

TABLES = {
    "table_4_4": table_4_4.build,
    "grasps": grasps.build,
    "simulated_to_real": simulated_to_real.build,
    "real_networks": real_networks.build,
    "table_5_1": table_5_1.build,
    "table_5_2": table_5_2.build,
    "table_5_5": table_5_5.build,
}
FIGURES = {
    "real_touches": real_touches.build,
}
CHARTS = {
    "network_sizes": network_sizes.build,
}
CLAIMS = [*claims_touches.CLAIMS, *claims_networks.CLAIMS]
