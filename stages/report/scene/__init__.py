"""How many faces each object of a scene needs (T3.1.3)."""

from . import (
    face_counts,
    face_counts_figure,
    scene,
    scene_chart,
    scene_figure,
    scenes,
)

TABLES = {
    "face_counts": face_counts.build,
    "scene": scene.build,
    "scenes": scenes.build,
}
FIGURES = {
    "face_counts": face_counts_figure.build,
    "scene": scene_figure.build,
}
CHARTS = {
    "scene": scene_chart.build,
}
CLAIMS = []
