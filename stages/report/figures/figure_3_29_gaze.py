"""T figure 3.29 on a mesh with human gaze: where networks look for the object itself, from three sides."""

from ._kept import kept


def build(results):
    return kept(results, "figure_3_29")
