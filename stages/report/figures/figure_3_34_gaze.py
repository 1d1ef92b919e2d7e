"""T figure 3.34 on meshes with human gaze: the fused attention of networks on the surface."""

from ._kept import kept


def build(results):
    return kept(results, "figure_3_34")
