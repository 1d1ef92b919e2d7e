"""Files of the report beside tables and figures: sources of each item, headline numbers, and commands.

KIND/records.json has a line for each table, figure or chart: its data sets, files of rows, methods, sizes, number of
objects and number of rows. provenance.json has the hash of each file of rows, the commit of a file that git knows
unchanged, the digest of the code that made the rows, and the clock of their seconds;
constraints.txt of that commit pins the packages that measured the rows.
headlines.json has the numbers that `dvc metrics show` and `dvc exp show` list.
`command` is the shell command that measures the rows of a claim again.
"""

import json
import re
import subprocess
from collections.abc import Iterable, Mapping
from contextlib import suppress
from functools import cache
from importlib.metadata import PackageNotFoundError, requires, version
from pathlib import Path
from platform import python_version
from typing import Any

import pandas as pd
import yaml

from haptic_glance.base.files import read_json, sha256, write_json, write_text
from stages.engine.rows import DIGITS, SUFFIX
from stages.engine.settings import CODE, load_params

from .cells import rows_of
from .items import Built, Figure, Table
from .results import BENCH, Results, clock_of

FILE = "records.json"
PROVENANCE_FILE = "provenance.json"
SIZES = ("target", "size", "touches", "cells", "pitch", "imprints", "frames", "image_rows", "tolerance")
OBJECTS = ("item", "mesh", "scene", "group")  # columns of which the first that has values names the objects
MOST = 60  # methods or sizes that a record lists


def record_of(item: Table | Figure, results: Results, kind: str) -> dict[str, Any]:
    """The record of an item that was just built; of a figure that was drawn in an earlier run, the one of that run."""
    if isinstance(item, Figure) and not item.drawing.axes:
        past = {"drawn": "in an earlier run", **earlier(results, kind).get(item.name, {}), "sets": item.sets}
        return {key: value for key, value in past.items() if key != "older"} | _older(results, past.get("files", ()))
    frames = [frame for parts in results.sources.values() for frame in parts]
    own_frames = [item.frame] if item.frame is not None else frames
    method_frames = own_frames if any("method" in frame for frame in own_frames) else frames
    record = {"sets": item.sets, "files": sorted(results.sources), "rows": sum(map(len, own_frames))}
    objects = next(filter(None, (_values(frames, column) for column in OBJECTS)), [])
    record |= {"objects": len(objects), "methods": _values(method_frames, "method")[:MOST]}
    sizes = {name: _values(frames, name)[:MOST] for name in SIZES}
    record |= _older(results, record["files"])
    return record | {"sizes": {name: values for name, values in sizes.items() if values}}


def _values(frames: Iterable[pd.DataFrame], column: str) -> list[str]:
    """The different values of a column, as text, in order."""
    texts = {f"{value:g}" if isinstance(value, float) else str(value)
             for frame in frames if column in frame for value in frame[column].dropna().unique()}  # fmt: skip
    return sorted(texts)


def earlier(results: Results, kind: str) -> dict[str, Any]:
    """{item: record} of the last run."""
    return _read_json(results.reports / kind / FILE).get("items", {})


def _read_json(path: Path) -> dict[str, Any]:
    """The content of a file of the last report; empty where there was none."""
    return read_json(path) if path.is_file() else {}


def write_records(built: dict[str, Built], results: Results, out: Path) -> None:
    """Writes OUT/KIND/records.json of each kind, and OUT/provenance.json of the files of rows that they name."""
    files: set[str] = set()
    for kind, batch in built.items():
        left = {name: record for name, record in earlier(results, kind).items() if name in batch.no_data}
        records = left | {item.name: item.record for item in batch.items}
        files |= {name for record in records.values() for name in record.get("files", ())}
        _write_parts(out / kind / FILE, {"items": records})
    known_commits = commits(results.reports) | commits(results.workspace.published)
    rows = {name: _file(results, name, known_commits) for name in files}
    _write_parts(out / PROVENANCE_FILE, {"packages": versions(), "files": rows})


@cache
def versions() -> dict[str, str]:
    """Versions of Python and of the packages that the project asks for, as far as they are installed."""
    packages = {"python": python_version()}
    names = (re.split(r"[^\w.-]", requirement)[0].lower() for requirement in requires("haptic-glance") or ())
    for name in dict.fromkeys(names):  # several extras name the same package
        with suppress(PackageNotFoundError):
            packages[name] = version(name)
    return packages


def _write_parts(path: Path, parts: Mapping[str, Mapping[str, Any]]) -> None:
    """Writes JSON with a line for each name of a part, so that a difference of two runs is short."""
    lines = (f' "{name}": {{\n{_lines(part)}\n }}' for name, part in parts.items())
    write_text(path, "{\n" + ",\n".join(lines) + "\n}")


def _lines(part: Mapping[str, Any]) -> str:
    """A line for each name, in order."""
    return ",\n".join(
        f"  {json.dumps(name)}: {json.dumps(value, ensure_ascii=False)}" for name, value in sorted(part.items())
    )


def path_of(results: Results, name: str) -> Path:
    """The file of rows that a record names: SET/STAGE or bench/NAME."""
    dataset, _, stage = name.partition("/")
    if dataset == BENCH:
        return results.bench_path(stage)
    return results.reports / "measurements" / dataset / f"{stage}{SUFFIX}"


def code_of(results: Results, name: str) -> tuple[str, str]:
    """(digest of the code that made a file of rows, digest of today's code of its stage); empty where unknown.

    Rows of this run's graph count as measured by today's code: DVC runs a stage again when its code has changed, unless
    somebody says with `dvc commit` that the rows stay equal. Other rows that have not changed since the last report
    keep the digest that provenance.json has for them.
    """
    dataset, _, stage = name.partition("/")
    digests = results.once("code", lambda: load_params(results.workspace.root / CODE))
    today = digests.get(stage, "")[:DIGITS] if dataset != BENCH else ""
    provenance = results.once("provenance", lambda: _read_json(results.reports / PROVENANCE_FILE))
    entry = provenance.get("files", {}).get(name, {})
    in_run = dataset in results.workspace.params.get("graph", {}).get(stage, ()) and today
    is_unchanged = not in_run and entry.get("sha256") == sha256(path_of(results, name))[:DIGITS]
    return entry.get("code", "") if is_unchanged else today, today


def _older(results: Results, names: Iterable[str]) -> dict[str, list[str]]:
    """{older: files of rows that were made by other code than today's}; empty if there are none."""

    def is_older(name: str) -> bool:
        code, today = results.once(("code", name), lambda: code_of(results, name))
        return bool(code and today) and code != today

    older = [name for name in names if is_older(name)]
    return {"older": older} if older else {}


def _file(results: Results, name: str, known: Mapping[Path, str]) -> dict[str, str]:
    """The entry of a file of rows in provenance.json; known: see `commits`."""
    path = path_of(results, name)
    entry = {"sha256": sha256(path)[:DIGITS], "commit": known.get(path, ""), "code": code_of(results, name)[0]}
    dataset, _, stage = name.partition("/")
    if dataset == BENCH:
        return {key: value for key, value in entry.items() if value}
    # All columns would take most of the time that the report spends after its parts.
    rows = pd.read_csv(path, usecols=lambda name: name in ("value", "seconds", "clock"), low_memory=False)
    if "seconds" in rows:
        entry["clock"] = clock_of(rows, stage)
    return {key: value for key, value in entry.items() if value}


def commits(reports: Path) -> dict[Path, str]:
    """{file of rows: the commit that last changed it}, without files changed since; empty where git knows none."""

    def git(*words: str) -> str:
        of_rows = ["--name-only", "--relative", "--", "measurements", "bench"]
        command = ["git", "-C", str(reports), *words, *of_rows]
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout

    last: dict[str, str] = {}
    try:
        changed = git("diff", "HEAD").splitlines()
        for commit in git("log", "--format=%x01%h").split("\x01")[1:]:  # the newest first
            name, *files = commit.splitlines()
            last = dict.fromkeys(files, name) | last
    except (OSError, subprocess.CalledProcessError):
        return {}
    return {reports / file: name for file, name in last.items() if file not in changed}


HEADLINES_FILE = "headlines.json"
HEADLINES = {  # name: (file and rows, as stages.report.cells has them, of which the first counts; its column)
    "nss_glance": ("tradeoff/attention", "method=glance metric=nss", "mean"),
    "touch_accuracy_knn_glance": ("tradeoff/saliency", "method=glance", "mean"),
    "touch_accuracy_knn_blind": ("tradeoff/saliency", "method=random", "mean"),
    "salient_error_qem_25": ("tradeoff/simplification", "metric=salient_error method=qem target=25%", "mean"),
    "salient_error_soft_25": ("tradeoff/simplification", "metric=salient_error method=glance-soft target=25%", "mean"),
    "metro_mean_qem_25": ("tradeoff/simplification", "metric=metro_mean method=qem target=25%", "mean"),
    "places_found_again": ("tradeoff/stability", "method=glance", "found"),
    "corruption_error": ("tradeoff/stability", "method=glance", "mce"),
    "scene_faces": ("tradeoff/scene", "method=ours tolerance=1 pixel", "faces"),
    "contour_accuracy_cnn": ("tradeoff/sequences", "classifier=cnn", "mean"),
    "seconds_glance": ("tradeoff/attention", "method=glance metric=nss", "seconds"),
}


def write_headlines(out: Path, verdicts: Mapping[str, int] | None) -> None:
    """Writes headlines.json from the charts below `out` and the counts of verdicts, without charts that are not there.

    verdicts: None for a folder of a person's own meshes, which the claims of the thesis are not about.
    """
    headlines: dict[str, float] = {}
    for name, (file, where, column) in HEADLINES.items():
        with suppress(LookupError):
            headlines[name] = float(rows_of(out / f"{file}.csv", where)[column].iloc[0])
    if verdicts is not None:
        headlines |= {f"claims_{word}": verdicts.get(word, 0) for word in ("supported", "contradicted", "open")}
    write_json(out / HEADLINES_FILE, headlines)


COMPOSE = "python -m stages.compose"


@cache
def switch(conf: Path, dataset: str, stage: str) -> str:
    """Arguments of compose that run a stage on a set: nothing for the default run, an experiment, or the set alone.

    conf: the folder of the configuration; what it lacks is not known.
    """
    defaults = _read(conf / "config.yaml").get("sets", ())
    if dataset in defaults and stage in _read(conf / f"data/{dataset}.yaml").get("stages", ()):
        return ""
    for path in sorted((conf / "experiment").glob("*.yaml")):
        experiment = _read(path)
        if dataset in experiment.get("sets", ()) and stage in experiment.get("stages", [stage]):
            return f"experiment={path.stem}"
    return f"'sets=[{dataset}]'"


def command(conf: Path, stage: str, sets: Iterable[str]) -> str:
    """The command that measures a stage on all of the sets, and judges again."""
    conf = conf.resolve()  # `switch` remembers folders, and the same relative one may be another folder later
    together: dict[str, list[str]] = {}
    for name in sets:
        together.setdefault(switch(conf, name, stage), []).append(f"{stage}@{name}")
    parts = (f"{COMPOSE} {option}".rstrip() + f" && dvc repro {' '.join(names)}" for option, names in together.items())
    return " && ".join(parts) + " report"


@cache
def _read(path: Path) -> dict:
    """The content of a file of the configuration, which one run of the report asks for some hundred times."""
    return yaml.safe_load(path.read_text(encoding="utf-8")) or {} if path.is_file() else {}
