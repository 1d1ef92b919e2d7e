"""What a person sees of a simplified mesh, by FLIP of rendered views, of `python -m benchmarks.flip`."""

import pandas as pd

from stages.charts.datasets import dataset_text
from stages.charts.items import Table
from stages.charts.results import Results
from stages.charts.tables import Ranking, signed

BOTH = "both"  # the meshes of both sets
ERRORS = {"flip": "FLIP, %", "flip_gaze": "FLIP where people looked, %", "metro_mean": "distance of the surfaces, %"}
METHODS = {
    "weighted": "weighted by our glance", "weighted_by_gaze": "weighted by recorded gaze",
    "kept": "salient regions kept", "meshoptimizer": "meshoptimizer",
    "meshoptimizer_moving": "meshoptimizer, vertices moved",
}  # fmt: skip


def flip_table(results: Results) -> Table:
    """A row a set, share of the faces and method: errors minus those of plain simplification, in per cent.

    Parameters
    ----------
    results : Results
        The report's rows, with reports/bench/flip_means.csv.

    Returns
    -------
    Table
        The set of all meshes first.

    Raises
    ------
    NotRun
        Without the benchmark.
    """
    frame = results.bench("flip_means")
    lines = []
    for name in sorted(set(frame["set"]), key=lambda name: (name != BOTH, name)):
        for share in sorted(set(frame["share"]), reverse=True):
            rows = frame[(frame["set"] == name) & (frame["share"] == share)].set_index(["method", "error"])
            lines += [_line(rows, name, share, method) for method in METHODS if method in rows.index]
    counts = frame.groupby("set")["meshes"].max()
    words = {"meshes": " and ".join(f"{counts[name]} {_set_text(name)}" for name in counts.index if name != BOTH)}
    keys = ["faces", "method"]
    best = Ranking(list(ERRORS.values()), lowest=True, among=["faces"])
    return Table(frame, pd.DataFrame(lines), words, best, split="objects", keys=keys)


def _line(rows: pd.DataFrame, name: str, share: float, method: str) -> dict[str, str]:
    """The cells of one method; a dash where an error was not measured."""
    line = {"objects": _set_text(name), "faces": f"{share:.0%}".replace("%", " %"), "method": METHODS[method]}
    for error, title in ERRORS.items():
        ends = rows[rows.index == (method, error)][["difference", "low", "high"]].to_numpy(float).ravel().tolist()
        line[title] = signed(*ends, places=1) if ends else "–"
    return line | {"meshes": f"{rows.loc[(method, 'flip'), 'meshes']:.0f}"}


def _set_text(name: str) -> str:
    return "all meshes" if name == BOTH else dataset_text(name)
