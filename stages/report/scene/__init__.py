"""How many faces each object of a scene needs (T3.1.3)."""

from . import counts, scene

TABLES = {"scene": scene.scene_table, "face_counts": counts.counts_table}
FIGURES = {"scene": counts.frames, "face_counts": counts.figure}
CHARTS = {"scene": scene.chart}
