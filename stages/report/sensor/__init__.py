"""What the pressure array's size and the distance of its sensels do to recognition (T4.3.2)."""

from . import arrays

TABLES = {"figure_4_11": arrays.table}
FIGURES = {}
CHARTS = {"sensor_size": arrays.chart}
CLAIMS = arrays.CLAIMS
