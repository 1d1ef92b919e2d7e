"""Recognises touches that others recorded: by the thesis's protocol, and where it flatters (T4.2.4, table 4.4).

Reads the archive that recorded.folder names. Writes reports/measurements/SET/recorded.csv.gz: what was measured, never
the recordings. A data set is one kind of recording, recorded.kind: images of a pressure array, or grasps of a hand.
"""

from stages.classification.touch_readers import read_grasps, read_pressure_images
from stages.engine.run import StageRun
from stages.engine.settings import Workspace, workspace_of_arguments

from . import COLUMNS, Params, biotac_grasps, pressure_images

KINDS = {  # kind: how it is read, and what measures it
    "pressure_images": (read_pressure_images, pressure_images),
    "biotac_grasps": (read_grasps, biotac_grasps),
}


def run(workspace: Workspace) -> None:
    """Runs the stage on the data set of a workspace."""
    settings = workspace.settings(Params)
    if settings.kind not in KINDS:
        raise ValueError(f"recorded.kind={settings.kind!r} is not one of {', '.join(KINDS)}")
    reader, kind = KINDS[settings.kind]
    recording = reader(settings.path(workspace.root))
    with StageRun(workspace, "recorded", COLUMNS) as stage:
        kind.measure(stage, recording, settings.repetitions)
        stage.metrics(kind.summary(stage.rows))
    print(f"recorded: {workspace.dataset}, {len(stage.rows):,} rows")


if __name__ == "__main__":
    run(workspace_of_arguments(__doc__, "recorded"))
