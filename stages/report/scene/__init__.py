"""How many faces each object of a scene needs (T3.1.3)."""

from . import counts, frames, scene, scenes

TABLES = {"face_counts": counts.build, "scene": scene.build, "scenes": scenes.build}
FIGURES = {"face_counts": counts.figure, "scene": frames.build}
CHARTS = {"scene": scene.chart}
CLAIMS = []
