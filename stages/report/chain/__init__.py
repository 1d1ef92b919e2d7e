"""All stages together, from a mesh to a named object: what each choice gains, and what it costs."""

from . import front

TABLES = {"front": front.front_table, "front_changed": front.changed}
FIGURES = {}
CHARTS = {"front": front.chart}
CLAIMS = []
