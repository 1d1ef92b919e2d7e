"""How many faces each object of a scene needs (T3.1.3)."""

from . import counts, random, scene

TABLES = {
    "random_scenes": random.random_table,
    "scenes": scene.scenes,
    "scene": scene.scene_table,
    "faces_by_task": random.needs,
    "face_counts": counts.counts_table,
}
FIGURES = {
    "scene": counts.frames,
    "faces_by_task": random.needs_figure,
    "face_counts": counts.figure,
}
CHARTS = {"scene": scene.chart}
CLAIMS = random.CLAIMS
