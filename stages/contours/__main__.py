"""Follows contours of every object, blindly and through salient points (T4.4.6).

Reads data/SET/meshes/NAME.npz and data/SET/salient_points/NAME.npz, writes data/SET/contours/NAME.npz and
reports/measurements/SET/contours.csv.gz: per object and strategy the number of sequences, the number of pairs of points
refused, the mean number of loops of a cut, the share of its length that the loop followed holds, and the share of
frames with a smaller array. An object with fewer pairs of points than sequences requested gives all of them, and its
row a note.
"""

import functools
from collections import defaultdict
from pathlib import Path
from typing import Any

import numpy as np

from haptic_glance.base.files import read_mesh
from haptic_glance.base.rng import rng
from haptic_glance.base.timing import Stopwatch
from haptic_glance.touch import Surface
from stages.engine.run import Rows, StageRun
from stages.engine.settings import Workspace, workspace_of_arguments
from stages.engine.statistics import interval_metrics
from stages.salient_points.measure import read_points

from . import Params
from .contours import sample_contours, write_sequences

BLIND = "random"  # the strategy that any two vertices serve


def process(name: str, folder: Path, data: Path, settings: Params, seed: int) -> Rows:
    """The contours of one object by all strategies; writes its file and returns its rows."""
    mesh = read_mesh(data / "meshes" / f"{name}.npz")
    points = {**read_points(data / "salient_points" / f"{name}.npz"), BLIND: np.unique(mesh.faces)}
    unknown = [strategy for strategy in settings.strategies if strategy not in points]
    if unknown:
        raise ValueError(f"contours.strategies: {unknown[0]} is not among {', '.join(points)} (salient_points.methods)")
    surface, sequences, rows = Surface(mesh), {}, []
    for strategy in settings.strategies:
        draws = rng(seed, f"contours {name} {strategy}")
        array = settings.frames, (settings.cells[0], settings.cells[1]), settings.pitch
        with Stopwatch() as watch:
            sequences[strategy], facts = sample_contours(surface, points[strategy], settings.count, draws, *array)
        common = {"item": name, "method": strategy, "seconds": watch.seconds}
        rows += [{**common, "metric": key, "value": value, "note": None} for key, value in facts.items()]
        if facts["sequences"] < settings.count:
            rows[-len(facts)]["note"] = (
                f"{name}, {strategy}: {facts['sequences']} sequences of {settings.count}; its {len(points[strategy])} "
                "points have no more pairs that make a plane with the centre"
            )
    write_sequences(folder / f"{name}.npz", sequences)
    return rows


def summary(rows: Rows, seed: int) -> dict[str, Any]:
    """{strategy: {sequences, refused: sums, share, shrunk: {mean, low, high} over the objects}}."""
    values = defaultdict(list)
    for row in rows:
        if row["value"] is not None:
            values[row["method"], row["metric"]].append(row["value"])
    tree = {}
    for (strategy, metric), numbers in values.items():
        if metric in ("sequences", "refused"):
            tree.setdefault(strategy, {})[metric] = sum(numbers)
        elif metric in ("share", "shrunk"):
            tree[strategy][metric] = interval_metrics(numbers, seed)
    return tree


def run(workspace: Workspace) -> None:
    """Runs the stage on the data set of a workspace."""
    settings = workspace.settings(Params)
    if not settings.strategies:
        raise ValueError(f"contours.strategies is empty: name {BLIND}, or methods of salient_points.methods")
    with StageRun(workspace, "contours", inputs=("meshes", "salient_points")) as stage:
        objects = stage.objects
        work = functools.partial(process, data=workspace.data, settings=settings, seed=stage.seed)
        rows = stage.each(work, objects, reads=("meshes/{}.npz", "salient_points/{}.npz"))
        stage.metrics(summary(rows, stage.seed))
    for note in [row["note"] for row in rows if row["note"]]:
        print(f"contours: {note}")
    sequence_count = sum(row["value"] for row in rows if row["metric"] == "sequences")
    strategies = len(settings.strategies)
    print(f"contours: {workspace.dataset}, {len(objects)} objects, {strategies} strategies, {sequence_count} sequences")


if __name__ == "__main__":
    run(workspace_of_arguments(__doc__, "contours"))
