"""Measures how many pictures and channels the model of where people look needs.

Reads data/SET/meshes and data/SET/weights of objects with human gaze. The model is learned for each set of viewpoints,
image size and choice of channels, leaving each object out, and judged on it. Writes
reports/measurements/SET/attention_settings.csv.gz: NSS and AUC of the model (fixations) and of equal weights, with the
seconds of one core from mesh to saliency. Where the pictures of `nested` are among the settings, also those two of the
models of gaze with features, channels and ridge chosen once, and chosen anew without the object.
"""

import functools
import shutil

import numpy as np

from stages.kit.command import workspace_of_arguments
from stages.kit.run import Rows, StageRun
from stages.kit.workspace import Workspace

from . import judge, measure, nested
from .schema import COLUMNS, Params


def run(workspace: Workspace) -> None:
    """Runs the stage on the data set of a workspace."""
    settings = workspace.settings(Params)
    choices = choices_of(settings)
    with StageRun(workspace, "attention_settings", COLUMNS, inputs=("meshes", "weights")) as stage:
        names = sorted(path.stem for path in (workspace.data / "weights/ground_truth").glob("*.npz"))
        if len(names) < 2:
            raise ValueError(f"{workspace.dataset} has {len(names)} objects with ground truth; two are needed")
        pictures = list(settings.pictures)
        stage.each(functools.partial(measure.process, data=workspace.data, pictures=pictures), names, ["meshes/{}.npz"])
        work = functools.partial(judge.process, data=workspace.data, made=stage.folder, names=names, choices=choices)
        stage.each(work, pictures, reads=["weights/ground_truth", "attention_settings/{}"])
        if nested.PICTURES in pictures:
            work = functools.partial(nested.process, data=workspace.data, made=stage.folder, names=names)
            stage.each(
                work, list(nested.FIXED), ["meshes", "weights/ground_truth", f"attention_settings/{nested.PICTURES}"]
            )
        for picture in pictures:
            shutil.rmtree(stage.folder / picture)  # large, and the cache of objects keeps it
        stage.metrics(summary(stage.rows))
    print(f"attention_settings: {workspace.dataset}, {len(names)} objects, {len(pictures)} sets of pictures")


def choices_of(settings: Params) -> dict[str, list[str]]:
    """{VIEWS-ROWS: choices of channels}; raises ValueError for a name that is not known."""
    for picture in settings.pictures:
        measure.parse(picture)
    for choice in settings.channels:
        if choice not in judge.CHOICES:
            raise ValueError(f"attention_settings.channels: {choice!r} is not one of {', '.join(judge.CHOICES)}")
    return {one: list(judge.CHOICES if one in settings.full else settings.channels) for one in settings.pictures}


def summary(rows: Rows) -> dict[str, float]:
    """{VIEWS-ROWS.channels: the mean NSS of the model}."""
    found: dict[str, list[float]] = {}
    for row in rows:
        if row["method"] == "fixations" and row["metric"] == "nss":
            found.setdefault(f"{row['views']}-{row['rows']}.{row['channels']}", []).append(row["value"])
    return {name: round(float(np.mean(values)), 6) for name, values in found.items()}


def main() -> None:
    """Runs the stage on the data set that the command line names."""
    run(workspace_of_arguments(__doc__, "attention_settings"))


if __name__ == "__main__":
    main()
