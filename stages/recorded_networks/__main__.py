"""Trains networks for photographs on recorded touches, from ImageNet's weights and from random ones (T5.4).

Reads the recordings that recorded.folder names. Each network is frozen or fine-tuned as the settings say, on random
splits and on splits that keep neighbours, objects or recordings together. Writes
reports/measurements/SET/recorded_networks.csv.gz: every training, the k nearest neighbours of stage `recorded` on the
same splits, and a row with a note for each network whose weights are not at hand.
"""

import dataclasses
import functools
import sys

from haptic_glance.base.fetch import FetchError
from haptic_glance.deep.training import CONVERGED, check_passes
from haptic_glance.deep.weights import imagenet_state
from stages.engine.rows import named_means
from stages.engine.run import Rows, StageRun
from stages.engine.settings import Workspace, workspace_of_arguments
from stages.recorded import Params as RecordedParams

from . import COLUMNS, Params
from .data import SOURCES, neighbour_rows
from .recorded_training import Trial, process, trials


def run(workspace: Workspace) -> None:
    """Runs the stage on the data set of a workspace."""
    settings, recorded = workspace.settings(Params), workspace.settings(RecordedParams)
    if recorded.kind not in SOURCES:
        raise ValueError(f"recorded.kind={recorded.kind!r} is not one of {', '.join(SOURCES)}")
    recordings = SOURCES[recorded.kind](recorded.path(workspace.root))
    with StageRun(workspace, "recorded_networks", COLUMNS) as stage:
        check_passes(settings.passes, "recorded_networks.passes")
        notes = {method: reason for method in settings.networks if (reason := why_absent(method, settings))}
        planned = trials(recordings, settings)
        possible = {trial.name: trial for trial in planned if trial.weights != "imagenet" or trial.method not in notes}
        for method, reason in notes.items():
            print(f"recorded_networks: {method}: {reason}", file=sys.stderr)
        common = dataclasses.replace(
            settings, networks={}, weights=[], repetitions={}, passes=[]
        )  # a trial itself says these
        work = functools.partial(process, recordings=recordings, settings=common, seed=stage.seed)
        stage.each(work, possible, made_of={name: repr(trial) for name, trial in possible.items()})
        stage.metrics(summary(stage.rows))
        stage.rows += absent_rows([trial for trial in planned if trial.name not in possible])
        stage.rows += neighbour_rows(recorded.kind, recorded.path(workspace.root), recorded.repetitions, stage.seed)
    print(f"recorded_networks: {workspace.dataset}, {len(possible)} of {len(planned)} trials")


def why_absent(method: str, settings: Params) -> str:
    """Why ImageNet's weights of a network are not at hand; empty where they are, or are not wanted."""
    try:
        if "imagenet" in settings.weights:
            imagenet_state(method, settings.source)  # fetched before the work starts, not in each worker
    except FetchError as error:
        return str(error)
    return ""


def absent_rows(left_out: list[Trial]) -> Rows:
    """A row without a value per network, mode, number of passes and data."""
    columns = ("method", "weights", "mode", "data", "passes")
    runs = dict.fromkeys(
        (trial.method, trial.weights, trial.mode, run.data, run.passes) for trial in left_out for run in trial.runs
    )
    note = {"metric": "accuracy", "value": None, "note": "not run: weights not at hand"}
    return [dict(zip(columns, values, strict=True)) | note for values in runs]


def summary(rows: Rows) -> dict[str, float]:
    """{data.split.method.mode.weights: the mean accuracy}; the name of trainings to convergence ends with it."""
    pairs = []
    for row in rows:
        if row["metric"] == "accuracy" and "item" not in row and row["value"] is not None:
            name = ".".join(row[column] for column in ("data", "split", "method", "mode", "weights"))
            pairs.append((name + (".converged" if row["passes"] == CONVERGED else ""), row["value"]))
    return named_means(pairs)


if __name__ == "__main__":
    run(workspace_of_arguments(__doc__, "recorded_networks"))
