"""Simplifies each mesh with its salient neighbourhoods kept, beside plain QEM, and measures the error (T3.1.3, T3.1.4).

Reads data/SET/meshes/NAME.npz, data/SET/salient_points/NAME.npz (the points past the method's own threshold) and, of
meshes with human gaze, that gaze spread over the surface from data/SET/weights/ground_truth/NAME.npz: metric
`salient_error` is the distance weighted by the saliency of our own model, `gaze_error` by that gaze, measured where
there is some. Writes data/SET/lod/NAME/METHOD_TARGET.npz and reports/measurements/SET/lod.csv.gz: one row per metric;
the same rows without seconds and notes go to data/SET/lod/NAME/curve.csv, for later stages. Seconds are those of the
simplification on rows `faces` (with the shrinking of neighbourhoods), elsewhere those of the one call that measured the
metric, pictures included (the object's own are made once). Where two methods keep the same faces the mesh is made and
measured once. Settings: section `lod` of params.yaml.

`haptic-glance simplify` simplifies a mesh of your own.
"""

from stages.engine.settings import Workspace, workspace_of_arguments
from stages.meshes import Params as MeshesParams

from . import Params
from .data_set import simplify_all


def run(workspace: Workspace) -> None:
    """Runs the stage on the data set of a workspace."""
    settings = workspace.settings(Params)
    if not settings.methods or not settings.targets:
        raise ValueError("lod.methods and lod.targets must name at least one each")
    print(simplify_all(workspace, settings, workspace.settings(MeshesParams).source))


if __name__ == "__main__":
    run(workspace_of_arguments(__doc__, "lod"))
