"""What the pressure array's size and the distance of its sensels do to recognition (T4.3.2)."""

from . import (
    claims,
    figure_4_11,
    sensor_size,
)

TABLES = {
    "figure_4_11": figure_4_11.build,
}
FIGURES = {}
CHARTS = {
    "sensor_size": sensor_size.build,
}
CLAIMS = claims.CLAIMS
