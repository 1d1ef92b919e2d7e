"""Follows contours of the objects of all classes, blindly and through salient points (T4.4.6).

Reads data/classes/NAME.npz, writes data/contours/NAME.npz and reports/measurements/contours.csv: for each object and
strategy the number of sequences and of pairs of points refused, the mean number of loops of a cut and the share of its
length that the loop followed holds, the share of frames with a smaller array, and the seconds. An object that has
fewer pairs of points than sequences wanted gives all it has, and its row a note.
"""

import functools
from collections import defaultdict

import numpy as np

from stages.classes import read_object
from stages.imprints import Surface
from stages.kit import StageRun, Stopwatch, arguments, params
from stages.kit.rng import rng
from stages.kit.run import DATA
from stages.kit.stats import interval_metrics

from .files import write_sequences
from .gather import gather

BLIND = "random"  # the strategy that any two vertices serve


def process(name, folder, settings, seed):
    """The contours of one object by all strategies; writes its file and returns its rows."""
    mesh, found = read_object(DATA / "classes" / f"{name}.npz")
    points = {BLIND: np.unique(mesh.faces), **found}
    unknown = [strategy for strategy in settings.strategies if strategy not in points]
    if unknown:
        raise ValueError(f"contours.strategies: {unknown[0]} is not among {', '.join(points)} (classes.methods)")
    surface, sequences, rows = Surface(mesh), {}, []
    for strategy in settings.strategies:
        draws = rng(seed, f"contours {name} {strategy}")
        array = settings.frames, tuple(settings.cells), settings.pitch
        with Stopwatch() as watch:
            sequences[strategy], facts = gather(surface, points[strategy], settings.count, draws, *array)
        common = {"object": name, "method": strategy, "seconds": watch.seconds}
        rows += [{**common, "metric": key, "value": value, "note": None} for key, value in facts.items()]
        if facts["sequences"] < settings.count:
            rows[-len(facts)]["note"] = (
                f"{name}, {strategy}: {facts['sequences']} sequences of {settings.count}; its {len(points[strategy])} "
                "points have no more pairs that make a plane with the centre"
            )
    write_sequences(folder / f"{name}.npz", sequences)
    return rows


def summary(rows, seed):
    """{strategy: {sequences, refused: sums, share, shrunk: {mean, low, high} over the objects}}."""
    values = defaultdict(list)
    for row in rows:
        if row["value"] is not None:
            values[row["method"], row["metric"]].append(row["value"])
    tree = {}
    for (strategy, metric), found in values.items():
        if metric in ("sequences", "refused"):
            tree.setdefault(strategy, {})[metric] = sum(found)
        elif metric in ("share", "shrunk"):
            tree[strategy][metric] = interval_metrics(found, seed)
    return tree


def main():
    arguments(__doc__)
    settings = params("contours")
    if not settings.strategies:
        raise ValueError(f"contours.strategies is empty: name {BLIND}, or detectors of classes.methods")
    with StageRun("contours", inputs=("classes",)) as run:
        run.dataset = params("classes").source
        names = sorted(path.stem for path in (DATA / "classes").glob("*.npz"))
        rows = run.each(functools.partial(process, settings=settings, seed=run.seed), names)
        run.metrics(summary(rows, run.seed))
    for note in [row["note"] for row in rows if row["note"]]:
        print(f"contours: {note}")
    counted = sum(row["value"] for row in rows if row["metric"] == "sequences")
    print(f"contours: {len(names)} objects, {len(settings.strategies)} strategies, {counted} sequences")


if __name__ == "__main__":
    main()
