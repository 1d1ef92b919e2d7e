"""How many faces each object of a scene needs (T3.1.3)."""

from . import claims, counts, frames, needs, random, scene, scenes

TABLES = {
    "random_scenes": random.build, "scenes": scenes.build, "scene": scene.build, "faces_by_task": needs.build,
    "face_counts": counts.build,
}  # fmt: skip
FIGURES = {
    "random_scenes": random.figure, "scene": frames.build, "faces_by_task": needs.figure, "face_counts": counts.figure,
}  # fmt: skip
CHARTS = {"scene": scene.chart}
CLAIMS = claims.CLAIMS
