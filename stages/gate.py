"""Holds metrics against their baseline, each within its tolerance: `python -m stages.gate [METRICS.json ...]`

Without files: the metrics of the sets that params.yaml switches on, reports/metrics/SET/STAGE.json, and those of the
report, against reports/baselines/PROFILE.json of its profile, within reports/tolerances.yaml. A run with other sets or
settings has a baseline of its own, baseline.json in the folder of its results, which --update makes. With files, of any
project: each metric is called by its file and its keys, `train.accuracy` in train.json. A baseline is {metric: value};
--tolerances names a file of rules such as ours (abs, rel, direction); a metric without a rule must be exact. --spread
measures how far each metric moves with the seed, the threads or the machine, and writes it beside the baseline: the
metric may move that far, whatever its rule. Exits with 1 and lists the metrics that moved, with the difference.

Tolerances let small errors pass. On one machine, two runs give equal rows: --rows compares every row of measurements,
also of sets that are switched off, with the rows of a git revision. Times and notes are left out.

examples:
  python -m stages.gate
  python -m stages.gate train.json eval.json --baseline baseline.json --tolerances tolerances.yaml
  python -m stages.gate train.json --baseline baseline.json --update
  python -m stages.gate --markdown >> "$GITHUB_STEP_SUMMARY"
  python -m stages.gate --rows HEAD
  python -m stages.gate --spread runs/seed_1/reports/metrics runs/two_threads/reports/metrics
"""

import argparse
import csv
import gzip
import io
import math
import re
import subprocess
import sys
import zlib
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from haptic_glance.base.errors import errors_in_one_line
from haptic_glance.base.files import read_json, write_json
from stages.engine.rows import SUFFIX
from stages.engine.settings import Workspace, check_clone
from stages.engine.tolerances import Tolerances, compare, read_tolerances, widest_moves

TOLERANCES = Path("reports/tolerances.yaml")
REPORT = "report."  # metrics that count tables and verdicts: no measurements, whose luck is to be known
BASELINE = "baseline.json"  # of a run of one's own, in the folder of its results
LISTED = 8  # new metrics that are named
ROWS = "reports/measurements"
TIMES = re.compile(r"seconds|_ms$")  # in names of metrics whose values differ from run to run
VOLATILE = ("seconds", "clock", "note")  # columns of a row that do, or whose words may be mended
COST = "cost"  # the condition of rows that hold seconds


def flatten(values: Mapping[str, Any], prefix: str = "") -> dict[str, float]:
    """{"a.b": number} of nested dicts; intervals (keys low and high) are left to the charts."""
    flat = {}
    for key, value in values.items():
        name = f"{prefix}.{key}" if prefix else key
        if isinstance(value, dict):
            flat |= flatten(value, name)
        elif isinstance(value, int | float) and key not in ("low", "high"):
            flat[name] = value
    return flat


def read_metrics(path: Path) -> dict[str, Any]:
    """The metrics of a JSON file, nested or not; ValueError that names it where it holds none."""
    values = read_json(path)
    if not isinstance(values, dict):
        raise ValueError(f"{path} is no table of metrics: it needs {{NAME: number}}")
    return values


def measured(workspace: Workspace, folder: Path | None = None) -> dict[str, float]:
    """All metrics of the report and of the switched-on sets, flat: SET.STAGE.NAME. folder: reports/metrics or such."""
    folder = folder or workspace.reports / "metrics"
    files = {"report": folder / "report.json"}
    for dataset, sections in ((name, workspace.params["graph"]) for name in workspace.sets):
        for stage, sets in sections.items():
            if dataset in sets:
                files[f"{dataset}.{stage}"] = folder / dataset / f"{stage}.json"
    return flatten({name: read_metrics(path) for name, path in files.items() if path.exists()})


def hold(metrics: Mapping[str, float], path: Path, tolerances: Tolerances, others: Iterable[str] = ()) -> str:
    """The message on metrics that all hold. SystemExit where one left its bounds about the baseline.

    others: metrics of other profiles, which the rules may be about.
    """
    if not path.exists():
        raise SystemExit(f"gate: no {path}: --update makes it from the metrics at hand, after a run that you trust")
    baseline = flatten(read_metrics(path))
    tolerances.check([*baseline, *metrics, *others])
    sentences = compare(metrics, baseline, tolerances)
    if sentences:
        raise SystemExit(
            "\n".join([f"gate: {len(sentences)} of {len(baseline)} metrics left their bounds about {path}", *sentences])
        )
    new = sorted(set(metrics) - set(baseline))
    remainder = f" and {len(new) - LISTED} more" if len(new) > LISTED else ""
    message = f"gate: {len(baseline)} metrics within their tolerances about {path}"
    return f"{message}; not in the baseline yet: {', '.join(new[:LISTED])}{remainder}" if new else message


def update(metrics: Mapping[str, float], path: Path) -> str:
    """Writes the baseline; SystemExit where there are no metrics, or where one of them is no finite number."""
    if not metrics:
        raise SystemExit(f"gate: no metrics to write to {path}: run `dvc repro` first")
    if lost := [name for name, value in metrics.items() if not math.isfinite(value)]:
        raise SystemExit(f"gate: {', '.join(lost)} of the metrics at hand are no finite numbers: {path} stays as it is")
    write_json(path, dict(metrics))
    return f"gate: {path} written from {len(metrics)} metrics"


def allowed(rules: Path | None, baseline: Path) -> Tolerances:
    """The Tolerances of a file of rules, and of what --spread wrote beside a baseline."""
    tolerances, moves = read_tolerances(rules) if rules else Tolerances(), spread_of(baseline)
    return replace(tolerances, moves=read_json(moves)) if moves.exists() else tolerances


def spread_of(baseline: Path) -> Path:
    """The file with the widest moves of the metrics of a baseline."""
    return baseline.with_name(f"{baseline.stem}_spread.json")


def write_spread(runs: Sequence[Mapping[str, float]], baseline: Path) -> str:
    """Writes how far each metric moved in the runs; SystemExit where one has none of the metrics."""
    old_values = {name: value for name, value in read_json(baseline).items() if not name.startswith(REPORT)}
    for k, run in enumerate(runs):
        if not set(old_values) & set(run):
            raise SystemExit(f"gate: folder {k + 1} of --spread has none of the metrics of {baseline}")
    moves = widest_moves(runs, old_values)
    write_json(spread_of(baseline), moves)
    return f"gate: {spread_of(baseline)} written: {len(moves)} of {len(old_values)} metrics moved in {len(runs)} runs"


def hold_rows(revision: str, root: Path = Path()) -> str:
    """The message on rows that all equal those of a git revision. SystemExit names each file with other rows."""
    committed = _git(root, "ls-tree", "-r", "--name-only", revision, "--", ROWS).decode().splitlines()
    row_files = [name for name in committed if name.endswith(SUFFIX)]
    present = [path.relative_to(root).as_posix() for path in (root / ROWS).rglob(f"*{SUFFIX}")]
    lines = []
    for name in sorted({*row_files, *present}):
        try:
            before = _rows_of(_git(root, "show", f"{revision}:{name}")) if name in row_files else Counter()
            after = _rows_of((root / name).read_bytes()) if name in present else Counter()
        except (EOFError, OSError, ValueError, csv.Error, zlib.error) as error:  # the other files go on
            lines.append(f"  {name}: not a valid table ({error})")
            continue
        old, new = (before - after).total(), (after - before).total()
        if old or new:
            lines.append(f"  {name}: {min(old, new)} rows changed, {max(new - old, 0)} more, {max(old - new, 0)} fewer")
    if lines:
        remedy = f"commit the files if the change is meant, or run `git checkout {revision} -- FILE`"
        raise SystemExit("\n".join([f"gate: {len(lines)} files have other rows than {revision}: {remedy}", *lines]))
    return f"gate: the rows of {len(row_files)} files equal those of {revision}"


def _rows_of(content: bytes) -> Counter:
    """How often each row occurs, without times, notes and empty cells."""
    rows = csv.DictReader(io.StringIO(gzip.decompress(content).decode()))
    kept = (row for row in rows if not TIMES.search(row.get("metric") or "") and row.get("condition") != COST)
    return Counter(tuple((name, cell) for name, cell in row.items() if cell and name not in VOLATILE) for row in kept)


def _git(root: Path, *arguments: str) -> bytes:
    completed = subprocess.run(["git", *arguments], cwd=root, capture_output=True)
    if completed.returncode:
        raise SystemExit(f"gate: git {arguments[0]}: {completed.stderr.decode().strip()}")
    return completed.stdout


def run(argv: Sequence[str]) -> None:
    """Compares, updates the baseline, or measures how far runs differ."""
    parser = argparse.ArgumentParser(
        prog="python -m stages.gate", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("metrics", nargs="*", type=Path, metavar="METRICS.json", help="metrics of any project")
    parser.add_argument("--baseline", type=Path, help="default: reports/baselines/PROFILE.json")
    parser.add_argument("--tolerances", type=Path, help=f"rules (default: {TOLERANCES}; of other files: exact)")
    parser.add_argument("--update", action="store_true", help="write the baseline from the metrics at hand")
    help_text = "folders of metrics of runs with other seeds or threads: write how far each metric moves"
    parser.add_argument("--spread", nargs="+", type=Path, metavar="FOLDER", help=help_text)
    parser.add_argument("--markdown", action="store_true", help="print Markdown, for the summary of a run on GitHub")
    help_text = "compare each row of every measurement with those of a git revision, times left out"
    parser.add_argument("--rows", metavar="REVISION", help=help_text)
    options = parser.parse_args(argv)
    if options.rows:
        print(hold_rows(options.rows))
        return
    if options.metrics and (options.spread or not options.baseline):
        parser.error("METRICS.json needs --baseline, and --spread is of runs of this project")
    if options.metrics:
        metrics = flatten({file.stem: read_metrics(file) for file in options.metrics})
        path, rules, other_names = options.baseline, options.tolerances, []
    else:
        check_clone()
        workspace = Workspace(Path("."))
        metrics, path = measured(workspace), options.baseline or baseline_of(workspace)
        rules = options.tolerances or (TOLERANCES if TOLERANCES.exists() else None)
        folders = {path.parent, workspace.published / "baselines"}  # the rules are about the metrics of every profile
        other_names = [name for folder in folders for file in folder.glob("*.json") for name in read_json(file)]
    if options.spread:
        print(write_spread([measured(workspace, folder) for folder in options.spread], path))
    elif options.update:
        print(update(metrics, path))
    else:
        try:
            text = hold(metrics, path, allowed(rules, path), other_names)
        except SystemExit as failure:
            raise SystemExit(markdown(str(failure)) if options.markdown else failure.code) from None
        print(markdown(text) if options.markdown else text)


def markdown(text: str) -> str:
    """The message of the gate under a heading, with an item for each metric that moved."""
    first, *sentences = text.splitlines()
    return "\n".join(
        [
            "## Metrics against their baseline",
            "",
            first.removeprefix("gate: "),
            "",
            *(f"- {line.strip()}" for line in sentences),
        ]
    )


def baseline_of(workspace: Workspace) -> Path:
    """The file of a run's baseline: with the published ones, or beside the results of a run of one's own."""
    name = (
        workspace.params.get("profile", "laptop")
        if workspace.reports == workspace.published
        else workspace.reports.name
    )
    published = workspace.published / "baselines" / f"{name}.json"
    return published if workspace.reports == workspace.published or published.exists() else workspace.reports / BASELINE


def main() -> None:
    """Runs the command line."""
    errors_in_one_line("gate")
    run(sys.argv[1:])


if __name__ == "__main__":
    main()
