"""Judges a saliency of your own by human gaze, beside every method of this project: `python -m stages.bench [METHOD]`

METHOD is FILE.py:FUNCTION, a function of a mesh (vertices (n, 3), faces (m, 3), +z up) that returns (n,) values, not
negative. It is asked about 19 meshes with the gaze of 32 people; --gaze names their archive or folder. The others are
not run again: their rows are in reports/measurements/gaze. Without METHOD, the list of these alone. NSS and AUC are by
area, means over the meshes with a 95 % interval; `lead`: METHOD's NSS less theirs, on the same meshes.

examples:
  haptic-glance bench
  haptic-glance bench my_method.py:saliency --gaze gaze.zip
  haptic-glance bench my_method.py:saliency --json > results.json
"""

import argparse
import importlib.util
import json
import sys
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from stages.kit import Mesh, Stopwatch
from stages.kit.command import errors_in_one_line
from stages.kit.extras import from_extra
from stages.kit.parallel import progress

ROWS = Path("reports/measurements/gaze/salient_points.csv.gz")
GAZE = Path("../shared/data/gaze.zip")  # as conf/data/gaze.yaml has it
SCORES = ("nss", "auc")
OWN = "yours"
HUMAN = "human"  # the gaze itself: what no method can exceed

Saliency = Callable[[Mesh], np.ndarray]


def run(argv: Sequence[str]) -> None:
    """Judges a method, or lists those that were."""
    parser = argparse.ArgumentParser(
        prog="haptic-glance bench", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("method", nargs="?", metavar="FILE.py:FUNCTION", help="the saliency to judge")
    parser.add_argument("--gaze", type=Path, default=GAZE, help="archive or folder of the gaze (default: %(default)s)")
    parser.add_argument("--rows", type=Path, default=ROWS, help="rows of the other methods (default: %(default)s)")
    parser.add_argument("--json", action="store_true", help="print a JSON list of the methods, best first")
    given = parser.parse_args(argv)
    with from_extra():
        import pandas as pd

        from stages.kit.rows import read_rows
    if not given.rows.exists():
        raise ValueError(f"no {given.rows}: run it in a clone of the project, or name the rows by --rows")
    scores = read_rows(given.rows)[lambda frame: frame["metric"].isin(SCORES)]
    if given.method:
        scores = pd.concat([scores, pd.DataFrame(judged(function_of(given.method), given.gaze))])
    found = leaderboard(scores)
    print(json.dumps(found, indent=1) if given.json else as_text(found))


def function_of(text: str) -> Saliency:
    """The function that FILE.py:FUNCTION names; ValueError where there is none."""
    file, _, name = text.rpartition(":")
    path = Path(file)
    if not path.is_file():
        raise ValueError(f"{text}: name a file and a function of it, such as my_method.py:saliency")
    spec = importlib.util.spec_from_file_location(path.stem, path)
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    sys.path.insert(0, str(path.parent.resolve()))  # what lies beside the file can be imported, as when it is run
    spec.loader.exec_module(module)
    if not callable(getattr(module, name, None)):
        raise ValueError(f"{path} has no function {name!r}")
    return getattr(module, name)


def judged(method: Saliency, archive: Path) -> list[dict[str, Any]]:
    """Rows of SCORES of a method on all meshes with gaze. ValueError where its values are no saliency of a mesh."""
    from stages.weights.agreement import agreement

    rows = []
    for name, mesh, truth in gazed(archive):
        with Stopwatch() as watch:
            values = method(mesh)
        try:
            found = agreement(np.asarray(values, dtype=np.float64), truth)
        except (TypeError, ValueError) as error:
            raise ValueError(f"{name}: {error}") from None
        row = {"item": name, "method": OWN, "seconds": watch.seconds}
        rows += [row | {"metric": metric, "value": found[metric]} for metric in SCORES]
    return rows


def gazed(archive: Path) -> Iterator[tuple[str, Mesh, Any]]:
    """Yields (name, Mesh, GroundTruth) of every mesh with gaze."""
    from stages.meshes.collect import prepare_mesh
    from stages.meshes.schema import Params
    from stages.meshes.sources import gaze
    from stages.weights.agreement import GroundTruth
    from stages.weights.ground_truth import ground_truth_amounts, spread_on_surface
    from stages.weights.ground_truth.source import published_files
    from stages.weights.training_data import SPREAD

    files = published_files("gaze", archive)
    for item in progress(gaze(Params("gaze", str(archive), "y", "unknown", [], {}, False)), "bench"):
        mesh, _ = prepare_mesh(item)
        amounts = ground_truth_amounts(item.name, "gaze", mesh, files.get(item.name, []))
        if amounts is not None:
            density = spread_on_surface(mesh, amounts, SPREAD * mesh.diagonal)
            yield item.name, mesh, GroundTruth(amounts, density, mesh.vertex_areas)


def leaderboard(scores: Any) -> list[dict[str, Any]]:
    """A dict a method, best NSS first: method, objects, nss, nss_low, nss_high, auc and so on, seconds, lead and so on.

    scores: frame of item, method, metric, value, seconds.
    """
    from stages.kit.stats import interval

    table = scores.pivot_table(index="item", columns=["metric", "method"], values="value")
    seconds = scores.dropna(subset=["value"]).groupby("method")["seconds"].median()
    found = []
    for method in table["nss"].columns:
        row: dict[str, Any] = {"method": method, "objects": int(table["nss"][method].notna().sum())}
        for metric in SCORES:
            row |= dict(zip([metric, f"{metric}_low", f"{metric}_high"], interval(table[metric][method]), strict=True))
        row["seconds"] = float(seconds[method])
        if OWN in table["nss"] and method != OWN:
            lead = interval(table["nss"][OWN] - table["nss"][method])
            row |= dict(zip(["lead", "lead_low", "lead_high"], lead, strict=True))
        found.append({key: None if value != value else value for key, value in row.items()})
    return sorted(found, key=lambda row: -row["nss"])


def as_text(found: Sequence[dict[str, Any]]) -> str:
    """The leaderboard as lines."""
    lines = [f"{'':>3} {'method':26} {'NSS':>20} {'AUC':>6} {'seconds':>8}  lead"]
    rank = 0
    for row in found:
        rank += row["method"] not in (HUMAN, OWN)
        place = ">" if row["method"] == OWN else "" if row["method"] == HUMAN else f"{rank}"
        nss = f"{row['nss']:.2f} [{row['nss_low']:.2f}, {row['nss_high']:.2f}]"
        cost = "" if row["seconds"] is None else f"{row['seconds']:.2f}"
        lead = "" if row.get("lead") is None else f"{row['lead']:+.2f} [{row['lead_low']:.2f}, {row['lead_high']:.2f}]"
        lines.append(f"{place:>3} {row['method']:26} {nss:>20} {row['auc']:6.2f} {cost:>8}  {lead}".rstrip())
    return "\n".join(lines)


def main() -> None:
    """Runs the command line."""
    errors_in_one_line("bench")
    run(sys.argv[1:])


if __name__ == "__main__":
    main()
