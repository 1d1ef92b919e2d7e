"""Judges a saliency of your own by human gaze, beside every method of this project: `python -m stages.bench [METHOD]`

METHOD is FILE.py:FUNCTION, a function of a mesh (vertices (n, 3), faces (m, 3), +z up) that returns (n,) values, not
negative. With --train it is a function of a list of (mesh, density) that returns such a function: it is called once for
each object, with all other objects. The gaze is that of 32 people on 19 meshes, or on 14 point clouds with --set
gaze_clouds; --gaze names its archive or folder. Other methods are not run again: their rows are in the repository.
Without METHOD, the command lists the other methods only. Metrics are means over the objects with a 95 % interval,
weighted by area; a lower KL is better. `lead` is the advantage of METHOD on the same objects; * marks a method that has
learned from the object. An object on which METHOD fails is named and left out. docs/judging.md describes the splits.

examples:
  python -m stages.bench
  python -m stages.bench my_method.py:saliency --gaze gaze.zip
  python -m stages.bench my_method.py:saliency --set gaze_clouds --by kl --objects
  python -m stages.bench my_method.py:fit --train --json > results.json
"""

import argparse
import importlib.util
import json
import sys
import warnings
from collections.abc import Callable, Sequence
from contextlib import redirect_stdout
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from haptic_glance.base.errors import errors_in_one_line
from haptic_glance.base.extras import from_extra
from haptic_glance.base.timing import WALL, Stopwatch, clock
from haptic_glance.mesh.mesh import Mesh

ROWS = "reports/measurements/{}/salient_points.csv.gz"
GAZE = "../shared/data/{}.zip"  # as conf/data has it
SETS = ("gaze", "gaze_clouds")
SCORES = {"nss": 1, "auc": 1, "cc": 1, "sim": 1, "kl": -1}  # metric: 1 where more is better, -1 where less is
YOURS = "yours"
SAME = 0.02  # NSS of HUMAN; surfaces of clouds may differ a little between machines
HUMAN = "human"  # the gaze itself, spread over the surface: no method
COST = "seconds: of the median object, without the pictures that some methods read"
PER_OBJECT = ("svm+object", "svm+viewpoint")  # T3.2.3: an SVM for the object itself

Gazed = dict[str, tuple[Mesh, Any]]


def has_seen(method: str) -> bool:
    """True for a method that learned from the very object that it is judged on."""
    return method in PER_OBJECT or method.endswith("+seen")


def run(argv: Sequence[str]) -> None:
    """Judges a method, or lists those that were."""
    parser = argparse.ArgumentParser(
        prog="python -m stages.bench", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("method", nargs="?", metavar="FILE.py:FUNCTION", help="the saliency to judge")
    parser.add_argument("--train", action="store_true", help="FUNCTION learns from the other objects")
    parser.add_argument("--set", choices=SETS, default=SETS[0], help="data set (default: %(default)s)")
    parser.add_argument("--gaze", type=Path, help=f"archive or folder of the set (default: {GAZE.format('SET')})")
    parser.add_argument("--rows", type=Path, help=f"rows of the other methods (default: {ROWS.format('SET')})")
    parser.add_argument("--by", choices=SCORES, default="nss", help="metric of order and lead (default: %(default)s)")
    parser.add_argument("--objects", action="store_true", help="also list each object, of METHOD or of all methods")
    parser.add_argument("--json", action="store_true", help="print a JSON list of the methods, with each object")
    options = parser.parse_args(argv)
    # Before the imports below, which take seconds.
    method = function_of(options.method) if options.method else None
    if method is None and (options.train or options.gaze):
        raise ValueError(f"{'--train' if options.train else '--gaze'} is about a METHOD: name one, FILE.py:FUNCTION")
    if options.gaze and not options.gaze.exists():
        raise ValueError(f"--gaze {options.gaze}: no such file")
    with from_extra():
        import pandas as pd

        from stages.engine.rows import read_rows
    path = options.rows or Path(ROWS.format(options.set))
    if not path.exists():
        raise ValueError(f"no {path}: run it in a clone of the project, or name the rows by --rows")
    scores = read_rows(path)[lambda frame: frame["metric"].isin(SCORES)]
    if method:
        archive = options.gaze or Path(GAZE.format(options.set))
        report(f"reading {archive}")
        objects = gazed(options.set, archive)
        with redirect_stdout(sys.stderr):  # a method may print, and stdout has the result
            rows = judged(method, with_own_names(objects, scores), options.train)
        if not {row["item"] for row in rows} & set(scores["item"]):
            report("the other methods were judged on other objects: no mean compares, and there is no lead")
        scores = pd.concat([scores, pd.DataFrame(rows)])
    methods = leaderboard(scores, options.by)
    if options.json:
        return print(json.dumps(methods, indent=1))
    print(as_text(methods, options.by))
    if options.objects:
        print(f"\n{objects_text([row for row in methods if not options.method or row['method'] == YOURS])}")


def report(text: str) -> None:
    """Prints progress to stderr, apart from the results."""
    print(f"bench: {text}", file=sys.stderr, flush=True)


def function_of(text: str) -> Callable:
    """The function that FILE.py:FUNCTION names; ValueError where there is none."""
    file, _, name = text.rpartition(":")
    path = Path(file)
    if not file:
        raise ValueError(f"{text}: name a file and a function of it, such as my_method.py:saliency")
    if not path.is_file():
        raise ValueError(f"{file}: no such file")
    spec = importlib.util.spec_from_file_location(path.stem, path)
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    sys.path.insert(0, str(path.parent.resolve()))  # what lies beside the file can be imported, as when it is run
    try:
        with redirect_stdout(sys.stderr):
            spec.loader.exec_module(module)
    except (Exception, SystemExit) as error:  # the file may do anything
        raise ValueError(f"{path} cannot be imported: {type(error).__name__}: {error}") from error
    if not callable(getattr(module, name, None)):
        raise ValueError(f"{path} has no function {name!r}")
    return getattr(module, name)


def judged(method: Callable, objects: Gazed, train: bool = False) -> list[dict[str, Any]]:
    """Rows of SCORES of a method on objects with gaze.

    Parameters
    ----------
    method
        A function of a mesh; with `train`, a function of [(mesh, density)] that returns one.
    objects
        {name: (mesh, GroundTruth)}, of `gazed`.
    train
        Whether the method learns, for each object, from all others. Seconds do not include the training.

    Raises
    ------
    ValueError
        If the method fails on every object. One on which it fails is named on stderr; its rows have a note, no value.
    """
    from haptic_glance.look.agreement import agreement

    rows, failed = [], {}
    for number, (name, (mesh, truth)) in enumerate(objects.items(), 1):
        report(f"{number} of {len(objects)}: {name}")
        row: dict[str, Any] = {"item": name, "method": YOURS, "clock": clock()}
        scores: dict[str, float] = {}
        try:
            training = [  # copies: a method may change what it is given
                (replace(mesh), truth.density.copy()) for other, (mesh, truth) in objects.items() if other != name
            ]
            saliency, fresh = method(training) if train else method, replace(mesh)  # without what the truth has cached
            with Stopwatch() as watch:
                values = saliency(fresh)
            if np.iscomplexobj(values):
                raise TypeError("the saliency has complex values")
            scores = agreement(np.asarray(values, dtype=np.float64), truth)
            row["seconds"] = watch.seconds
        except (Exception, SystemExit) as error:  # a method may raise anything; the other objects are judged
            row["note"] = failed[name] = " ".join(f"{type(error).__name__}: {error}".split())
            report(f"{name} is left out: {failed[name]}")
        rows += [row | {"metric": metric, "value": scores.get(metric, np.nan)} for metric in SCORES]
    if len(failed) == len(objects):
        hint = ""
        if not train and "'Mesh' object is not iterable" in failed[name]:
            hint = "; a function that learns needs --train"
        elif train and "'list' object has no attribute" in failed[name]:
            hint = "; a function of a mesh needs no --train"
        raise ValueError(f"the method failed on every object, on {name} by {failed[name]}{hint}")
    return rows


def gazed(dataset: str, archive: Path, only: Sequence[str] = ()) -> Gazed:
    """{name: (Mesh, GroundTruth)} of the objects of one of SETS; `only` names some of them, none stands for all.

    An object whose mesh or gaze is of no use is named on stderr. Raises ValueError where no object is left.
    """
    from haptic_glance.look.agreement import GroundTruth
    from stages.meshes import Params
    from stages.meshes.collect import prepare_mesh
    from stages.meshes.sources import SOURCES
    from stages.weights.ground_truth import ground_truth_amounts, published_files, spread_on_surface
    from stages.weights.training import SPREAD

    if not archive.exists():
        raise ValueError(f"{archive} is not there: conf/data/{dataset}.yaml says where to get it, --gaze names it")
    files, objects = published_files(dataset, archive), {}
    settings = Params(dataset, str(archive), "y", "unknown", list(only), {}, False)
    for item in SOURCES[dataset](settings):
        try:
            mesh, _ = prepare_mesh(item)
            amounts = ground_truth_amounts(item.name, dataset, mesh, files.get(item.name, []))
            if amounts is None:
                raise ValueError(f"no dataset_*/{item.name}.txt holds its gaze")
            density = spread_on_surface(mesh, amounts, SPREAD * mesh.diagonal)
            objects[item.name] = mesh, GroundTruth(amounts, density, mesh.vertex_areas)
        except ValueError as error:
            report(f"{item.name} is left out: {error}")
    if not objects:
        raise ValueError(f"--gaze {archive} holds no mesh with gaze of --set {dataset}")
    return objects


def with_own_names(objects: Gazed, scores: Any) -> Gazed:
    """The objects, renamed where the score of HUMAN shows that the rows of the name are of another mesh or gaze."""
    from haptic_glance.look.agreement import nss

    human = scores[(scores["method"] == HUMAN) & (scores["metric"] == "nss")].set_index("item")["value"]
    is_other = {
        name: abs(nss(truth.density, truth) - human.get(name, np.nan)) > SAME for name, (_, truth) in objects.items()
    }
    return {f"{name} (yours)" if is_other[name] else name: shape for name, shape in objects.items()}


def leaderboard(scores: Any, by: str = "nss") -> list[dict[str, Any]]:
    """Rank methods by the mean of a metric, best first.

    Parameters
    ----------
    scores
        Frame of item, method, metric, value, seconds, and where known clock and note.
    by
        One of SCORES.

    Returns
    -------
    list
        A dict a method: method, has_seen, objects (how many), each metric with its `_low` and `_high`, seconds (of the
        median object), clock, values {object: {metric: value, seconds}}, failed {object: reason}; and, where YOURS is
        among the methods, `nss_lead` with its `_low` and `_high` and so on: by how much YOURS is better, also in KL.
    """
    from stages.engine.statistics import interval

    scores = scores.reindex(columns=["item", "method", "metric", "value", "seconds", "clock", "note"])
    table = scores.pivot_table(index="item", columns=["metric", "method"], values="value")
    methods = []
    for method in table[by].columns:
        rows = scores[scores["method"] == method]
        metric_rows = rows.dropna(subset=["value"])
        row: dict[str, Any] = {"method": method, "has_seen": has_seen(method), "objects": metric_rows["item"].nunique()}
        for metric, better in SCORES.items():
            compared = {metric: table[metric][method]}
            if YOURS in table[metric] and method != YOURS:
                compared[f"{metric}_lead"] = better * (table[metric][YOURS] - table[metric][method])
            for name, values in compared.items():
                row |= zip((name, f"{name}_low", f"{name}_high"), interval(values), strict=True)
        row["seconds"] = float(metric_rows["seconds"].median())
        row["clock"] = np.nan if np.isnan(row["seconds"]) else next(iter(metric_rows["clock"].dropna()), WALL)
        row["values"] = {
            item: _without_nan(dict(zip(part["metric"], part["value"], strict=True), seconds=part["seconds"].iloc[0]))
            for item, part in metric_rows.groupby("item")
        }
        row["failed"] = rows[rows["value"].isna()].groupby("item")["note"].first().to_dict()
        methods.append(_without_nan(row))
    return sorted(methods, key=lambda row: -SCORES[by] * row[by])


def _without_nan(row: dict[str, Any]) -> dict[str, Any]:
    return {key: None if value != value else value for key, value in row.items()}


def as_text(methods: Sequence[dict[str, Any]], by: str = "nss") -> str:
    """The leaderboard as lines, with the rank of each method by a metric and the clocks of the seconds below."""
    heads = [f"{_name(metric):>20}" for metric in SCORES]
    lines = [f"{'':>3} {'method':26} objects {' '.join(heads)} {'seconds':>8} {'clock':9}  lead in {by.upper()}"]
    rank = 0
    for row in methods:
        rank += row["method"] not in (HUMAN, YOURS)
        place = ">" if row["method"] == YOURS else "" if row["method"] == HUMAN else f"{rank}"
        name = f"{row['method']} *" if row["has_seen"] else row["method"]
        cells = [f"{_bracketed(row, metric):>20}" for metric in SCORES]
        cost = "" if row["seconds"] is None else f"{row['seconds']:.3g}"
        timer = (row["clock"] or "").partition(",")[0].partition(" ")[0]
        lead = "" if row.get(f"{by}_lead") is None else f"  {_bracketed(row, f'{by}_lead', '+')}"
        lines.append(f"{place:>3} {name:26} {row['objects']:7} {' '.join(cells)} {cost:>8} {timer:9}{lead}".rstrip())
    clocks = dict.fromkeys(row["clock"] for row in methods if row["clock"])
    return "\n".join([*lines, *(f"clock: {timer}" for timer in clocks), COST])


def objects_text(methods: Sequence[dict[str, Any]]) -> str:
    """The values of each object as lines, and the objects on which a method failed, with the reason."""
    lines = [f"{'method':26} {'object':16} {' '.join(f'{metric.upper():>6}' for metric in SCORES)}  seconds"]
    for row in methods:
        for item, values in row["values"].items():
            cells = " ".join(f"{values[metric]:6.2f}" for metric in SCORES)
            cost = "" if values["seconds"] is None else f"{values['seconds']:8.3g}"
            lines.append(f"{row['method']:26} {item:16} {cells} {cost}".rstrip())
        lines += [f"{row['method']:26} {item:16} {reason}" for item, reason in row["failed"].items()]
    return "\n".join(lines)


def _name(metric: str) -> str:
    return metric.upper() if SCORES[metric] > 0 else f"{metric.upper()} (less is better)"


def _bracketed(row: dict[str, Any], name: str, sign: str = "") -> str:
    """`1.64 [1.41, 1.88]`; the mean alone where there is no interval."""
    mean, low, high = (row[key] for key in (name, f"{name}_low", f"{name}_high"))
    return f"{mean:{sign}.2f}" + ("" if low is None else f" [{low:.2f}, {high:.2f}]")


def main() -> None:
    """Runs the command line."""
    errors_in_one_line("bench")
    warnings.showwarning = lambda message, *_: report(str(message))
    run(sys.argv[1:])


if __name__ == "__main__":
    main()
