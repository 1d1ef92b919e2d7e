"""The effect of the pressure array's size and of the distance of its sensels on recognition (T4.3.2)."""

from . import arrays

TABLES = {"figure_4_11": arrays.table}
FIGURES = {}
CHARTS = {"sensor_size": arrays.chart}
CLAIMS = arrays.CLAIMS
