"""Checks on meshes with human gaze: the thesis's choice of viewpoints (T3.2.4), and how far choices flatter the glance.

Reads data/SET/meshes and data/SET/weights of objects with human gaze. Writes
reports/measurements/SET/attention_checks.csv.gz: NSS and AUC of equal weights from the most salient of 62 viewpoints,
from four and from twelve; and of the glance with features and ridge chosen once (glance_once), and chosen anew without
the object (glance_nested).
"""

import functools

from haptic_glance.look.weights.weights import GLANCE
from stages.engine.rows import named_means
from stages.engine.run import Rows, StageRun
from stages.engine.settings import Workspace, workspace_of_arguments

from . import COLUMNS, Params, checks


def run(workspace: Workspace) -> None:
    """Runs the stage on the data set of a workspace."""
    views = list(workspace.settings(Params).views)
    with StageRun(workspace, "attention_checks", COLUMNS, inputs=("meshes", "weights")) as stage:
        names = sorted(path.stem for path in (workspace.data / "weights/ground_truth").glob("*.npz"))
        if len(names) < 2:
            raise ValueError(f"{workspace.dataset} has {len(names)} objects with ground truth; two are needed")
        work = functools.partial(checks.process_views, data=workspace.data, views=views)
        stage.each(work, names, ["meshes/{}.npz", "weights/ground_truth/{}.npz"])
        work = functools.partial(checks.process_nested, data=workspace.data, names=names)
        stage.each(work, [GLANCE], ["meshes", "weights/ground_truth"])
        stage.metrics(summary(stage.rows))
    print(f"attention_checks: {workspace.dataset}, {len(names)} objects, viewpoints {', '.join(views)}")


def summary(rows: Rows) -> dict[str, float]:
    """{METHOD, or METHOD.VIEWS: its mean NSS}."""
    return named_means(
        (".".join([row["method"], *filter(None, [row.get("views")])]), row["value"])
        for row in rows
        if row["metric"] == "nss"
    )


if __name__ == "__main__":
    run(workspace_of_arguments(__doc__, "attention_checks"))
