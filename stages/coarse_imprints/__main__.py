"""Finds why frozen filters are at chance on a 16 x 16 array in T table 5.3.

Reads data/SET/meshes and data/SET/salient_points of classes of objects. Trains the head of a frozen MobileNetV2 on
imprints of variants that differ in one thing at a time: the array, the colour channel, how cells become pixels, the
statistics of the normalisation layers, the learning rate, the number of touches, a real sensor's faults. A quarter of
the touches, drawn at random, is tested. Writes data/SET/coarse_imprints/NAME.npz (the imprints of an object) and
reports/measurements/SET/coarse_imprints.csv.gz.
"""

import dataclasses
import functools

from haptic_glance.deep.weights import imagenet_state
from stages.engine.rows import named_means
from stages.engine.run import StageRun
from stages.engine.settings import Workspace, workspace_of_arguments
from stages.meshes.collect import read_classes

from . import COLUMNS, Params, trial
from .trial import VARIANTS


def run(workspace: Workspace) -> None:
    """Runs the stage on the data set of a workspace."""
    settings = workspace.settings(Params)
    variants = [VARIANTS[name] for name in settings.variants]
    if any(variant.weights == "imagenet" for variant in variants):
        imagenet_state("mobilenet_v2")  # before the work starts, not in each worker
    with StageRun(workspace, "coarse_imprints", COLUMNS, inputs=("meshes", "salient_points")) as stage:
        members = read_classes(workspace.data / "meshes")
        common = dataclasses.replace(settings, variants=[])  # what an object or a variant depends on
        arrays = sorted({variant.cells for variant in variants})
        work = functools.partial(
            trial.process_press, data=workspace.data, settings=common, arrays=arrays, seed=stage.seed
        )
        objects = [name for names in members.values() for name in names]
        stage.each(work, objects, reads=("meshes/{}.npz", "salient_points/{}.npz"))
        train = functools.partial(trial.process, made=stage.folder, members=members, settings=common, seed=stage.seed)
        stage.each(train, settings.variants, reads=["coarse_imprints"])
        stage.metrics(named_means((row["setting"], row["value"]) for row in stage.rows))
    print(f"coarse_imprints: {workspace.dataset}, {len(members)} classes, {len(variants)} variants")


if __name__ == "__main__":
    run(workspace_of_arguments(__doc__, "coarse_imprints"))
