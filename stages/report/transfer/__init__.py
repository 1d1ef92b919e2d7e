"""From vision to touch: what networks trained on photographs are worth on imprints (T5.4, T5.5)."""

from . import (
    claims,
    coarse_imprints,
    figure_5_3,
    figure_5_4,
    networks_chart,
    table_5_3,
    table_5_4,
    table_5_6,
)

TABLES = {
    "table_5_3": table_5_3.build,
    "table_5_4": table_5_4.build,
    "table_5_6": table_5_6.build,
    "coarse_imprints": coarse_imprints.build,
}
FIGURES = {
    "figure_5_3": figure_5_3.build,
    "figure_5_4": figure_5_4.build,
}
CHARTS = {
    "networks": networks_chart.build,
}
CLAIMS = claims.CLAIMS
