"""Tests networks trained on photographs on imprints, beside untrained ones (T5.2 to T5.4).

Reads data/SET/meshes and data/SET/salient_points of classes of objects. Presses the touches of every object with a
fine and a coarse array, then trains transfer.networks from each of transfer.weights, with touches drawn at random for
testing and with whole objects left out. Writes data/SET/transfer: imprints/NAME.npz, networks/TRIAL.npz (what was
trained, of the first repetition) and predictions/TRIAL.npz. Stitches hybrid networks for sight and touch (T5.5) of
networks that share their middle, to data/SET/transfer/hybrid. The rows are in reports/measurements/SET/transfer.csv.gz:
accuracies, also on disturbed touches, the change of each convolution, and the confusions of the hybrid.
"""

import dataclasses
import functools
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

from haptic_glance.base.files import read_mesh
from haptic_glance.deep.weights import imagenet_state
from stages.engine.run import Rows, StageRun
from stages.engine.settings import Workspace, workspace_of_arguments
from stages.meshes.collect import read_classes

from . import COLUMNS, Params, hybrid, hybrid_data, imprint_images, network_training
from .imprint_images import count_touchable_vertices
from .plan import Plan, check, plan, seen, summary, trial_row

MADE = ("transfer/imprints", "transfer/hybrid/pictures")  # touches and pictures of all objects


def train(
    name: str, folder: Path, made: Path, members: Mapping[str, Mapping[str, Sequence[str]]], settings: Params, seed: int
) -> Rows:
    """Rows of one training, or of one hybrid network."""
    if name.startswith("hybrid."):
        return hybrid.process(name, folder, made, members, of_hybrids(settings), seed)
    return network_training.process(name, folder, made, members, settings, seed)


def of_hybrids(settings: Params) -> Params:
    """The settings of hybrid networks, which see images of another size."""
    return dataclasses.replace(settings, size=settings.hybrid_size)


def train_all(stage: StageRun, planned: Plan, settings: Params) -> dict[str, dict]:
    """Presses, trains and stitches what is planned; returns the metrics."""
    members, data = planned.members, stage.workspace.data
    objects = [name for names in members["random"].values() for name in names]
    # What says only which trainings there are is left out: one training more repeats no other.
    common = dataclasses.replace(settings, networks={}, weights=[], uncontrolled=[], splits={}, passes=[])
    press = functools.partial(imprint_images.process, data=data, settings=common, seed=stage.seed)
    stage.each(press, objects, reads=("meshes/{}.npz", "salient_points/{}.npz"))
    hybrids = hybrid.trials(settings, members)
    if hybrids:
        imagenet_state("mobilenet_v2", settings.source)  # before the work starts, not in each worker
        take = functools.partial(hybrid_data.process, data=data, settings=of_hybrids(common), seed=stage.seed)
        stage.each(take, objects, reads=("meshes/{}.npz",))
    work = functools.partial(train, made=stage.folder, members=members, settings=common, seed=stage.seed)
    rows = stage.each(work, [*(training.name for training in planned.trials), *hybrids], reads=MADE)
    trained = [trial_row(row, planned.pretrained, settings) for row in rows if "trial" in row]
    stitched = [row | seen(of_hybrids(settings)) for row in rows if "trial" not in row]
    stage.rows = [*trained, *stitched]
    metrics = summary(trained, stage.seed)
    if hybrids:
        metrics["hybrid"] = hybrid.summary(stitched, settings, stage.seed)
    return metrics


def run(workspace: Workspace) -> None:
    """Runs the stage on the data set of a workspace."""
    settings = workspace.settings(Params)
    check(settings)
    with StageRun(workspace, "transfer", COLUMNS, inputs=("meshes", "salient_points")) as stage:
        classes = read_classes(workspace.data / "meshes")
        vertices = {
            name: count_touchable_vertices(read_mesh(workspace.data / "meshes" / f"{name}.npz"))
            for objects in classes.values()
            for name in objects
        }
        planned = plan(classes, vertices, settings)
        for _, note in planned.notes:
            print(f"transfer: {note}", file=sys.stderr)
        stage.metrics(train_all(stage, planned, settings) if planned.trials else {})
        stage.rows += [columns | {"metric": "accuracy", "value": None, "note": note} for columns, note in planned.notes]
    print(f"transfer: {workspace.dataset}, {len(planned.members['random'])} classes, {len(planned.trials)} trainings")


if __name__ == "__main__":
    run(workspace_of_arguments(__doc__, "transfer"))
