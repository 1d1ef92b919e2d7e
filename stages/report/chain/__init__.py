"""All stages together, from a mesh to a named object: what each choice gains, and what it costs."""

from . import changed, front

TABLES = {"front": front.table, "front_changed": changed.table}
FIGURES = {}
CHARTS = {"front": front.chart}
CLAIMS = []
