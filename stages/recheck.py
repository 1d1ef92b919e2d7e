"""Measures a few items of committed rows again and compares them: `python -m stages.recheck SET/STAGE ...`

Rows outside the default run are committed, while their code changes further. The report marks rows that are older than
the code of their stage, but cannot tell whether the change affects the results. This command can: it runs the
stages that the rows depend on in build/recheck, the stage itself on its first items alone, and compares each row with
the committed one. It prints a line for each method, and keeps the outcome in reports/measurements/rechecked.json: where
98 % of the compared rows of each method agree within 1 %, the report does not call the file older. Rows of a metric
that the committed file does not have are counted alone. Exits with 1 where rows differ by more or were not measured
again, and where a stage stopped before its end: the outcome is not kept then.

Examples: `python -m stages.recheck gaze/lod`, `python -m stages.recheck gaze/lod princeton/lod --items 5`,
`python -m stages.recheck furniture/coarse_imprints experiment=coarse_imprints` for rows of an experiment. A data set
that is not fetched by hash must lie where conf/data/SET.yaml says. Stages that work on their objects together need all
objects: --items 1000, which also compares the rows about all of them. A second run reuses unchanged results from its
cache.
"""

import argparse
import importlib
import re
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd
import yaml

from haptic_glance.base.errors import errors_in_one_line
from haptic_glance.base.files import read_json, sha256, write_json, write_text
from stages.code import write_digests
from stages.compose import compose
from stages.engine.rows import DIGITS, RECHECKED, SUFFIX, agrees, read_rows, write_rows
from stages.engine.run import Few, first_items
from stages.engine.settings import FILE, PUBLISHED, Workspace, check_clone

FOLDER = Path("build/recheck")
COMMITTED = Path(PUBLISHED) / "measurements"
CODE = Path("build/code")
SHARED = ("annotations", "reference")  # folders of data/ that belong to no set
MEASURED = ("value", "seconds", "clock", "seed", "note", "asked", "faces", "points", "kept", "rings", "shrunk",
            "infeasible", "smallest_feasible", "map_dimensions")  # every other column tells a row apart  # fmt: skip
TIMES = "milliseconds", "training_seconds"  # metrics
EQUAL, CLOSE = 2e-5, 0.01  # relative differences: of two numbers that are written with six digits; of no account
ZERO = 1e-9  # smaller numbers count as this, since rounding alone makes them


def run(argv: Sequence[str]) -> int:
    """Checks the files of rows that the command line names; 1 where rows differ."""
    parser = argparse.ArgumentParser(
        prog="python -m stages.recheck", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "files", nargs="+", metavar="SET/STAGE", help="rows below reports/measurements; KEY=VALUE is a setting of all"
    )
    parser.add_argument("--items", type=int, default=2, metavar="N", help="items of the stage (default: 2)")
    options = parser.parse_intermixed_args(argv)
    if options.items < 1:
        raise ValueError(f"--items {options.items}: give 1 or more")
    check_clone()
    write_digests(CODE)
    settings = [word for word in options.files if "=" in word]
    failure_count = 0
    for name in [word for word in options.files if word not in settings]:
        try:
            rows, is_complete = recheck(name, options.items, settings)
        except ValueError as error:  # the other files go on
            print(f"recheck: {error}", file=sys.stderr)
            failure_count += 1
            continue
        print(f"{name}:\n{by_method(rows).to_string(index=False)}")
        if is_complete:
            keep(name, rows)
        failure_count += not (is_complete and agrees(outcome(rows)))
    return 1 if failure_count else 0


def recheck(name: str, items: int, settings: Sequence[str] = ()) -> tuple[pd.DataFrame, bool]:
    """The rows of the first items of a stage, as `compared` gives them, and whether the stage ran to its end.

    name: SET/STAGE. settings: KEY=VALUE, as stages.compose takes them. Raises ValueError where nothing is committed,
    where these settings do not switch the stage on, and where nothing was measured again.
    """
    dataset, _, stage = name.partition("/")
    if not _file(name).is_file():
        files = sorted(path.relative_to(COMMITTED).as_posix() for path in COMMITTED.glob(f"*/*{SUFFIX}"))
        raise ValueError(f"no {_file(name)}; known: {', '.join(path.removesuffix(SUFFIX) for path in files)}")
    workspace = prepared(dataset, settings)
    graph = workspace.params["graph"]
    if dataset not in graph.get(stage, ()):
        raise ValueError(f"{name}: conf/data/{dataset}.yaml leaves {stage} out; add experiment=NAME of conf/experiment")
    for earlier in chain(stage):
        if dataset in graph.get(earlier, ()):
            _run(earlier, workspace)
    selection, is_complete = Few(items), True
    with first_items(selection):
        try:
            _run(stage, workspace)
        except Exception as error:  # what works on all items together may stumble over a few: some rows are there
            if not selection.rows:
                raise ValueError(f"{name}: {stage} needs more than {items} items, or cannot run: {error}") from error
            is_complete = False
            print(f"recheck: {name} is not kept, {stage} stopped before its end: {error}", file=sys.stderr)
    if is_complete and not selection.cut:  # with rows that are about all items together
        return compared(read_rows(_file(name)), read_rows(workspace.measurements / f"{stage}{SUFFIX}")), True
    new_file = FOLDER / "rows" / f"{dataset}-{stage}{SUFFIX}"
    columns = getattr(importlib.import_module(f"stages.{stage}"), "COLUMNS", {})
    write_rows(new_file, selection.rows, columns, dataset, workspace.seed)
    return compared(read_rows(_file(name)), read_rows(new_file)), is_complete


def prepared(dataset: str, settings: Sequence[str] = ()) -> Workspace:
    """A workspace below FOLDER whose params.yaml switches one set on; folders of files stay where they are."""
    values = compose([*settings, f"sets=[{dataset}]", f"out={PUBLISHED}"])
    for section in values[dataset].values():
        if section.get("folder"):
            section["folder"] = str(Path(section["folder"]).expanduser().resolve())
    root = FOLDER / dataset
    write_text(root / FILE, yaml.safe_dump(values, sort_keys=False))
    for name in SHARED:
        shared = root / "data" / name
        shared.parent.mkdir(parents=True, exist_ok=True)
        if not shared.exists():
            shared.symlink_to((Path("data") / name).resolve())
    return Workspace(root, dataset)


def chain(stage: str) -> list[str]:
    """The stages whose folders a stage reads, directly or not, as dvc.yaml has them, each after those it needs."""
    stages = yaml.safe_load(Path("dvc.yaml").read_text(encoding="utf-8"))["stages"]
    sources: dict[str, None] = {}

    def add(name: str) -> None:
        for dependency in stages[name].get("do", stages[name]).get("deps", ()):
            match = re.fullmatch(r"data/\$\{(?:item|key)\}/(\w+)", dependency)
            if match and match[1] not in sources:
                add(match[1])
                sources[match[1]] = None

    add(stage)
    return list(sources)


def _run(stage: str, workspace: Workspace) -> None:
    importlib.import_module(f"stages.{stage}.__main__").run(workspace)


def compared(committed: pd.DataFrame, again: pd.DataFrame) -> pd.DataFrame:
    """Committed rows beside the same rows measured again; of committed rows, those of the objects measured again.

    Where a row names no object, such as a row of a trial, it counts where another metric of it was measured again.
    Times do not count.

    Columns: the keys, value, again, `off` (the relative difference), and `side`: both, left_only or right_only.
    """
    keys = [name for name in committed.columns if name in again.columns and name not in MEASURED]
    sides = [_numbered(rows[~rows["metric"].isin(TIMES)], keys) for rows in (committed, again)]
    sides[1] = sides[1].rename(columns={"value": "again"})
    pairs = sides[0].merge(sides[1], how="outer", on=[*keys, "number"], indicator="side")
    units = set(_units(sides[1], keys))
    pairs = pairs[
        (pairs["side"] != "left_only") | np.array([unit in units for unit in _units(pairs, keys)], dtype=bool)
    ]
    pair = pairs[["value", "again"]]
    size = pair.abs().max(axis=1)
    differences = ((pair["value"] - pair["again"]).abs() / size.clip(lower=ZERO)).where(~pair.isna().all(axis=1), 0.0)
    return pairs.assign(off=differences.fillna(np.inf).where(pairs["side"] == "both"))


def _units(rows: pd.DataFrame, keys: list[str]) -> list[tuple[str, ...]]:
    """For each row its object and repetition or, where it names no object, all that tells it apart but the metric."""
    whole = [name for name in keys if name != "metric"]
    texts = rows[whole].to_dict("records")
    return [(row["item"], row.get("repetition", "")) if row.get("item") else tuple(row.values()) for row in texts]


def _numbered(rows: pd.DataFrame, keys: list[str]) -> pd.DataFrame:
    """The rows with their keys as text, and a number for rows with equal keys."""
    texts = rows[keys].map(lambda cell: "" if cell != cell else f"{cell:g}" if isinstance(cell, float) else str(cell))
    return texts.assign(value=rows["value"].astype(float), number=texts.groupby(keys, sort=False).cumcount())


def by_method(rows: pd.DataFrame) -> pd.DataFrame:
    """A line a method: rows that both sides have, equal ones, close ones, rows of one side, the largest difference."""
    marks = {"rows": rows["side"] == "both", "equal": rows["off"] <= EQUAL, "close": rows["off"] <= CLOSE,
             "only_committed": rows["side"] == "left_only", "only_again": rows["side"] == "right_only"}  # fmt: skip
    counts = pd.DataFrame(marks).assign(method=rows.get("method", "")).groupby("method", sort=False).sum()
    largest = rows.assign(method=rows.get("method", "")).groupby("method", sort=False)["off"].max()
    return counts.assign(largest_difference=largest).reset_index()


def keep(name: str, rows: pd.DataFrame) -> None:
    """Writes the outcome of a check beside the rows, with the hash of the rows and the digest of the code."""
    path, stage = COMMITTED / RECHECKED, name.partition("/")[2]
    checks = read_json(path) if path.is_file() else {}
    digests = {"sha256": sha256(_file(name)), "code": sha256(CODE / stage)}
    checks[name] = {key: digest[:DIGITS] for key, digest in digests.items()} | outcome(rows)
    write_json(path, dict(sorted(checks.items())))


def outcome(rows: pd.DataFrame) -> dict[str, float]:
    """{compared, close, only_committed: numbers of rows; least: the smallest share of close rows of any method}."""
    counts = by_method(rows).rename(columns={"rows": "compared"})
    least = (counts["close"] / counts["compared"]).min()
    sums = {name: int(counts[name].sum()) for name in ("compared", "close", "only_committed")}
    return sums | {"least": round(float(least), 4) if sums["compared"] else 0.0}


def _file(name: str) -> Path:
    return COMMITTED / f"{name}{SUFFIX}"


def main() -> None:
    """Runs the command."""
    errors_in_one_line("recheck")
    sys.exit(run(sys.argv[1:]))


if __name__ == "__main__":
    main()
