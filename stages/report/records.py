"""The data behind every table, figure and chart: KIND/records.json, one line an item.

An item's record has its data sets, the files of rows that it read, the methods, sizes and number of objects in them,
and how many rows it shows. `files` has of each file of rows its hash, its commit where git knows it unchanged, and the
clock of its seconds.
"""

import json
import subprocess
from collections.abc import Iterable
from functools import cache
from pathlib import Path
from typing import Any

import pandas as pd

from haptic_glance.base.files import read_json, sha256, write_text
from stages.kit.rows import SUFFIX

from .items import Built, Figure, Table
from .results import BENCH, Results

FILE = "records.json"
SIZES = ("target", "size", "touches", "cells", "pitch", "imprints", "frames", "image_rows", "tolerance")
OBJECTS = ("item", "mesh", "scene", "group")  # columns of which the first that has values names the objects
DIGITS = 12  # of a hash
MOST = 60  # methods or sizes that a record lists


def record_of(item: Table | Figure, results: Results, kind: str) -> dict[str, Any]:
    """The record of an item that was just built; of a figure that was drawn in an earlier run, the one of that run."""
    if isinstance(item, Figure) and not item.drawing.axes:
        return {"drawn": "in an earlier run", **earlier(results, kind).get(item.name, {}), "sets": item.sets}
    frames = [frame for parts in results.sources.values() for frame in parts]
    shown = [item.frame] if item.frame is not None else frames
    named = shown if any("method" in frame for frame in shown) else frames
    found = {"sets": item.sets, "files": sorted(results.sources), "rows": sum(map(len, shown))}
    objects = next(filter(None, (_values(frames, column) for column in OBJECTS)), [])
    found |= {"objects": len(objects), "methods": _values(named, "method")[:MOST]}
    sizes = {name: _values(frames, name)[:MOST] for name in SIZES}
    return found | {"sizes": {name: values for name, values in sizes.items() if values}}


def _values(frames: Iterable[pd.DataFrame], column: str) -> list[str]:
    """The different values of a column, as text, in order."""
    found = {f"{value:g}" if isinstance(value, float) else str(value)
             for frame in frames if column in frame for value in frame[column].dropna().unique()}  # fmt: skip
    return sorted(found)


def earlier(results: Results, kind: str) -> dict[str, Any]:
    """{item: record} of the last run; empty where there was none."""
    path = results.reports / kind / FILE
    return read_json(path)["items"] if path.is_file() else {}


def write_records(built: dict[str, Built], results: Results, out: Path) -> None:
    """Writes OUT/KIND/records.json of each kind."""
    for kind, found in built.items():
        records = {item.name: item.record for item in found.items}
        files = {name for record in records.values() for name in record.get("files", ())}
        parts = {"files": {name: _file(results, name) for name in files}, "items": records}
        lines = (f' "{name}": {{\n{_lines(part)}\n }}' for name, part in parts.items())
        write_text(out / kind / FILE, "{\n" + ",\n".join(lines) + "\n}")


def _lines(part: dict[str, Any]) -> str:
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


def _file(results: Results, name: str) -> dict[str, str]:
    path = path_of(results, name)
    found = {"sha256": sha256(path)[:DIGITS], "commit": commit(path)}
    dataset, _, stage = name.partition("/")
    if dataset != BENCH and "seconds" in results.rows(stage, dataset):
        found["clock"] = results.clock(stage, dataset)
    return {key: value for key, value in found.items() if value}


@cache
def commit(path: Path) -> str:
    """The commit that last changed a file; empty where it was changed since, or git does not know it."""

    def git(*words: str) -> str:
        return subprocess.run(["git", "-C", str(path.parent), *words, "--", path.name], capture_output=True, text=True,
                              check=True).stdout.strip()  # fmt: skip

    try:
        return "" if git("status", "--porcelain") else git("log", "-1", "--format=%h")
    except (OSError, subprocess.CalledProcessError):
        return ""
