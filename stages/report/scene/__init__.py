"""How many faces each object of a scene needs (T3.1.3)."""

from . import counts, scene

TABLES = {
    "random_scenes": scene.random_table, "scenes": scene.scenes, "scene": scene.scene_table,
    "faces_by_task": counts.needs, "face_counts": counts.counts_table,
}  # fmt: skip
FIGURES = {"scene": counts.frames, "faces_by_task": counts.needs_figure, "face_counts": counts.figure}
CHARTS = {"scene": scene.chart}
