"""T figure 3.30 on a mesh with human gaze: where a network looks in each of its tasks."""

from ._kept import kept


def build(results):
    return kept(results, "figure_3_30")
